"""Sections of the evaluation as steps, and what runs them.

Each step's result is a file: what is there is not done again.
"""

import contextlib
import dataclasses
import datetime
import json
import os
import time
from typing import Any, Callable, Iterator, Optional, Sequence

import numpy as np

import relume

from .bakes import Bakes, Recipe
from .inputs import Inputs
from .program import Program
from .report import Chapter, write_report
from .scenes import FULL, Scale, Setup
from .store import LabError, Path, hash_of, locked, log, read_result, replacing, write_text

_VERSION = 2  # raised when steps give other results from the same inputs

Results = dict[str, Any]  # numbers of the steps that are done, by name


class Work:
    """What a step may use while it runs."""

    def __init__(self, program: Program, bakes: Bakes, folder: Path) -> None:
        self.program, self.bakes, self._folder = program, bakes, folder
        self.files: list[Path] = []  # written so far, from the evaluation's folder

    def asset(self, recipe: Recipe) -> relume.Asset:
        return relume.Asset.load(self.bakes.make(recipe))

    def load(self, step: str, name: str) -> relume.Image:
        """A linear image of an earlier step."""
        return relume.load_image(self._folder / picture(step, f"{name}.exr"))

    @contextlib.contextmanager
    def writing(self, step: str, file: str) -> Iterator[Path]:
        """Gives a temporary name for images/STEP/FILE."""
        with replacing(self._folder / picture(step, file)) as temporary:
            yield temporary
        self.files.append(picture(step, file))

    def write(self, step: str, name: str, image: np.ndarray, exposure: Optional[float] = None) -> None:
        """Writes a linear image as images/STEP/NAME.exr or, at an exposure in stops, tone-mapped as .png."""
        with self.writing(step, name + (".exr" if exposure is None else ".png")) as temporary:
            relume.Image(image).save(temporary, exposure=exposure, tone="aces")


def picture(step: str, file: str) -> Path:
    """Where a picture of a step lies, from the report's folder."""
    return Path("images") / step / file


@dataclasses.dataclass(eq=False)
class Step:
    """A piece of work, with numbers and files as its result. `inputs`, `recipes` and `after` hold what decides them."""
    name: str  # SECTION-…, among all; a file's name
    title: str
    inputs: Any
    work: Callable[[Work], Any]
    recipes: Sequence[Recipe] = ()  # bakes that it needs
    after: Sequence["Step"] = ()  # whose images it reads

    def key(self) -> Any:
        return [self.name, self.inputs, [recipe.key() for recipe in self.recipes], [step.key() for step in self.after]]


@dataclasses.dataclass
class Section:
    title: str
    steps: list[Step]
    write: Callable[[Results, Chapter], None]


def skipped(title: str, why: str) -> Section:
    return Section(title, [], lambda results, chapter: chapter.say(f"Skipped: {why}."))


