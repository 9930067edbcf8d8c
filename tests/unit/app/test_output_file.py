#!/usr/bin/env python3
"""Where results go and what happens when they cannot: test_output_file.py MULDI_SIM."""

import os
import resource
import subprocess
import unittest

from program import PROGRAM, SCENES, ProgramTest, attribute, data_sets, values

PENDULUM = SCENES / "pendulum.yaml"
TRUNK = SCENES / "elephant_trunk_lumped.yaml"
SHORT = ["--set", "dynamics.duration=50 ms"]


class Names(ProgramTest):
    def test_the_default_is_the_stem_of_the_scene_in_the_current_folder(self):
        self.program("run", PENDULUM, "--no-paraview")
        self.assertEqual([path.name for path in self.folder.iterdir()], ["pendulum.h5"])
        self.program("run", PENDULUM, "--force")
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["pendulum.h5", "pendulum.xdmf"])

    def test_output_names_another_file(self):
        (self.folder / "sub").mkdir()
        self.program("run", PENDULUM, "--output", "sub/other.h5")
        self.assertEqual(attribute(self.folder / "sub" / "other.h5", "status"), "completed")
        self.assertFalse((self.folder / "pendulum.h5").exists())


class ExistingOutput(ProgramTest):
    REFUSAL = "error: 'pendulum.h5' exists (--force overwrites it, --output names another file)"

    def test_is_refused_and_untouched(self):
        file = self.write("pendulum.h5", "the user's own")
        self.assertEqual(self.message("run", PENDULUM, code=2), self.REFUSAL)
        self.assertEqual(file.read_text(), "the user's own")

    def test_is_overwritten_with_force(self):
        self.write("pendulum.h5", "the user's own")
        self.program("run", PENDULUM, "--force")
        self.program("run", PENDULUM, "--force", "--set", "dynamics.duration=10")
        self.assertEqual(list(values(self.folder / "pendulum.h5", "time")), [0, 5, 10])

    def test_is_left_alone_by_a_wrong_scene_even_with_force(self):
        file = self.write("pendulum.h5", "the user's own")
        self.program("run", PENDULUM, "--force", "--set", "dynamics.step=0", code=2)
        self.program("run", SCENES / "four_bar.yaml", "-o", "pendulum.h5", "--force", "--set", "solver.linear=tree", code=2)
        self.program("run", PENDULUM, "--force", "--set", "initial.bodies={pendulum: {velocity: [1, 0, 0]}}", code=2)
        self.assertEqual(file.read_text(), "the user's own")

    def test_in_use_by_another_run_is_refused(self):
        output = self.folder / "pendulum.h5"
        process = self.start("run", PENDULUM, "--set", "dynamics.duration=100000 s")
        self.wait_for(output.exists, process, "the first run writes")
        self.wait_for(lambda: output.stat().st_size > 4096, process, "the first run writes")
        for option in (["--force"], ["--resume", "pendulum.h5"]):
            message = self.message("run", PENDULUM, "--set", "dynamics.duration=100000 s", *option[:-1], option[-1], code=2)
            self.assertEqual(message, "error: 'pendulum.h5' is in use by another process")
        self.assertEqual(self.interrupt(process, output, 0), 130)


