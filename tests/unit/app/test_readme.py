#!/usr/bin/env python3
"""The commands of the README about scenes and results, as they stand there: test_readme.py MULDI_SIM."""

import re
import shlex
import unittest

from program import ROOT, SCENES, ProgramTest, options

README = (ROOT / "README.md").read_text(encoding="utf-8")


class Commands(ProgramTest):
    def test_what_looks_at_results(self):
        section = README[README.index("## Look at results") : README.index("## A scene")]
        commands = re.findall(r"^    tools/run (.*?)(?: +#.*)?$", section, re.MULTILINE)
        self.assertEqual([command.split()[0] for command in commands], ["report", "plot", "plot", "plot"])
        self.run_scene("elephant_trunk_lumped.yaml", "elephant_trunk_lumped.h5", *options(["dynamics.duration=200"]))
        self.assertIn("`elephant_trunk_lumped.xdmf`, which a run leaves beside its result", section)
        self.assertTrue((self.folder / "elephant_trunk_lumped.xdmf").exists())
        joint = SCENES / "revolute_joint_lumped.yaml"
        self.run_scene(joint, "before.h5", *options(["dynamics.duration=40"]))
        self.run_scene(joint, "after.h5", *options(["dynamics.duration=40", "muscles.upper.section.diameter=8"]))
        for step in (4, 2, 1):
            self.run_scene(joint, f"dt{step}.h5", *options(["dynamics.duration=40", f"dynamics.step={step}"]))
        for command in commands:
            self.program(*shlex.split(command))
        made = {path.name for path in self.folder.iterdir()}
        self.assertLessEqual({"trunk.html", "elephant_trunk_lumped.svg", "overlay.pdf", "dt4.svg"}, made)

    def test_what_begins_and_explains_scenes(self):
        (command,) = re.findall(r"`tools/run (new .*?)`", README)[:1]
        self.program(*shlex.split(command))
        self.program("validate", "my.yaml")
        (command, told) = re.search(r"^    tools/run (explain .*)\n((?:    .*\n)+)", README, re.MULTILINE).groups()
        self.assertEqual(self.program(*shlex.split(command)).stdout, re.sub(r"^    ", "", told, flags=re.MULTILINE))


if __name__ == "__main__":
    unittest.main()
