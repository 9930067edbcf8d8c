#!/usr/bin/env python3
"""Runs the program on a scene that is read without fault and fails later: check_scene.py MULDI_SIM SCENE.yaml

The scene says in comments what must happen:
    # run: validate                     the verb and its options (default: validate)
    # set: path=value                   an override
    # code: 3                           the exit code (default: 2)
    # expect: 14:11: error: key: ...    a line of stderr, without the name and the folder of the file; in order
"""

import pathlib
import re
import subprocess
import sys
import tempfile


def comments(text, key):
    return re.findall(rf"^# {key}: (.*)$", text, re.MULTILINE)


def main():
    program, scene = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    text = scene.read_text(encoding="utf-8")
    verb, *options = (comments(text, "run") or ["validate"])[0].split()
    overrides = [word for override in comments(text, "set") for word in ("--set", override)]
    code = int((comments(text, "code") or ["2"])[0])
    with tempfile.TemporaryDirectory() as folder:
        command = [program, verb, scene, *options, *overrides]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=60, check=False)
        left = sorted(path.name for path in pathlib.Path(folder).iterdir())
    said = [line.removeprefix(f"{scene}:").replace(f"{scene.parent}/", "").strip() for line in done.stderr.splitlines()]
    expected = comments(text, "expect")
    if not expected:
        sys.exit("the scene expects nothing")
    if done.returncode != code or said != expected:
        sys.exit("\n".join([f"exit code {done.returncode}, expected {code}", "said:", *said, "expected:", *expected]))
    if code == 2 and left:
        sys.exit(f"a wrong scene left {left}")


if __name__ == "__main__":
    main()
