#!/usr/bin/env python3
"""Sweeps as their users meet them: test_sweep.py MULDI_SIM. Tables, broken runs, shards, Slurm scripts, failures."""

import csv
import os
import pathlib
import random
import re
import signal
import subprocess
import time
import unittest

import h5py

from program import SCENES, ProgramTest

JOINT = SCENES / "revolute_joint_lumped.yaml"
STUDY = """sweep: 1
scene: {scene}
set: {{dynamics.duration: {duration}}}
vary:
  controls.agonist.field: {{linspace: [0, 30 kV/mm, {n}]}}
  muscles.*.section.diameter: [10, 11 mm]
outputs:
  angle: "statics.joints.hinge.coordinate[-1]"
  overshoot: "max(joints.hinge.coordinate)"
"""


class Sweep(ProgramTest):
    def study(self, n=4, duration="50 ms", scene=JOINT, name="s.yaml"):
        return self.write(name, STUDY.format(scene=scene, duration=duration, n=n))

    def table(self, name="s.csv"):
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def both(self, stem="s"):
        """The bytes of the CSV file, and the values of the HDF5 file."""
        with h5py.File(self.folder / f"{stem}.h5") as file:
            sets = {}
            file.visititems(lambda name, item: sets.update({name: item[()].tobytes()}) if isinstance(item, h5py.Dataset) else None)
        return (self.folder / f"{stem}.csv").read_bytes(), sets

    def test_a_point_is_what_a_run_gives(self):
        done = self.program("sweep", self.study())
        self.assertEqual(done.stderr.strip(), "8 of 8 points: s.h5, s.csv")
        last = self.table()[-1]
        self.assertEqual((last["controls.agonist.field [V/mm]"], last["muscles.*.section.diameter [mm]"], last["status"]), ("30000", "11", "completed"))
        self.program("run", JOINT, "-o", "run.h5", "--set", "dynamics.duration=50 ms")
        with h5py.File(self.folder / "run.h5") as run, h5py.File(self.folder / "s.h5") as table:
            self.assertEqual(float(last["angle [rad]"]), run["statics/joints/hinge/coordinate"][-1, 0])
            self.assertEqual(table["outputs/overshoot"][-1], run["joints/hinge/coordinate"][:, 0].max())
            self.assertEqual(table["outputs/angle"].attrs["unit"], b"rad" if isinstance(table["outputs/angle"].attrs["unit"], bytes) else "rad")
            self.assertEqual(list(table["parameters/muscles.*.section.diameter"][:2]), [10.0, 11.0])
        # Published 7.73, independent 7.7284947404 degrees.
        self.assertAlmostEqual(float(last["angle [rad]"]) * 57.29577951308232, 7.7284947404, places=8)

    def test_force_begins_a_finished_sweep_anew(self):
        self.program("sweep", self.study(n=2))
        first = self.both()
        journal = self.folder / "s.journal"
        journal.write_text(journal.read_text().replace("completed", "no_convergence", 1))
        done = self.program("sweep", self.study(n=2), "--force")
        self.assertEqual(done.stderr.strip(), "4 of 4 points: s.h5, s.csv")
        self.assertEqual(self.both(), first)

    def test_jobs_do_not_change_a_byte(self):
        self.program("sweep", self.study(), "-o", "one.h5")
        self.program("sweep", self.study(), "-o", "three.h5", "--jobs", 3)
        self.assertEqual(self.both("one"), self.both("three"))

    def test_killed_at_random_moments_it_ends_with_the_same_table(self):
        study = self.study(n=15, duration="100 ms")
        self.program("sweep", study, "-o", "whole.h5")
        generator = random.Random(5)
        kills = 0
        journal = self.folder / "broken.journal"

        def lines():
            return journal.read_bytes().count(b"\n") if journal.exists() else 0

        for _ in range(6):
            goal = lines() + generator.randrange(5)
            process = self.start("sweep", study, "-o", "broken.h5", "--jobs", 2)
            self.wait_for(lambda: lines() >= goal, process, "points are finished")
            time.sleep(generator.uniform(0.0, 0.01))
            process.kill()
            kills += process.wait() == -signal.SIGKILL
        self.assertGreaterEqual(kills, 2, "kills came in time")
        self.program("sweep", study, "-o", "broken.h5")
        self.assertEqual(self.both("whole"), self.both("broken"))
        self.assertEqual(self.program("sweep", study, "-o", "broken.h5").returncode, 0)  # nothing to do

    def kill_a_child(self, process, number):
        """Ends one of the processes in which points run."""
        children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
        self.wait_for(lambda: children.read_text().split(), process, "a point runs")
        os.kill(int(children.read_text().split()[0]), number)
        return process.wait()

    def test_a_crash_is_the_status_of_its_point(self):
        code = self.kill_a_child(self.start("sweep", self.study(n=2, duration="3 s")), signal.SIGSEGV)
        self.assertEqual(code, 3)
        self.assertRegex(self.said(), r"warning: point 0 \(.*\): crashed: ended by signal 11")
        self.assertEqual([row["status"] for row in self.table()], ["crashed", "completed", "completed", "completed"])

    def test_a_point_killed_from_outside_is_tried_again(self):
        study = self.study(n=2, duration="3 s")
        code = self.kill_a_child(self.start("sweep", study), signal.SIGKILL)
        self.assertEqual(code, 3)
        self.assertIn("killed from outside, for want of memory perhaps: it is tried again the next time", self.said())
        self.assertIn("3 of 4 points; 1 to do", self.said())
        self.program("sweep", study)
        self.assertEqual([row["status"] for row in self.table()], ["completed"] * 4)

    def test_an_interrupt_says_how_to_go_on(self):
        study = self.study(n=40, duration="100 ms")
        self.program("sweep", study, "-o", "whole.h5", "--jobs", 2)
        journal = self.folder / "s.journal"
        process = self.start("sweep", study, "--jobs", 2)
        self.wait_for(lambda: journal.exists() and journal.read_bytes().count(b"\n") > 3, process, "points are finished")
        children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(), 130)
        for child in children:
            self.assertFalse(pathlib.Path("/proc", child).exists(), "points that run are ended")
        kept = journal.read_bytes()
        n_kept = kept.count(b"\n") - 1
        self.assertEqual(self.said(), f"warning: interrupted with {80 - n_kept} of 80 points to do; the same command goes on\n")
        self.assertFalse((self.folder / "s.csv").exists())
        self.program("sweep", study)
        self.assertTrue(journal.read_bytes().startswith(kept), "what was finished is not run again")
        self.assertEqual(self.both("whole"), self.both("s"))

    def test_shards_make_the_table_of_the_whole(self):
        study = self.study()
        self.program("sweep", study, "-o", "whole.h5")
        self.assertEqual(self.message("sweep", study, "-o", "s.h5", "--merge", code=2), "error: nothing to merge: no part of this sweep has begun beside 's.h5'")
        for k in (2, 1):
            self.assertIn(" in other shards", self.program("sweep", study, "-o", "s.h5", "--shard", f"{k}/3").stderr)
        self.assertFalse((self.folder / "s.h5").exists())
        self.program("sweep", study, "-o", "s.h5", "--merge", code=3)  # what there is
        self.assertEqual([row["status"] for row in self.table()].count("missing"), 2)
        self.program("sweep", study, "-o", "s.h5", "--shard", "3/3")
        self.assertEqual(self.both("whole"), self.both("s"))

    def test_the_slurm_script_runs_as_an_array(self):
        study = self.study()
        self.program("sweep", study, "-o", "whole.h5")
        self.program("sweep", study, "-o", "s.h5", "--slurm", "job.sh", "--jobs", 3)
        script = (self.folder / "job.sh").read_text()
        self.assertIn("#SBATCH --array=1-3\n", script)
        tasks = [
            subprocess.Popen(["bash", "job.sh"], cwd=self.folder, env={**os.environ, "SLURM_ARRAY_TASK_ID": str(k), "SLURM_ARRAY_TASK_COUNT": "3"}, stderr=subprocess.DEVNULL)
            for k in (1, 2, 3)
        ]
        self.assertEqual([task.wait() for task in tasks], [0, 0, 0])
        self.assertEqual(self.both("whole"), self.both("s"))

    def test_failed_points_are_marked_and_the_others_go_on(self):
        study = self.write(
            "s.yaml",
            f"sweep: 1\nscene: {JOINT}\nset: {{dynamics.duration: 20 ms}}\n"
            "vary: {controls.agonist.field: [30 kV/mm, 200 kV/mm, 10 kV/mm]}\noutputs: {angle: 'final(statics.joints.hinge.coordinate)'}\n",
        )
        done = self.program("sweep", study, code=3)
        self.assertIn("warning: point 1 (controls.agonist.field=200 kV/mm): loss_of_equilibrium: ", done.stderr)
        self.assertIn("3 of 3 points, of which 1 failed (status in the table): s.h5, s.csv", done.stderr)
        rows = self.table()
        self.assertEqual([row["status"] for row in rows], ["completed", "loss_of_equilibrium", "completed"])
        self.assertEqual(rows[1]["angle [rad]"], "nan")
        with h5py.File(self.folder / "s.h5") as table:
            self.assertEqual(table.attrs["failed_points"], 1)
            self.assertEqual(list(table["status"]), [0, 1, 0])

    def test_everything_wrong_is_said_before_anything_runs(self):
        study = self.write(
            "s.yaml",
            f"sweep: 1\nscene: {JOINT}\nvary:\n  controls.agonst.field: [1]\n  muscles.upper.section.diametr: [1]\n"
            "outputs: {a: 'joints.hinge.coordinate'}\n",
        )
        self.assertEqual(self.message("sweep", study, code=2), f"{study}:4:3: error: vary.controls.agonst.field: the scene has no control 'agonst' (did you mean 'agonist'?)")
        study.write_text(study.read_text().replace("agonst", "agonist"))
        self.assertEqual(
            self.message("sweep", study, code=2),
            f"{study}:5:3: error: vary.muscles.upper.section.diametr: with '1': muscles.upper.section.diametr: unknown key (did you mean 'diameter'?)",
        )
        study.write_text(study.read_text().replace("diametr", "diameter"))
        self.assertEqual(self.message("sweep", study, code=2), f"{study}:6:11: error: outputs.a: is a series: give a row such as [-1], or a reduction such as max(...)")
        self.assertEqual(self.message("sweep", study, "--shard", "3/2", code=2), "error: --shard: needs k/n with 1 <= k <= n, got '3/2'")

    def test_another_study_does_not_overwrite_a_table(self):
        self.program("sweep", self.study())
        message = self.message("sweep", self.study(n=3), code=2)
        self.assertEqual(message, "error: 's.h5' exists and is of no such sweep; give --force to overwrite it, or -o FILE")
        self.program("sweep", self.study(n=3), "--force")
        self.assertEqual(len(self.table()), 6)

    def test_optimise_can_be_swept(self):
        study = self.write(
            "s.yaml",
            f"sweep: 1\nscene: {SCENES / 'double_integrator_optimal.yaml'}\nverb: optimise\nvary: {{optimal_control.final.joints.slide.position: [1]}}\n"
            "outputs: {x: 'joints.slide.coordinate[-1]'}\n",
        )
        text = study.read_text()
        scene = (SCENES / "double_integrator_optimal.yaml").read_text()
        joint = re.search(r"final:.*?joints: \{(\w+):", scene, re.DOTALL).group(1)
        study.write_text(text.replace("final.joints.slide.position: [1]", f"final.joints.{joint}: [8, 10]").replace("joints.slide", f"joints.{joint}"))
        self.program("sweep", study)
        self.assertEqual([round(float(row["x"]), 6) for row in self.table()], [8.0, 10.0])


if __name__ == "__main__":
    unittest.main()
