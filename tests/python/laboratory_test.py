"""The laboratory on very small scenes: every section end to end, and nothing done twice.

Run by ctest with RELUME_PROGRAM; PYTHONPATH names the module.
"""

import contextlib
import csv
import dataclasses
import io
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock

import numpy as np

import relume
from relume.laboratory import __main__ as laboratory, evaluation, paper_figures, scenes, sources, tables
from relume.laboratory.bakes import Recipe
from relume.laboratory.evaluation import Evaluation
from relume.laboratory.inputs import Inputs
from relume.laboratory.measures import (MeasuredError, are_distinguishable, exposure_of, measured_error, noise_of,
                                        range_text)
from relume.laboratory.scenes import QUICK
from relume.laboratory.store import LabError, kept, locked, replacing

OCTAHEDRON = ("v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
              "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n")
TINY = dataclasses.replace(QUICK, name="--tiny", triangles=6, ground=4, options={"visibility_size": 64, "map_size": 16},
                           wide=(32, 24), terms=4, noise=0.5, passes=32, points=(8, 6), point_passes=32, rounds=1)


class Folder(unittest.TestCase):
    """A test with a folder of its own, in which lie a mesh and environments."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.data, self.out = self.folder / "data", self.folder / "out"
        for name in ("meshes", "environments"):
            (self.data / name).mkdir(parents=True)
        self.bunny = self.data / "meshes" / "bunny.obj"
        self.bunny.write_text(OCTAHEDRON)
        rng = np.random.default_rng(1)
        for name in ("grace", "stpeters", "rnl"):
            pixels = np.ones((16, 32, 4), np.float32)
            pixels[..., :3] = rng.random((16, 32, 3))
            relume.Image(pixels).save(self.data / "environments" / f"{name}.exr")

    def evaluate(self, *only, scale=TINY, sections=laboratory.SECTIONS):
        """Whether all went well, and what was said."""
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            went_well = Evaluation(self.out, self.data, scale).run(sections, only)
        return went_well, said.getvalue()

    def steps(self):
        """When the results of steps were written, by name."""
        return {path.name.rpartition("-")[0]: path.stat().st_mtime_ns for path in (self.out / "steps").iterdir()}

    def table(self, name):
        with open(self.out / "tables" / f"{name}.csv", newline="") as file:
            return list(csv.DictReader(file))

    def report(self):
        return (self.out / "report.html").read_text()


class MeasuresTest(unittest.TestCase):
    @staticmethod
    def halves(rng, sigma, truth=2.0, size=(60, 80)):
        """Samples of a constant truth with normal noise; a row is covered by nothing."""
        images = []
        for _ in range(2):
            image = np.ones((*size, 4))
            image[..., :3] = truth + sigma * rng.standard_normal((*size, 3))
            image[0] = 0
            images.append(image)
        return tuple(images)

    def test_an_error_without_noise_is_exact(self):
        halves = self.halves(np.random.default_rng(1), 0)
        image = np.full((60, 80, 4), 2.5)
        image[0] = 99  # where nothing is covered, nothing counts
        error = measured_error(image, halves)
        for value in (error.value, error.low, error.high):
            self.assertAlmostEqual(value, 0.25, places=12)
        self.assertEqual(noise_of(halves), 0)
        self.assertEqual(measured_error(halves[0], halves), MeasuredError(0, 0, 0))

    def test_an_interval_is_that_of_normal_noise(self):
        sigma, offset, truth, count = 0.4, 0.3, 2.0, 59 * 80 * 3
        # Of the mean of (A - x)(B - x): the variance of a product of two normal values about the offset.
        expected = np.sqrt((2 * offset ** 2 * sigma ** 2 + sigma ** 4) / count)
        image = np.full((60, 80, 3), truth + offset)
        inside = 0
        for seed in range(100):
            halves = self.halves(np.random.default_rng(seed), sigma)
            error = measured_error(image, halves)
            found = (error.high ** 2 - error.value ** 2) * truth ** 2 / 2
            self.assertAlmostEqual(found / expected, 1, delta=0.06)
            self.assertAlmostEqual(error.value ** 2 - error.low ** 2, error.high ** 2 - error.value ** 2, places=9)
            inside += error.low <= offset / truth <= error.high
        self.assertGreaterEqual(inside, 88)  # of 95 expected
        self.assertLess(inside, 100)
        self.assertAlmostEqual(noise_of(halves), sigma / np.sqrt(2) / truth, delta=0.003)

    def test_numbers_as_text(self):
        self.assertEqual(str(MeasuredError(0.0441, 0.0438, 0.0444)), "4.41 % (4.38 to 4.44)")
        self.assertEqual(str(MeasuredError(0.5, 0.4, 0.6)), "50.0 % (40.0 to 60.0)")
        self.assertEqual(str(MeasuredError(0.001, 0, 0.0031)), "at most 0.3 %")
        self.assertEqual(range_text([]), "-")
        self.assertEqual(range_text([1.2, 0.84, 1]), "0.84 to 1.2")
        self.assertEqual(range_text([1234.4]), "1234")
        near, far = MeasuredError(0.10, 0.09, 0.11), MeasuredError(0.20, 0.19, 0.21)
        self.assertTrue(are_distinguishable(near, far))
        self.assertFalse(are_distinguishable(near, MeasuredError(0.105, 0.09, 0.115)))

    def test_a_bright_gray_is_exposed_for(self):
        image = np.zeros((10, 10, 4))
        image[:5] = [2.4, 2.4, 2.4, 1]
        self.assertAlmostEqual(exposure_of(image), -2)
        self.assertEqual(exposure_of(np.zeros((2, 2, 4))), 0)


class StoreTest(Folder):
    def test_a_step_whose_file_exists_is_not_done_again(self):
        calls = []

        def work():
            calls.append(1)
            return {"value": 0.1}
        for _ in range(2):
            self.assertEqual(kept(self.folder, "step", ["a"], work), {"value": 0.1})
        self.assertEqual(len(calls), 1)
        kept(self.folder, "step", ["b"], work)  # what decides it is another
        self.assertEqual(len(calls), 2)
        next((self.folder / "steps").iterdir()).write_text("{")
        kept(self.folder, "step", ["a"], work)
        kept(self.folder, "step", ["b"], work)
        self.assertEqual(len(calls), 3)

    def test_files_appear_whole_or_not_at_all(self):
        path = self.folder / "a.txt"
        with self.assertRaises(ValueError), replacing(path) as temporary:
            temporary.write_text("half")
            raise ValueError
        self.assertEqual([file.name for file in self.folder.iterdir()], ["data"])

    def test_one_at_a_time_has_a_folder(self):
        with locked(self.out), self.assertRaisesRegex(LabError, "another process"), locked(self.out):
            pass
        with locked(self.out):
            pass


class InputsTest(Folder):
    def test_what_is_missing_is_named(self):
        inputs = Inputs(self.data, stand_ins=False)
        self.assertEqual(inputs.model("bunny").file, self.bunny)
        self.assertEqual(inputs.missing, [])
        self.assertIsNone(inputs.model("lucy"))
        self.assertIsNone(inputs.environment("uffizi"))
        self.assertIn(f"Lucy: looked for {self.data}/meshes/lucy*", inputs.missing[0])
        self.assertIn("uffizi*.{exr,hdr}; scenes that need it are skipped", inputs.missing[1])

    def test_a_stand_in_says_so(self):
        lucy = Inputs(self.data, stand_ins=True).model("lucy")
        self.assertEqual(str(lucy), "bunny, standing for Lucy")
        (self.data / "meshes" / "lucy_low.obj").write_text(OCTAHEDRON)
        (self.data / "meshes" / "buddha.txt").write_text("no mesh")
        inputs = Inputs(self.data, stand_ins=True)
        self.assertEqual(str(inputs.model("lucy")), "Lucy")
        self.assertEqual(inputs.model("buddha").stands_for, "Buddha")

    def test_bakes_that_see_the_same_share_visibility(self):
        model = Inputs(self.data, False).model("bunny")

        def key(**options):
            return Recipe("", model, "gold", options).visibility_key()
        self.assertEqual(key(preset="paper", terms=1), key(preset="paper", terms=4))
        self.assertEqual(key(refine="off", terms=8), key(refine="off", layout="rows"))
        self.assertNotEqual(key(preset="paper"), key(refine="off"))
        self.assertNotEqual(key(refine="off"), key(refine="off", visibility_size=64))
        for refined in ({}, {"refine": 0.01}, {"preset": "paper", "refine": 0.01}):
            self.assertIsNone(key(**refined))


class EvaluationTest(Folder):
    def setUp(self):
        super().setUp()
        # Isotropic materials are planned five times as fast.
        for module in (scenes, tables, paper_figures):
            patch = unittest.mock.patch.object(module, "ASHIKHMIN_SHIRLEY", "gold")
            patch.start()
            self.addCleanup(patch.stop)

    def test_every_section_is_reported(self):
        for module, name, few in ((tables, "_FRAMES", ((32, 24),)), (paper_figures, "_MAP_SIZES", (6, 8)),
                                  (paper_figures, "_SHEET_SIZE", 8),
                                  (paper_figures, "_BRDFS", paper_figures._BRDFS[:1]),
                                  (paper_figures, "_SCENES", paper_figures._SCENES[:1]),
                                  (sources, "_MATERIALS", ("red-plastic",)), (sources, "_UNIFORM", (4, 8)),
                                  (sources, "_REFINED", (0.05,))):
            patch = unittest.mock.patch.object(module, name, few)
            patch.start()
            self.addCleanup(patch.stop)
        went_well, said = self.evaluate()
        self.assertTrue(went_well, said)
        report = self.report()
        for text in ("Table 1", "Table 2", "Figure 2", "Figure 3", "Figure 4", "Figure 5", "Figures 1, 6 and 7",
                     "Where error comes from", "Vertices where shadows end", "Beyond the paper", "What was found",
                     "Pentium 4", "dragon*", "data:image/png;base64,", "data:image/svg+xml;base64,"):
            self.assertIn(text, report)
        for text in ("not done yet", "Failed:", "Skipped:"):
            self.assertNotIn(text, report)
        self.assertEqual({path.stem for path in (self.out / "tables").iterdir()},
                         {"table_1", "table_1_stages", "table_2", "figure_2", "figure_3", "figure_4", "figure_5",
                          "scenes", "error-sums", "error-sources", "error-harmonics", "refinement", "layouts"})
        self.assertEqual(list((self.out / "bakes").iterdir()), [])

        rows = self.table("table_1")
        self.assertEqual([(row["model with ground"], row["K"]) for row in rows],
                         [("bunny", "1"), ("bunny", "4")])
        self.assertEqual(rows[0]["paper's minutes"], "21")
        self.assertEqual(rows[0]["vertices"], str(5 + 5 * 5))  # simplified from 6, and a ground
        self.assertEqual([row["layout"] for row in self.table("table_2")], ["rows", "rows", "bases"])
        errors = [float(row["the paper's terms alone (interval)"].split()[0]) for row in self.table("figure_2")]
        self.assertGreater(errors[0], errors[-1])  # more terms are nearer
        self.assertGreater(float(self.table("figure_4")[0]["K = 1"]), 0)
        lossless = [float(row["bytes per vertex"]) for row in self.table("figure_3")]
        self.assertEqual(lossless, sorted(lossless))
        self.assertEqual(len(self.table("error-sources")), 3)
        self.assertLess(abs(float(self.table("error-sums")[0]["ratio"]) - 1), 0.1)
        grounds = self.table("refinement")
        self.assertEqual([row["its vertices"] for row in grounds[:2]], ["25", "81"])
        self.assertGreater(grounds[0]["Grace Cathedral"], grounds[1]["Grace Cathedral"])

        before = self.steps()
        went_well, said = self.evaluate()
        self.assertTrue(went_well)
        self.assertIn(f"{len(before)} steps, {len(before)} of them done before", said)
        self.assertNotIn("step 1 of", said)
        self.assertEqual(self.steps(), before)

    def test_only_what_is_not_there_is_done(self):
        went_well, said = self.evaluate("table-1", "figure-3")
        self.assertTrue(went_well, said)
        self.assertEqual(said.count("visibility of 30 vertices reused"), 4)  # by five bakes of figure 3
        before = self.steps()
        self.assertEqual(len(before), 2 + 6)
        report = self.report()
        self.assertIn("Table 1", report)
        self.assertNotIn("Table 2", report)
        self.assertNotIn("uffizi", report)  # which neither asks for
        next((self.out / "steps").glob("table-1-bunny-k1-*")).write_text("{")
        (self.out / "images" / "figure-3-reference" / "reference.png").unlink()
        went_well, said = self.evaluate("table-1")
        self.assertTrue(went_well)
        self.assertIn("2 steps, 1 of them done before", said)
        after = self.steps()
        self.assertEqual({name for name in after if after[name] != before[name]}, {"table-1-bunny-k1"})
        self.assertNotIn("Figure 3", self.report())  # of which a picture is missing
        self.evaluate("figure-3")
        self.assertIn("Table 1", self.report())  # which was done before
        self.assertEqual({name for name in self.steps() if self.steps()[name] != after[name]}, {"figure-3-reference"})
        self.bunny.write_text(OCTAHEDRON.replace("v 0 1 0", "v 0 2 0"))
        self.assertIn("2 steps, 0 of them done before", self.evaluate("table-1")[1])

    def test_what_is_missing_is_named_and_skipped(self):
        for path in (self.data / "environments").iterdir():
            path.unlink()
        sections = {"figure-2": laboratory.SECTIONS["figure-2"], "table-2": laboratory.SECTIONS["table-2"]}
        self.assertTrue(self.evaluate("figure-2", sections=sections)[0])
        report = self.report()
        self.assertIn("data/meshes/buddha*", report)
        self.assertIn("bunny, standing for Buddha", report)
        self.assertIn("With --tiny", report)
        with unittest.mock.patch.object(evaluation, "FULL", TINY):  # in full nothing stands in for what is missing
            self.assertTrue(self.evaluate("figure-2", sections=sections)[0])
        self.assertIn("Skipped: there is no Buddha.", self.report())

    def test_a_step_that_fails_is_told_and_others_go_on(self):
        (self.data / "meshes" / "lucy.obj").write_text("v 0 0 nonsense\nf 1 2 3\n")
        went_well, said = self.evaluate("table-1", scale=dataclasses.replace(TINY, triangles=0))
        self.assertFalse(went_well)
        self.assertIn("Failed: Table 1: Lucy, K = 1: relume bake", self.report())
        self.assertIn("lucy.obj", said)
        self.assertEqual(set(self.steps()), {"table-1-bunny-k1", "table-1-bunny-k4"})


class CommandTest(Folder):
    def run_command(self, *arguments):
        """Exit code, stdout and stderr."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                code = laboratory.main([str(argument) for argument in arguments])
            except SystemExit as stop:
                code = stop.code
        return code, out.getvalue(), err.getvalue()

    def light(self):
        return f"sky={self.data}/environments/grace.exr"

    def test_what_is_unknown_is_refused(self):
        code, _, said = self.run_command("evaluate", "--only", "table-1,tabel-2", "-o", self.out)
        self.assertEqual(code, 2)
        self.assertIn('did you mean "table-2"?', said)
        code, _, said = self.run_command("evaluate", "--data", self.folder / "nowhere", "-o", self.out)
        self.assertEqual(code, 2)
        self.assertIn("nowhere is no folder", said)
        self.assertFalse(self.out.exists())
        code, _, said = self.run_command("evaluate", "--only", "table-1", "-o", self.bunny / "out")
        self.assertEqual(code, 1)
        self.assertIn("the folder cannot be made", said)
        self.assertEqual(self.run_command("brdf", "clay")[0], 2)
        self.assertEqual(self.run_command("factorization", "clay")[0], 2)
        code, _, said = self.run_command("factorization", "--only", "cley", "-e", self.light(), "-o", self.out)
        self.assertEqual(code, 2)
        self.assertIn("clay", said)

    def test_what_is_stopped_goes_on(self):
        command = [sys.executable, "-m", "relume.laboratory", "evaluate", "--quick", "--data", self.data, "--only",
                   "table-1,figure-3", "-o", self.out]
        with open(self.folder / "err.txt", "w") as err:
            process = subprocess.Popen(command, stderr=err, start_new_session=True)
        while process.poll() is None and not list(self.out.glob("steps/table-1-bunny-k1-*")):
            time.sleep(0.01)
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does
        self.assertEqual(process.wait(), 130)
        self.assertIn("the same command goes on", (self.folder / "err.txt").read_text())
        self.assertIn("2 steps, 1 of them done before", self.evaluate("table-1", scale=QUICK)[1])

    def test_factorizations_are_compared(self):
        arguments = ("factorization", "--only", "clay", "gold", "-e", self.light(), "--sizes", "6,8", "--orientations",
                     2, "-o", self.out)
        code, tables, said = self.run_command(*arguments)
        self.assertEqual(code, 0, said)
        self.assertIn("| clay |", tables)
        self.assertIn("## Radiance, paper → default, K = 16, S = 8", tables)
        with open(self.out / "factorization.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({row["material"] for row in rows}, {"clay", "gold"})
        self.assertEqual(len({row["approach"] for row in rows}), 8)
        default = {int(row["terms"]): float(row["error"]) for row in rows
                   if (row["material"], row["approach"], row["size"], row["measure"]) ==
                   ("gold", "environment, equal-area", "8", "pixels")}
        self.assertLess(default[max(default)], default[1])
        for name in ("rms", "sky"):
            self.assertIn("<svg", (self.out / f"factorization_{name}.svg").read_text()[:1000])
        before = self.steps()
        self.assertEqual(self.run_command(*arguments)[:2], (0, tables))
        self.assertEqual(self.steps(), before)

        code, table, said = self.run_command("factorization", "--sets", "--only", "clay", "gold", "-e", self.light(),
                                             "--sizes", "8", "--orientations", 2, "-o", self.out)
        self.assertEqual(code, 0, said)
        self.assertIn("| alone / 2 | K = 4 |", table)
        self.assertIn("| mean of ratios to alone | 1.00 / ", table)

    def test_layouts_are_measured(self):
        rows = self.folder / "rows.relume"
        relume.bake(relume.Scene().add(self.bunny, "gold"), rows, refine="off", terms=2, coefficients=32, layout="rows",
                    visibility_size=64, map_size=16)
        arguments = ("layouts", f"solid={rows}", "-e", self.light(), "--rows", "8,16", "--budgets", "60", "--width", 24,
                     "--height", 16, "-o", self.out)
        code, tables, said = self.run_command(*arguments)
        self.assertEqual(code, 0, said)
        self.assertIn("solid: 6 vertices, K = 2", tables)
        with open(self.out / "layouts.csv", newline="") as file:
            ways = list(csv.DictReader(file))
        self.assertEqual([way["layout"] for way in ways], ["source", "rows", "rows", "bases"])
        self.assertEqual((float(ways[0]["transport_error"]), float(ways[0]["relit_error"])), (0, 0))
        self.assertGreater(float(ways[1]["transport_error"]), float(ways[2]["transport_error"]))
        self.assertGreater(float(ways[2]["transport_error"]), 0)
        self.assertLess(float(ways[1]["bytes"]), float(ways[2]["bytes"]))
        for way in ways:
            self.assertGreater(float(way["on_disk"]), 0)
            self.assertLess(float(way["image_error"]), 1)
        before = self.steps()
        self.assertEqual(self.run_command(*arguments)[:2], (0, tables))
        self.assertEqual(self.steps(), before)

        relume.bake(relume.Scene().add(self.bunny, "gold"), self.folder / "bases.relume", refine="off", terms=2,
                    visibility_size=64)
        code, _, said = self.run_command("layouts", self.folder / "bases.relume", "-e", self.light(), "-o", self.out)
        self.assertEqual(code, 1)
        self.assertIn("expected a bake in rows", said)

    def test_a_brdf_is_drawn(self):
        plot, lobes = self.folder / "plot.svg", self.folder / "lobes.svg"
        code, _, said = self.run_command("brdf", "red-plastic", "-K", 4, "--size", 12, "-e", self.light(), "--plot",
                                         plot, "--slice", lobes)
        self.assertEqual(code, 0, said)
        self.assertIn("radiance, expected", plot.read_text())
        self.assertIn("sky", plot.read_text())
        self.assertIn("light at 80°", lobes.read_text())
        first = plot.read_bytes()
        self.run_command("brdf", "red-plastic", "-K", 4, "--size", 12, "-e", self.light(), "--plot", plot)
        self.assertEqual(plot.read_bytes(), first)


if __name__ == "__main__":
    unittest.main()
