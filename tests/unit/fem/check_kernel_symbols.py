#!/usr/bin/env python3
"""Code for one instruction set must not be shared: check_kernel_symbols.py OBJECTS Standard library only.

A function that several objects hold is kept once by the linker, perhaps the one that an old processor cannot run. Hence every
function with a name that others could have must be made for lanes of one set (`Lanes<lanes, set>` in its name), and no code may run
before main.
"""

import pathlib
import subprocess
import sys


def problems(path):
    listing = subprocess.run(["nm", "--defined-only", "--demangle", path], check=True, capture_output=True, text=True).stdout
    for line in listing.splitlines():
        _address, kind, name = line.split(maxsplit=2)
        # The address sanitizer registers its globals by functions of these names.
        if kind in "WTt" and "Lanes<" not in name and not name.startswith("_sub_"):
            yield f"{path}: code that is not of one instruction set: {name}"


# CMake hands lists over with semicolons.
objects = [name for name in ";".join(sys.argv[1:]).split(";") if pathlib.Path(name).name.startswith("kernels_v")]
found = [problem for name in objects for problem in problems(name)]
print("\n".join(found) if found else f"{len(objects)} objects share no code")
sys.exit(1 if found or len(objects) != 3 else 0)
