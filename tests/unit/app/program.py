"""The built program as its users meet it: a process with arguments, exit code, output and result files."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py

PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
ROOT = pathlib.Path(__file__).resolve().parents[3]
SCENES = ROOT / "scenes"
TIME_LIMIT = 120  # s; a machine under load is slow, a process that hangs is longer


def data_sets(path):
    """Every data set of a file by its path, as (shape, type, bytes); checkpoints apart, which have two slots."""
    found = {}

    def visit(name, item):
        if isinstance(item, h5py.Dataset) and not name.startswith("checkpoint/"):
            found[name] = (item.shape, str(item.dtype), item[()].tobytes())

    with h5py.File(path, "r") as file:
        file.visititems(visit)
    return found


def attribute(path, name, item="/"):
    with h5py.File(path, "r") as file:
        return file[item].attrs[name]


def values(path, name):
    with h5py.File(path, "r") as file:
        return file[name][()]


def options(overrides):
    return [word for override in overrides for word in ("--set", override)]


class ProgramTest(unittest.TestCase):
    """Every test has a folder of its own, in which the program runs."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def program(self, *arguments, code=0, folder=None, **options):
        """Runs it to its end; the exit code must be `code`."""
        command = [str(PROGRAM), *map(str, arguments)]
        done = subprocess.run(command, cwd=folder or self.folder, capture_output=True, text=True, timeout=TIME_LIMIT, check=False, **options)
        self.assertEqual(done.returncode, code, f"{' '.join(command)}\n{done.stdout}{done.stderr}")
        return done

    def message(self, *arguments, code):
        """What the program says where it must fail, stdout being empty."""
        done = self.program(*arguments, code=code)
        self.assertEqual(done.stdout, "")
        return done.stderr.strip()

    def run_scene(self, scene, output, *arguments, verb="run", **options):
        """The verb's result in a file of the test's folder; returns its path."""
        path = SCENES / scene if isinstance(scene, str) else scene
        self.program(verb, path, "-o", output, *arguments, **options)
        return self.folder / output

    def start(self, *arguments):
        """Starts it and returns at once."""
        command = [str(PROGRAM), *map(str, arguments)]
        with open(self.folder / "started.txt", "a", encoding="utf-8") as log:
            process = subprocess.Popen(command, cwd=self.folder, stdout=log, stderr=log)
        self.addCleanup(self.stop, process)
        return process

    def said(self):
        """What started processes have printed."""
        return (self.folder / "started.txt").read_text(encoding="utf-8")

    def stop(self, process):
        if process.poll() is None:
            process.kill()
            process.wait()

    def wait_for(self, condition, process, what):
        """Waits until the condition holds or the process has ended."""
        end = time.monotonic() + TIME_LIMIT
        while not condition():
            if process.poll() is not None:
                return
            self.assertLess(time.monotonic(), end, f"waited in vain until {what}")
            time.sleep(0.0005)

    def open_live(self, output, process):
        """The file of a running process for SWMR readers, as soon as all its groups are made."""
        opened = []

        def opens():
            try:
                opened.append(h5py.File(output, "r", swmr=True))
            except OSError:
                return False
            return True

        self.wait_for(opens, process, f"{output} opens")
        # Ended while this process slept: the file is there all the same.
        self.assertTrue(opened or opens(), f"the process ended before its file could be opened\n{self.said()}")
        return opened[0]

    def interrupt(self, process, output, delay, number=signal.SIGINT):
        """Sends a signal `delay` seconds after the process has begun to write; returns the exit code."""
        before = os.stat(output).st_mtime_ns if output.exists() else 0
        self.wait_for(lambda: output.exists() and os.stat(output).st_mtime_ns != before, process, f"{output} is written")
        time.sleep(delay)
        if process.poll() is None:
            process.send_signal(number)
        return process.wait(timeout=TIME_LIMIT)

    def assert_same_bits(self, first, second):
        """All data sets agree: by the program with tolerance 0, and byte by byte."""
        self.program("compare", first, second, "--rtol", 0, "--atol", 0, "--only", "*", "--ignore", "checkpoint")
        left, right = data_sets(self.folder / first), data_sets(self.folder / second)
        self.assertEqual(sorted(left), sorted(right))
        for name, content in left.items():
            self.assertEqual(content, right[name], name)


class BrokenRuns(ProgramTest):
    def run_with_breaks(self, arguments, output, delays, number=signal.SIGINT):
        """Runs and resumes to the end, broken off after each of the delays; returns the exit codes."""
        codes = []
        for delay in [*delays, None]:
            resume = ["--resume", output.name] if output.exists() else ["-o", output.name]
            process = self.start("run", *arguments, *resume)
            codes.append(process.wait() if delay is None else self.interrupt(process, output, delay, number))
            if codes[-1] == 0:
                break
        self.assertEqual(codes[-1], 0, self.said())
        return codes