class Evaluation:
    def __init__(self, folder: Path, data: Optional[Path], scale: Scale, device: str = "") -> None:
        self._folder, self._data, self._scale = folder, data, scale
        self._program = Program(device)
        if device:
            relume.use_device(device)
        self._device = relume.device()
        version = self._program.run("--version").strip()
        self._identity = [_VERSION, version, self._device["name"], self._device["driver"], dataclasses.astuple(scale)]
        self._bakes = Bakes(folder / "bakes", self._program, self._identity)
        self._facts = {
            "Program": version,
            "Options": f"{scale.name}, {'with --data' if data else 'installed data alone'}",
            "Device": f"{self._device['name']} ({self._device['type']}), {self._device['driver']}",
            "Processor": f"{os.cpu_count()} hardware threads",
            "The paper's machine": "Pentium 4, 2.6 GHz, 1 GB, GeForce 5900 (2004)",
            "Errors": "Root mean square over the covered pixels and channels of the linear image, relative to that of "
                      "the reference; free of the reference's noise; in brackets what two standard errors of it leave "
                      "open. Pictures are tone-mapped (ACES); .exr files beside them are linear.",
        }
        self._failures: dict[str, str] = {}  # by step

    def run(self, makers: dict[str, Callable[[Setup], Section]], only: Sequence[str] = ()) -> bool:
        """Does what is not done yet of the sections, by name, and writes the report after each. Ctrl-C stops it.

        only: names of those that are asked for; empty: all. Others are reported if earlier runs have done them. A step
        that fails is told in the report, and the others go on. Returns whether none failed.
        """
        with locked(self._folder):
            sections, steps, missing = [], [], []
            for name, make in makers.items():
                inputs = Inputs(self._data, stand_ins=self._scale != FULL)
                section = make(Setup(inputs, self._scale))
                is_asked = not only or name in only
                if not is_asked and not self._is_done(section):
                    continue
                sections.append(section)
                steps += section.steps if is_asked else []
                missing += [line for line in inputs.missing if line not in missing]
            for line in missing:
                log(line)
            left = [step for step in steps if self._result(step) is None]
            log(f"{len(steps)} steps, {len(steps) - len(left)} of them done before")
            self._remove_bakes([step for step in steps if step not in left], left)
            report = self._write_report(sections, missing)
            for section in sections:
                undone = [step for step in section.steps if step in left]
                for step in undone:
                    left.remove(step)
                    log(f"step {steps.index(step) + 1} of {len(steps)}: {step.title}")
                    self._do(step)
                    self._remove_bakes([step], left)
                if undone:
                    report = self._write_report(sections, missing)
            self._bakes.remove_meshes()
            log(str(report))
            return not self._failures

    def _result_path(self, step: Step) -> Path:
        return self._folder / "steps" / f"{step.name}-{hash_of([self._identity, step.key()])}.json"

    def _result(self, step: Step) -> Optional[Any]:
        """The numbers of a step that is done, whose files are there."""
        stored = read_result(self._result_path(step))
        if not isinstance(stored, dict) or not {"numbers", "files"} <= stored.keys():
            return None
        return stored["numbers"] if all((self._folder / file).is_file() for file in stored["files"]) else None

    def _is_done(self, section: Section) -> bool:
        return bool(section.steps) and all(self._result(step) is not None for step in section.steps)

    def _do(self, step: Step) -> None:
        start = time.monotonic()
        work = Work(self._program, self._bakes, self._folder)
        try:
            if any(other.name in self._failures for other in step.after):
                raise LabError("a step that it needs failed")
            numbers = step.work(work)
            write_text(self._result_path(step),
                       json.dumps({"numbers": numbers, "files": [str(file) for file in work.files]}, indent=1) + "\n")
        except (LabError, relume.Error, OSError, MemoryError) as failure:
            self._failures[step.name] = str(failure) or "out of memory"
            log(f"{step.title}: {self._failures[step.name]}")
        log(f"{time.monotonic() - start:.1f} s")

    def _remove_bakes(self, done: Sequence[Step], left: Sequence[Step]) -> None:
        """Removes those of the steps that are done which none that is left needs, and visibility likewise."""
        needed = [recipe for step in left for recipe in step.recipes]
        keys, seen = [recipe.key() for recipe in needed], [recipe.visibility_key() for recipe in needed]
        for recipe in (recipe for step in done for recipe in step.recipes):
            if recipe.key() not in keys:
                self._bakes.remove(recipe)
            if recipe.visibility_key() not in seen:
                self._bakes.remove_visibility(recipe)

    def _write_report(self, sections: Sequence[Section], missing: list[str]) -> Path:
        chapters = [self._chapter(section) for section in sections]
        findings = [finding for chapter in chapters for finding in chapter.findings]
        if findings and self._scale != FULL:
            findings.insert(0, f"With {self._scale.name}: these numbers are for seeing that everything works.")
        now = datetime.datetime.now(datetime.timezone.utc)
        facts = {**self._facts, "Written": now.strftime("%Y-%m-%d %H:%M UTC")}
        return write_report(self._folder, "All-frequency relighting of glossy objects: the evaluation", facts, missing,
                            chapters, findings)

    def _chapter(self, section: Section) -> Chapter:
        results = {step.name: self._result(step) for step in section.steps}
        chapter = Chapter(section.title)
        if None not in results.values():
            section.write(results, chapter)
            for item in chapter.items:
                for shown in getattr(item, "pictures", []):
                    shown.file = self._folder / shown.file
            return chapter
        failed = [step for step in section.steps if step.name in self._failures]
        for step in failed:
            chapter.say(f"Failed: {step.title}: {self._failures[step.name]}.")
        if count := sum(result is None for result in results.values()) - len(failed):
            chapter.say(f"{count} of its {len(section.steps)} steps are not done yet.")
        return chapter
