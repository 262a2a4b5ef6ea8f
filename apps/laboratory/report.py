"""What a report says: written as one HTML file that needs no other, its tables as CSV and its plots as SVG too."""

import base64
import csv
import dataclasses
import io
from typing import Any, Callable, ClassVar, Sequence

import jinja2

from .store import Path, replacing, write_text


@dataclasses.dataclass
class Text:
    kind: ClassVar[str] = "text"
    text: str


@dataclasses.dataclass
class Table:
    kind: ClassVar[str] = "table"
    file: str  # of its CSV, without folder and extension
    title: str
    columns: list[str]
    rows: list[list[str]]
    note: str = ""


@dataclasses.dataclass
class Picture:
    file: Path  # .png
    title: str
    caption: str = ""


@dataclasses.dataclass
class Pictures:
    """Side by side, `columns` of them in a line."""
    kind: ClassVar[str] = "pictures"
    title: str
    columns: int
    pictures: list[Picture]
    note: str = ""


@dataclasses.dataclass
class Plot:
    """A drawing of the report's own; `draw` writes it to an .svg file."""
    kind: ClassVar[str] = "plot"
    file: str  # without folder and extension
    title: str
    draw: Callable[[Path], None]
    path: Path = Path()


@dataclasses.dataclass
class Chapter:
    """What a section says."""
    title: str = ""
    items: list[Any] = dataclasses.field(default_factory=list)
    findings: list[str] = dataclasses.field(default_factory=list)  # a sentence or two each

    def say(self, text: str) -> None:
        if text:
            self.items.append(Text(text))


def csv_of(rows: Sequence[Sequence[Any]]) -> str:
    """Lines of RFC 4180."""
    text = io.StringIO()
    csv.writer(text).writerows(rows)
    return text.getvalue()


def markdown_of(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    return "".join(f"| {' | '.join(row)} |\n" for row in [columns, ["---"] * len(columns), *rows])


def _embedded(path: Path) -> str:
    kind = {".png": "png", ".svg": "svg+xml"}[path.suffix]
    return f"data:image/{kind};base64,{base64.b64encode(path.read_bytes()).decode()}"


def write_report(folder: Path, title: str, facts: dict[str, str], missing: list[str], chapters: list[Chapter],
                 findings: list[str]) -> Path:
    """Writes tables, plots, and report.html. Returns the last."""
    for chapter in chapters:
        for item in chapter.items:
            if isinstance(item, Table):
                write_text(folder / "tables" / f"{item.file}.csv", csv_of([item.columns, *item.rows]))
            if isinstance(item, Plot):
                item.path = folder / "plots" / f"{item.file}.svg"
                with replacing(item.path) as temporary:
                    item.draw(temporary)
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(Path(__file__).parent), autoescape=True,
                                     undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters["embedded"] = _embedded
    page = environment.get_template("report.html").render(
        title=title, facts=facts, missing=missing, chapters=chapters, findings=findings)
    write_text(folder / "report.html", page)
    return folder / "report.html"
