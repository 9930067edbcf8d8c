#!/usr/bin/env python3
"""The script of `sweep --slurm` as an array job of a real Slurm with one node: test_slurm.py MULDI_SIM.

The test starts munged, slurmctld and slurmd of its own, with all their files in its folder, and ends them. It needs root and Debian's packages
slurmctld, slurmd, slurm-client and munge; without them it is skipped with a sentence."""

import os
import pathlib
import shutil
import socket
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "unit" / "app"))
from program import SCENES, TIME_LIMIT, ProgramTest, data_sets

SBIN = "/usr/sbin:/sbin"
STUDY = """sweep: 1
scene: {scene}
set: {{dynamics.duration: {duration}}}
vary:
  controls.agonist.field: {{linspace: [0, 30 kV/mm, {n}]}}
  muscles.*.section.diameter: [10, 11 mm]
outputs:
  angle: "joints.hinge.coordinate[-1]"
  overshoot: "max(joints.hinge.coordinate)"
"""
CONFIGURATION = """ClusterName=one
SlurmctldHost=localhost(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
KillWait=1
SlurmctldPort={controller}
SlurmdPort={node}
NodeName=localhost NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def missing():
    """Why there can be no Slurm; empty where there can."""
    absent = [name for name in ("munged", "slurmctld", "slurmd", "sbatch") if not shutil.which(name, path=f"{os.environ['PATH']}:{SBIN}")]
    if absent:
        return f"no {', '.join(absent)}: as root: apt-get install slurmctld slurmd slurm-client munge"
    return "" if os.geteuid() == 0 else "slurmd needs root"


def free_port():
    with socket.socket() as made:
        made.bind(("127.0.0.1", 0))
        return made.getsockname()[1]


@unittest.skipIf(missing(), missing())
class Slurm(ProgramTest):
    def setUp(self):
        super().setUp()
        self.home = self.folder / "slurm"
        for name in ("state", "spool"):
            (self.home / name).mkdir(parents=True)
        key = self.home / "munge.key"
        key.write_bytes(os.urandom(256))
        key.chmod(0o400)
        configuration = CONFIGURATION.format(folder=self.home, controller=free_port(), node=free_port(), cpus=os.cpu_count())
        (self.home / "slurm.conf").write_text(configuration)
        self.environment = {**os.environ, "PATH": f"{os.environ['PATH']}:{SBIN}", "SLURM_CONF": str(self.home / "slurm.conf")}
        place = self.home / "munge"
        self.daemon("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={self.home}/munge.socket", f"--pid-file={place}.pid", f"--log-file={place}.log", f"--seed-file={place}.seed")
        self.until(lambda: (self.home / "munge.socket").exists(), "munged answers")
        self.daemon("slurmctld", "-D")
        self.daemon("slurmd", "-D", "-N", "localhost")
        self.until(lambda: "idle" in self.ask("sinfo", "--noheader"), "the node is idle")

    def daemon(self, *words):
        with open(self.home / f"{words[0]}.out", "w", encoding="utf-8") as log:
            process = subprocess.Popen(words, stdout=log, stderr=log, env=self.environment)
        self.addCleanup(self.end, process)

    def end(self, process):
        process.terminate()
        process.wait(timeout=TIME_LIMIT)

    def until(self, condition, what):
        end = time.monotonic() + TIME_LIMIT
        while not condition():
            said = "".join(path.read_text() for path in self.home.glob("*.out"))
            self.assertLess(time.monotonic(), end, f"waited in vain until {what}\n{said}")
            time.sleep(0.1)

    def ask(self, *words):
        return subprocess.run(words, env=self.environment, cwd=self.folder, capture_output=True, text=True, check=False).stdout

    def submit(self, script="job.sh"):
        """The number of the job."""
        done = subprocess.run(["sbatch", "--parsable", script], env=self.environment, cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.strip()

    def wait_for_jobs(self):
        self.until(lambda: not self.ask("squeue", "--noheader").strip(), "no job is left")

    def study(self, n, duration):
        return self.write("s.yaml", STUDY.format(scene=SCENES / "revolute_joint_lumped.yaml", n=n, duration=duration))

    def assert_table_of_the_whole(self):
        self.assertEqual((self.folder / "whole.csv").read_bytes(), (self.folder / "s.csv").read_bytes())
        self.assertEqual(data_sets(self.folder / "whole.h5"), data_sets(self.folder / "s.h5"))

    def test_an_array_of_shards_makes_the_table_of_the_whole(self):
        study = self.study(10, "100 ms")
        self.program("sweep", study, "-o", "whole.h5")
        self.program("sweep", study, "-o", "s.h5", "--slurm", "job.sh", "--jobs", 4)
        self.submit()
        self.wait_for_jobs()
        self.assertEqual(sorted(path.name for path in self.folder.glob("s.*.log")), [f"s.{k}.log" for k in (1, 2, 3, 4)])
        self.assert_table_of_the_whole()

    def test_cancelled_jobs_are_submitted_again_and_do_what_is_left(self):
        study = self.study(10, "10 s")
        self.program("sweep", study, "-o", "whole.h5", "--jobs", 2)
        self.program("sweep", study, "-o", "s.h5", "--slurm", "job.sh", "--jobs", 3)

        def finished():
            """Points in the journals of the shards, whose first lines are headings."""
            return sum(max(0, path.read_bytes().count(b"\n") - 1) for path in self.folder.glob("s.journal.*"))

        number = self.submit()
        self.until(lambda: finished() >= 3, "points are finished")
        self.ask("scancel", number)
        self.wait_for_jobs()
        done = finished()
        self.assertFalse((self.folder / "s.h5").exists(), "cancelled in time")
        self.assertLess(done, 20)
        self.submit()
        self.wait_for_jobs()
        self.assert_table_of_the_whole()


if __name__ == "__main__":
    unittest.main()
