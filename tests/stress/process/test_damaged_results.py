#!/usr/bin/env python3
"""Damaged result files: test_damaged_results.py MULDI_SIM [--files N] [--seed S]. Whatever reads them ends in time and within its
memory, with a code and a sentence, never by a signal."""

import pathlib
import random
import resource
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "unit" / "app"))
from program import PROGRAM, SCENES, ProgramTest, options


def option(name, default):
    if name not in sys.argv:
        return default
    place = sys.argv.index(name)
    sys.argv.pop(place)
    return int(sys.argv.pop(place))


FILES = option("--files", 40)
SEED = option("--seed", 1)
MEMORY = 4 << 30  # bytes of address space: libraries, Python and its modules take half of it
SECONDS = 20  # of processor time
SCENE = SCENES / "tree.yaml"
SHORT = options(["dynamics.duration=50 ms"])


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    resource.setrlimit(resource.RLIMIT_FSIZE, (100 << 20, 100 << 20))


def flipped(content, chosen):
    changed = bytearray(content)
    for _ in range(chosen.choice([1, 1, 2, 8, 64])):
        changed[chosen.randrange(len(changed))] ^= 1 << chosen.randrange(8)
    return bytes(changed)


def overwritten(content, chosen):
    """A run of bytes becomes zeros, ones, or something else: a lost block of the disk."""
    size = chosen.choice([1, 4, 8, 512, 4096])
    at = chosen.randrange(len(content))
    block = chosen.choice([bytes(size), b"\xff" * size, chosen.randbytes(size)])
    return (content[:at] + block + content[at + size :])[: len(content)]


def cut(content, chosen):
    return content[: chosen.randrange(len(content))]


def moved(content, chosen):
    at, size = chosen.randrange(len(content)), chosen.choice([1, 8, 100])
    return content[:at] + (b"" if chosen.random() < 0.5 else chosen.randbytes(size)) + content[at + size :]


# HDF5 keeps what it says about data at the start of this file: damage there is worth more than damage of numbers.
HEAD = 20_000


class Damaged(ProgramTest):
    def damaged_files(self, count, seed):
        self.program("run", SCENE, "-o", "whole.h5", "--force", *SHORT)
        content = (self.folder / "whole.h5").read_bytes()
        chosen = random.Random(seed)
        for number in range(count):
            damage = chosen.choice([flipped, flipped, overwritten, cut, moved])
            if chosen.random() < 0.5:
                changed = damage(content[:HEAD], chosen) + (content[HEAD:] if damage is not cut else b"")
            else:
                changed = damage(content, chosen)
            yield f"{number}: {damage.__name__}", changed

    def ends_well(self, name, content, *arguments):
        """Runs it on a fresh copy of the damaged file."""
        (self.folder / "damaged.h5").write_bytes(content)
        command = [str(PROGRAM), *map(str, arguments)]
        done = subprocess.run(command, cwd=self.folder, capture_output=True, timeout=120, check=False, preexec_fn=limit)
        said = done.stderr.decode("utf-8", "replace")
        ended = f"{name}: {' '.join(map(str, arguments))}: code {done.returncode}\n{said[-2000:]}"
        # Differences are 1, an input that is no result 2, a run that fails 3, a file that cannot be written or read 4.
        good = done.returncode in (0, 1, 2, 3, 4) and "Traceback" not in said
        good = good and (done.returncode == 0 or arguments[0] == "compare" or "error: " in said)
        if not good:
            kept = pathlib.Path(self.folder.parent, f"muldi_damaged_{SEED}_{name.split(':')[0]}.h5")
            kept.write_bytes(content)
            ended += f"\nkept: {kept}"
        self.assertTrue(good, ended)
        return done.returncode

    def check(self, count, seed, *verbs):
        codes = {}
        for name, content in self.damaged_files(count, seed):
            for verb, *arguments in verbs:
                with self.subTest(name=name, verb=verb):
                    code = self.ends_well(name, content, verb, *arguments)
                    codes.setdefault(verb, []).append(code)
        for verb, found in codes.items():
            print(f"{verb}: {len(found)} files, " + ", ".join(f"{found.count(code)} ended with {code}" for code in sorted(set(found))))
        return codes

    def test_are_read_or_refused(self):
        codes = self.check(FILES, SEED, ("info", "damaged.h5"), ("compare", "whole.h5", "damaged.h5"), ("compare", "damaged.h5", "whole.h5"),
                           ("run", SCENE, "--resume", "damaged.h5", "--set", "dynamics.duration=60 ms"))
        self.assertIn(2, codes["info"], "some damage was found")

    def test_are_drawn_or_refused(self):
        verbs = (("plot", "damaged.h5", "-o", "f.svg"), ("report", "damaged.h5", "-o", "f.html"), ("paraview", "damaged.h5"))
        self.check(FILES // 10, SEED + 1000, *verbs)
        # Two of these once kept HDF5 waiting for a check sum to come right.
        self.check(12, 1005, *verbs)


if __name__ == "__main__":
    unittest.main()
