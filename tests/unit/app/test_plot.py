#!/usr/bin/env python3
"""The verb plot: test_plot.py MULDI_SIM."""

import os
import re
import shutil
import stat
import subprocess
import unittest

import h5py

from program import PROGRAM, ROOT, SCENES, ProgramTest, options

JOINT = SCENES / "revolute_joint_lumped.yaml"


def texts(path):
    """The texts of a figure: matplotlib leaves each as a comment beside its outlines."""
    return re.findall(r"<!-- (.*?) -->", path.read_text(encoding="utf-8"))


class Plot(ProgramTest):
    def joint(self, output, *overrides):
        return self.run_scene(JOINT, output, "--no-progress", *options(["dynamics.duration=40", *overrides]))

    def test_draws_what_the_file_holds_with_units_and_legends(self):
        self.joint("a.h5")
        self.program("plot", "a.h5")
        found = texts(self.folder / "a.svg")
        for text in (
            ["Joint coordinates of hinge", "Joint coordinates of hinge, equilibria", "coordinate (rad)", "time (ms)", "load factor"]
            + ["Muscle stretch", "Muscle force", "force (N)", "upper", "lower", "field (V/mm)"]
            + ["Controls", "agonist", "antagonist", "Energy", "energy (mJ)", "kinetic", "dissipated", "Energy balance"]
        ):
            self.assertIn(text, found)
        self.assertNotIn("Solver: work", found)

    def test_overlays_several_results_and_is_the_same_file_every_time(self):
        self.joint("a.h5")
        self.joint("b.h5", "muscles.upper.section.diameter=8")
        figures = []
        for name in ("one.svg", "two.svg"):
            self.program("plot", "a.h5", "b.h5", "--what", "joints,muscles", "-o", name)
            figures.append((self.folder / name).read_bytes())
        found = texts(self.folder / "one.svg")
        # Where one name is in both, files are told apart; where there are two names, both stand in the legend.
        self.assertEqual([found.count(text) for text in ("a", "b", "upper")], [8, 8, 6])
        self.assertEqual(figures[0], figures[1])

    def test_shows_the_exchange_of_energies_that_a_field_at_rest_would_hide(self):
        self.run_scene("revolute_joint_fe.yaml", "a.h5", "--no-progress", *options(["dynamics.duration=20"]))
        self.program("plot", "a.h5", "--what", "energy")
        found = texts(self.folder / "a.svg")
        self.assertIn("Energy exchange", found)
        self.assertIn("change of energy (mJ)", found)
        self.run_scene("pendulum.yaml", "b.h5", "--no-progress")
        self.program("plot", "b.h5", "--what", "energy")
        self.assertNotIn("Energy exchange", texts(self.folder / "b.svg"))

    def test_shows_where_equilibria_are_unstable(self):
        self.run_scene("pull_in.yaml", "a.h5")
        self.program("plot", "a.h5", "--what", "muscles", "-o", "a.svg")
        found = texts(self.folder / "a.svg")
        self.assertIn("control supply (V/mm)", found)
        self.assertIn("unstable", found)
        # The force of a free actuator is nothing but round-off.
        self.assertNotIn("Muscle force of actuator, equilibria", found)

    def test_errors_over_the_step_fall_with_the_second_order(self):
        files = []
        for step in (4, 2, 1, 0.25):
            files.append(self.joint(f"step{step}.h5", f"dynamics.step={step}", "dynamics.duration=80"))
        self.program("plot", *files, "--what", "convergence", "-o", "a.svg")
        found = texts(self.folder / "a.svg")
        self.assertIn("Error against the step 0.25 ms (step0.25)", found)
        slopes = [float(text.rsplit(" ", 1)[1]) for text in found if ", slope " in text]
        self.assertEqual(len(slopes), 4)
        # Second order; the error of the finest one, a sixteenth of that of step 1, adds up to 0.05.
        for slope in slopes:
            self.assertGreater(slope, 1.95)
            self.assertLess(slope, 2.1)

    def test_draws_replays_beside_optima(self):
        # The layout of an optimum, by hand: its trajectory in the ordinary groups, iterates by stage, a replay.
        self.joint("a.h5")
        with h5py.File(self.folder / "a.h5", "r+") as file:
            replay = file.create_group("replay")
            for name in ("time", "joints", "controls"):
                file.copy(name, replay)
            for name, values in (("objective", [3.0, 2.0, 1.5]), ("infeasibility", [1.0, 1e-3, 0.0])):
                file[f"optimum/1/iterates/{name}"] = values
        self.program("plot", "a.h5", "--what", "joints,optimum", "-o", "a.svg")
        found = texts(self.folder / "a.svg")
        self.assertIn("a, replay", found)
        self.assertLessEqual({"Optimum: objective of stage 1", "Optimum: infeasibility of stage 1", "iteration"}, set(found))

    def test_writes_png_and_pdf(self):
        self.joint("a.h5")
        for ending, begin in ((".png", b"\x89PNG"), (".pdf", b"%PDF")):
            self.program("plot", "a.h5", "--what", "joints", "-o", "fig" + ending)
            self.assertTrue((self.folder / ("fig" + ending)).read_bytes().startswith(begin), ending)

    def test_draws_a_running_file(self):
        output = self.folder / "a.h5"
        process = self.start("run", JOINT, "-o", output, *options(["dynamics.duration=10000 s"]))
        with self.open_live(output, process) as file:

            def has_rows():
                file["time"].id.refresh()
                return file["time"].shape[0] > 100

            self.wait_for(has_rows, process, "rows come in")
            self.program("plot", output, "--what", "joints", "-o", "a.svg")
        self.assertIsNone(process.poll(), "drawn while it was running")
        self.assertIn("coordinate (rad)", texts(self.folder / "a.svg"))