class Unwritable(ProgramTest):
    """The environment fails: exit code 4 with a sentence, nothing left behind."""

    def test_missing_folder(self):
        self.assertEqual(self.message("run", PENDULUM, "-o", "none/a.h5", code=4), "error: cannot write 'none/a.h5': No such file or directory")

    def test_read_only_folder(self):
        """As a user whom permissions bind: they do not bind root."""
        self.program("run", PENDULUM, "-o", "here.h5", "--no-paraview", *SHORT)
        closed = self.folder / "closed"
        closed.mkdir()
        self.folder.chmod(0o755)
        closed.chmod(0o555)
        self.addCleanup(closed.chmod, 0o755)
        user = {}
        if os.geteuid() == 0:
            user = {"user": 65534, "group": 65534, "extra_groups": []}
            if self.cannot_become(user):
                self.skipTest("root may not become another user here")
        for verb, output, scene in (
            ("run", "a.h5", PENDULUM),
            ("optimise", "a.h5", SCENES / "double_integrator_optimal.yaml"),
            ("sweep", "a.h5", SCENES / "studies" / "joint_sweep.yaml"),
            ("calibrate", "a.yaml", SCENES / "studies" / "kofod_permittivity.yaml"),
            ("plot", "a.svg", "here.h5"),
            ("report", "a.html", "here.h5"),
            ("new", "a.yaml", "joint"),
        ):
            with self.subTest(verb=verb):
                path = f"closed/{output}"
                extra = ["--results", "closed/a.h5"] if verb == "calibrate" else []
                done = self.program(verb, scene, "-o", path, *extra, code=4, **user)
                self.assertRegex(done.stderr, r"^error: cannot write 'closed/a\.(h5|yaml|svg|html|journal)': Permission denied\n$")
                self.assertEqual(os.listdir(closed), [])

    def cannot_become(self, user):
        """Whether root may not take another user's place, or that user may not reach the program and the scenes."""
        try:
            reach = subprocess.run([PROGRAM, "validate", PENDULUM], cwd=self.folder, capture_output=True, check=False, **user)
        except (PermissionError, subprocess.SubprocessError):
            return True
        return reach.returncode != 0

    def test_file_for_a_folder(self):
        self.write("file", "")
        self.assertEqual(self.message("run", PENDULUM, "-o", "file/a.h5", code=4), "error: cannot write 'file/a.h5': Not a directory")

    def test_folder_that_takes_no_files(self):
        # /proc takes none from root either.
        self.assertEqual(self.message("run", PENDULUM, "-o", "/proc/a.h5", code=4), "error: cannot write '/proc/a.h5': No such file or directory")

    def test_folder_and_device_for_a_file(self):
        for path in (self.folder, "/dev/full"):
            for option in ([], ["--force"]):
                message = self.message("run", PENDULUM, "-o", path, *option, code=4)
                self.assertEqual(message, f"error: cannot write '{path}': not a regular file")

    def test_pipes_and_devices_are_never_written(self):
        for name in ("a.h5", "a.svg", "a.html", "a.yaml", "a.sh", "a.xdmf"):
            os.mkfifo(self.folder / name)
        self.program("run", PENDULUM, "-o", "b.h5", "--no-paraview", *SHORT)
        fit = SCENES / "studies" / "kofod_permittivity.yaml"
        sweep = SCENES / "studies" / "joint_sweep.yaml"
        for path, *arguments in (("a.svg", "plot", "b.h5", "-o"), ("a.html", "report", "b.h5", "-o"), ("a.yaml", "new", "--force", "-o"),
                                 ("a.yaml", "calibrate", fit, "--force", "-o"), ("a.h5", "calibrate", fit, "--force", "--results"),
                                 ("a.h5", "sweep", sweep, "--force", "-o"), ("a.sh", "sweep", sweep, "--jobs", 2, "--force", "--slurm"),
                                 ("a.h5", "run", PENDULUM, "--force", "-o"), ("/dev/full", "new", "--force", "-o")):
            with self.subTest(path=path, verb=arguments[0]):
                self.assertEqual(self.message(*arguments, path, code=4), f"error: cannot write '{path}': not a regular file")
        self.program("run", PENDULUM, "-o", "c.h5", *SHORT)
        os.rename(self.folder / "a.xdmf", self.folder / "c.xdmf.pipe")
        (self.folder / "c.xdmf").unlink()
        os.rename(self.folder / "c.xdmf.pipe", self.folder / "c.xdmf")
        self.assertEqual(self.message("paraview", "c.h5", code=4), "error: cannot write 'c.xdmf': not a regular file")

    def test_pipes_and_devices_are_no_results(self):
        os.mkfifo(self.folder / "a.h5")
        for path in ("a.h5", "/dev/zero"):
            for arguments in (["info", path], ["compare", path, path], ["plot", path], ["report", path], ["paraview", path], ["run", PENDULUM, "--resume", path]):
                with self.subTest(path=path, verb=arguments[0]):
                    self.assertEqual(self.message(*arguments, code=2), f"error: cannot read '{path}': not a regular file")


class FullDisk(ProgramTest):
    """A limit of the file size stands for the full disk."""

    def run_within(self, size, **options):
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

        return self.program("run", TRUNK, "-o", "a.h5", code=4, preexec_fn=limit, **options)

    @unittest.skipIf("MULDI_COUNTS" in os.environ, "the counts of lines are written within the same limit, and said so")
    def test_without_room_for_the_start_nothing_is_left(self):
        done = self.run_within(50_000)
        self.assertRegex(done.stderr, r"^error: cannot write 'a.h5': File too large\n$")
        self.assertEqual(os.listdir(self.folder), [])

    def test_what_was_written_before_stays_valid_and_can_be_resumed(self):
        self.program("run", TRUNK, "-o", "whole.h5")
        whole = data_sets(self.folder / "whole.h5")
        for size in (1_600_000, 2_000_000, 2_500_000):
            with self.subTest(size=size):
                done = self.run_within(size)
                self.assertRegex(done.stderr, r"^error: cannot write 'a.h5'.*: File too large\n$")
                output = self.folder / "a.h5"
                self.assertEqual(attribute(output, "status"), "write_error")
                cut = data_sets(output)
                self.assertEqual(sorted(cut), sorted(whole))
                for name, (_, _, content) in cut.items():
                    self.assertTrue(whole[name][2].startswith(content), name)
                self.program("info", "a.h5")
                self.program("run", TRUNK, "--resume", "a.h5")
                self.assert_same_bits("whole.h5", "a.h5")
                output.unlink()

    def test_of_a_real_small_disk_leaves_what_fits(self):
        disk = self.folder / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16m", "tmpfs", disk], capture_output=True, check=False)
        if mounted.returncode != 0:
            self.skipTest("only root may mount a file system")
        self.addCleanup(lambda: subprocess.run(["umount", disk], check=True))
        run = ["run", TRUNK, "--set", "dynamics.duration=4 s"]
        self.program(*run, "-o", "whole.h5")
        whole = data_sets(self.folder / "whole.h5")
        filler, output = disk / "filler", disk / "a.h5"
        filler.write_bytes(bytes((16 << 20) - (self.folder / "whole.h5").stat().st_size * 7 // 10))
        done = self.program(*run, "-o", output, code=4)
        self.assertRegex(done.stderr, r"^error: cannot write '.*a.h5'.*: No space left on device\n$")
        self.assertIn(attribute(output, "status"), ("write_error", "running"))
        cut = data_sets(output)
        self.assertLess(cut["time"][0][0], whole["time"][0][0])
        for name, (_, _, content) in cut.items():
            self.assertTrue(whole[name][2].startswith(content), name)
        filler.unlink()
        self.program(*run, "--resume", output)
        self.assert_same_bits("whole.h5", output)


if __name__ == "__main__":
    unittest.main()
