#!/usr/bin/env python3
"""Every verb under valgrind: test_memory.py MULDI_SIM [--gen-suppressions]. No invalid access, no use of what was never set, no leak.

No library needs an excuse so far; one would stand in valgrind.supp beside this file, with its reason (--gen-suppressions prints what to
write there). Memory that a library holds until the end of the process is no leak.
"""

import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "unit" / "app"))
from program import PROGRAM, SCENES, ProgramTest, options

EXCUSED = pathlib.Path(__file__).resolve().parent / "valgrind.supp"
FAULT = 99
VALGRIND = ["valgrind", "--quiet", f"--error-exitcode={FAULT}", "--leak-check=full", "--show-leak-kinds=definite,indirect"]
VALGRIND += ["--errors-for-leak-kinds=definite", "--num-callers=30", f"--suppressions={EXCUSED}"]
if "--gen-suppressions" in sys.argv:
    sys.argv.remove("--gen-suppressions")
    VALGRIND.append("--gen-suppressions=all")
SHORT = options(["dynamics.duration=50 ms"])
CELLS = options(["solids.cube.mesh.box.cells=[2, 2, 2]", "statics.steps=2", "dynamics.duration=2 ms"])


class Memory(ProgramTest):
    def checked(self, *arguments, code=0):
        """Runs the program under valgrind; the exit code must be `code`."""
        command = [*VALGRIND, str(PROGRAM), *map(str, arguments)]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=900, check=False)
        self.assertEqual(done.returncode, code, f"{' '.join(map(str, arguments))}\n{done.stdout[-2000:]}{done.stderr[-20000:]}")
        return done.stdout + done.stderr

    def pendulum(self, name="a.h5"):
        self.program("run", SCENES / "pendulum.yaml", "-o", name, *SHORT)
        return name

    def test_run_of_bodies_and_muscles(self):
        for scene in ("pendulum", "four_bar", "revolute_joint_lumped", "elephant_trunk_lumped", "slack_cable"):
            with self.subTest(scene=scene):
                self.checked("run", SCENES / f"{scene}.yaml", "-o", f"{scene}.h5", *SHORT)

    def test_run_of_solids(self):
        for number in ("I", "II", "III", "IV"):
            with self.subTest(formulation=number):
                self.checked("run", SCENES / f"boxed_cube_{number}.yaml", "-o", f"{number}.h5", "--threads", 2, *CELLS)

    def test_run_of_solids_on_bodies(self):
        short = options(["statics.steps=1", "dynamics.duration=2 ms", "record.every=1"])
        self.checked("run", SCENES / "revolute_joint_twin.yaml", "-o", "twin.h5", "--threads", 2, *short)

    def test_run_of_an_external_mesh(self):
        self.checked("run", SCENES / "cook_membrane.yaml", "-o", "cook.h5", *options(["statics.steps=1"]))

    def test_run_that_goes_on(self):
        self.pendulum()
        self.checked("run", SCENES / "pendulum.yaml", "--resume", "a.h5", *options(["dynamics.duration=100 ms"]))

    def test_run_that_fails(self):
        self.checked("run", SCENES / "pull_in.yaml", "-o", "pulled.h5", *options(["statics.continuation=natural"]), code=3)
        self.checked("run", SCENES / "pendulum.yaml", "-o", "pendulum.h5", *options(["dynamics.duration=0"]), code=2)
        self.checked("run", self.write("bad.yaml", "muldi: 1\nbodies: {a: {mass: [}\n"), code=2)

    def test_optimise(self):
        self.checked("optimise", SCENES / "double_integrator_optimal.yaml", "-o", "o.h5")
        self.checked("optimise", SCENES / "pendulum_swing_up.yaml", "-o", "p.h5", *options(["optimal_control.stages[0].max_iterations=3"]), code=3)

    def test_check(self):
        self.checked("check", SCENES / "revolute_joint_lumped.yaml", "--derivatives")

    def test_validate(self):
        self.checked("validate", *sorted(SCENES.glob("*.yaml")))

    def test_compare(self):
        self.pendulum("a.h5")
        self.program("run", SCENES / "pendulum.yaml", "-o", "b.h5", *SHORT, "--set", "dynamics.step=2.5 ms", "--set", "record.every=2")
        self.checked("compare", "a.h5", "a.h5")
        self.checked("compare", "a.h5", "b.h5", code=1)

    def test_info(self):
        self.checked("info", self.pendulum())
        self.checked("info", self.write("broken.h5", "no result"), code=2)

    def test_schema(self):
        for choice in ((), ("--study",), ("--markdown",)):
            self.checked("schema", *choice)

    # What draws is a Python of its own, which valgrind leaves alone.
    def test_plot(self):
        self.checked("plot", self.pendulum(), "-o", "a.svg")

    def test_report(self):
        self.checked("report", self.pendulum(), "-o", "a.html")

    def test_paraview(self):
        self.checked("paraview", self.pendulum())

    def test_new(self):
        for kind in ("joint", "muscle", "trunk", "solid", "optimal"):
            self.checked("new", kind)

    def test_explain(self):
        self.checked("explain")
        self.checked("explain", "muscles.*.section")
        self.checked("explain", "muscles.*.sectoin", code=2)

    def test_sweep(self):
        study = self.write("s.yaml", f"sweep: 1\nscene: {SCENES / 'pendulum.yaml'}\nset: {{dynamics.duration: 20 ms}}\n"
                           "vary: {dynamics.step: [1 ms, 2 ms, 4 ms, 5 ms]}\noutputs: {energy: \"energy.total[-1]\"}\n")
        self.checked("sweep", study, "--jobs", 2)

    def test_calibrate(self):
        self.checked("calibrate", SCENES / "studies" / "kofod_permittivity.yaml", "-o", "c.yaml", "--results", "c.h5")


if __name__ == "__main__":
    unittest.main()