class View(ProgramTest):
    def test_is_a_still_picture_of_bodies_muscles_and_solids(self):
        self.run_scene("revolute_joint_lumped.yaml", "a.h5", *options(["dynamics.duration=100", "record.every=20"]))
        self.program("plot", "a.h5", "--what", "view", "-o", "a.svg")
        text = (self.folder / "a.svg").read_text()
        # A box of six faces, two tubes of ten sides and two ends; the first state behind the last one.
        self.assertEqual([group.split("</g>")[0].count("<path") for group in text.split('<g id="PolyCollection')[1:]], [6 + 2 * 12, 6 + 2 * 12])
        self.program("plot", "a.h5", "--what", "view", "-o", "b.svg")
        self.assertEqual(text, (self.folder / "b.svg").read_text())

    def test_is_of_one_file_that_holds_something_to_see(self):
        self.run_scene("cube.yaml", "a.h5", *options(["dynamics.duration=2e-3", "solids.cube.mesh.box.cells=[2, 2, 2]"]))
        for words in (["a.h5", "a.h5", "--what", "view"], ["a.h5", "--what", "view,energy"]):
            self.assertEqual(self.message("plot", *words, code=2), "error: --what: view is a picture of one file: ask for it alone")
        self.assertEqual(
            self.message("plot", "a.h5", "--what", "view", code=2),
            "error: 'a.h5' holds nothing to see: no bodies, muscles or springs, and no fields of solids (record.fields)",
        )


class Refuses(ProgramTest):
    def test_unknown_kinds_and_what_no_file_holds(self):
        self.run_scene("pendulum.yaml", "a.h5", *options(["dynamics.duration=10"]))
        self.assertEqual(
            self.message("plot", "a.h5", "--what", "enrgy", code=2),
            "error: --what: no plot 'enrgy' (did you mean 'energy'?); known: energy, joints, muscles, controls, points, probes, momentum, solver, "
            "optimum, convergence, view",
        )
        self.assertEqual(
            self.message("plot", "a.h5", "--what", "energy,muscles", code=2),
            "error: --what: no muscles in a.h5 (there: joints, points, energy, momentum, solver)",
        )
        self.assertEqual(
            self.message("plot", "a.h5", "--what", "convergence", code=2),
            "error: --what convergence: give three or more results of different steps, got 1",
        )
        self.assertEqual(self.message("plot", "a.h5", "-o", "a.gif", code=2), "error: -o: 'a.gif' must end in .svg, .png, .pdf")

    def test_files_that_are_no_results(self):
        self.write("a.h5", "text")
        self.assertEqual(self.message("plot", "a.h5", code=2), "error: cannot read 'a.h5': not an HDF5 file")
        self.assertEqual(self.message("report", "a.h5", code=2), "error: cannot read 'a.h5': not an HDF5 file")
        self.assertEqual(self.message("paraview", "b.h5", code=2), "error: cannot read 'b.h5': No such file or directory")

    def test_files_that_hdf5_never_finishes_or_that_end_it(self):
        ends = {
            "while True: pass": "error: a result is damaged: HDF5 does not come to an end with it",
            "os.kill(os.getpid(), 11)": "error: a result is damaged: HDF5 was ended by signal 11 as it read it",
        }
        for what, sentence in ends.items():
            program = (
                f"import os, sys; sys.path.insert(0, {str(ROOT / 'tools' / 'look')!r})\nimport guarded\nguarded.SECONDS = 0.2\n"
                f"def body():\n    with guarded.reading(0):\n        {what}\nguarded.run('plot', body)"
            )
            done = subprocess.run(["/usr/bin/python3", "-c", program], capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual((done.returncode, done.stderr.strip()), (2, sentence))

    def test_a_python_without_the_modules_says_what_to_install(self):
        self.run_scene("pendulum.yaml", "a.h5", *options(["dynamics.duration=10"]))
        bare = self.write("bare", '#!/bin/sh\nexec /usr/bin/python3 -S "$@"\n')
        bare.chmod(bare.stat().st_mode | stat.S_IXUSR)
        done = self.program("plot", "a.h5", code=4, env={**os.environ, "MULDI_PYTHON": str(bare)})
        self.assertRegex(done.stderr, r"^error: plot needs the Python module (numpy|h5py|matplotlib) .* as root: apt-get install python3-\w+ ")
        done = self.program("plot", "a.h5", code=4, env={**os.environ, "MULDI_PYTHON": "no-such-python"})
        self.assertEqual(done.stderr, "error: cannot start Python (no-such-python); as root: apt-get install python3\n")

    def test_a_figure_that_cannot_be_written(self):
        self.run_scene("pendulum.yaml", "a.h5", *options(["dynamics.duration=10"]))
        done = self.program("plot", "a.h5", "-o", "none/a.svg", code=4)
        self.assertEqual(done.stderr, "error: cannot write 'none/a.svg': No such file or directory\n")


class Installed(ProgramTest):
    def test_finds_its_programs_beside_an_installed_binary(self):
        self.run_scene("pendulum.yaml", "a.h5", *options(["dynamics.duration=10"]))
        share = self.folder / "share" / "muldi-sim"
        share.mkdir(parents=True)
        shutil.copytree(ROOT / "tools" / "look", share / "look")
        (share / "look" / "plot.py").write_text("print('the installed one')\n")
        (self.folder / "bin").mkdir()
        shutil.copy2(PROGRAM, self.folder / "bin" / "muldi-sim")
        done = subprocess.run([self.folder / "bin" / "muldi-sim", "plot", self.folder / "a.h5"], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout, "the installed one\n")


if __name__ == "__main__":
    unittest.main()
