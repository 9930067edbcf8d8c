#!/usr/bin/env python3
"""The commands of the pages, as they stand there and in their order: test_commands.py MULDI_SIM.

A command is an indented line that begins with `tools/run` or `muldi-sim`; indented lines below it are what it says, `...` standing for
any lines. They run in an empty folder beside links to scenes/ and schemas/, with the built program in the place of tools/run, which
would install and build."""

import json
import re
import shlex
import subprocess
import unittest

from program import PROGRAM, ROOT, TIME_LIMIT, ProgramTest

# What is run elsewhere: by CI itself, by a test of its own.
ELSEWHERE = (r"git clone ", r"tools/test\b", r"tools/(bench|golden|results|gallery|layout|fuzz)\b", r"muldi-sim run .*revolute_joint_twin.yaml -o fe.h5")
# Pages with commands in lines of their own, and the number of those that are run here; of RESULTS.md tools/results runs all.
PAGES = {"README.md": 15, "scenes/README.md": 2, "lib/HOW_TO_ADD.md": 2, "scenes/SWEEPS.md": 4, "scenes/CALIBRATION.md": 7, "tests/fuzz/README.md": 0}
RUN_BY_TOOLS = {"scenes/RESULTS.md"}
COMMAND = re.compile(r"    (tools/\w+ |muldi-sim |git clone )")


def commands_of(text):
    """(command, what it says) in order; comments behind commands are left out."""
    found, said = [], None
    text = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    for line in re.sub(r" *\\\n +", " ", text).splitlines():
        if COMMAND.match(line):
            said = []
            found.append((re.sub(r" +#.*", "", line.strip()), said))
        elif line.startswith("    ") and said is not None:
            said.append(line[4:])
        elif not line.startswith("    "):
            said = None
    return found


def words_of(command):
    """The arguments of the program, as tools/run gives them."""
    program, *words = shlex.split(command)
    if program == "tools/run" and words[0].endswith((".yaml", ".yml")):
        return ["run", *words]
    return words


class Commands(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "scenes").symlink_to(ROOT / "scenes")
        (self.folder / "schemas").mkdir()

    def execute(self, command):
        """(exit code, everything that it said); `> FILE` is obeyed."""
        command, _, target = command.partition(" > ")
        done = subprocess.run([PROGRAM, *words_of(command)], cwd=self.folder, capture_output=True, text=True, timeout=TIME_LIMIT, check=False)
        if target:
            (self.folder / target.strip()).write_text(done.stdout)
        return done.returncode, done.stdout + done.stderr

    def assert_said(self, said, expected, command):
        """Every expected line in order; without `...` between them, one after the other."""
        lines = said.splitlines()
        at, free = 0, True
        for line in expected:
            if line == "...":
                free = True
                continue
            where = next((i for i in range(at, len(lines)) if lines[i].rstrip() == line), None)
            self.assertIsNotNone(where, f"{command}: said no '{line}':\n{said}")
            self.assertTrue(free or where == at, f"{command}: more stands above '{line}':\n{said}")
            at, free = where + 1, expected[0] == "..."

    def run_page(self, page):
        ran, number = 0, PAGES[page]
        for command, expected in commands_of((ROOT / page).read_text(encoding="utf-8")):
            if any(re.match(pattern, command) for pattern in ELSEWHERE):
                continue
            ran += 1
            with self.subTest(page=page, command=command):
                code, said = self.execute(command)
                self.assertEqual(code, 2 if any("error: " in line for line in expected) else 0, f"{command}\n{said}")
                if expected:
                    self.assert_said(said, expected, command)
        self.assertGreaterEqual(ran, number, f"{page} shows fewer commands than it did")

    def test_of_the_readme(self):
        self.run_page("README.md")
        made = {path.name for path in self.folder.iterdir()}
        self.assertLessEqual(
            {"trunk.html", "elephant_trunk_lumped.svg", "elephant_trunk_lumped.xdmf", "trunk.png", "overlay.pdf", "dt4.svg", "my.yaml", "my.h5"}, made
        )

    def test_of_the_gallery_and_the_layout_of_results(self):
        self.run_page("scenes/README.md")
        programs = re.findall(r"```python\n(.*?)```", (ROOT / "schemas" / "RESULTS_LAYOUT.md").read_text(), re.DOTALL)
        self.assertEqual(len(programs), 1)
        said = subprocess.run(["/usr/bin/python3", "-c", programs[0]], cwd=self.folder, capture_output=True, text=True, check=True)
        self.assertTrue(said.stdout.startswith("completed 10000.0 "), said.stdout)

    def test_of_how_to_add_write_what_is_committed(self):
        self.run_page("lib/HOW_TO_ADD.md")
        for name in ("scene.schema.json", "SCENE.md"):
            self.assertEqual((self.folder / "schemas" / name).read_text(), (ROOT / "schemas" / name).read_text())

    def test_of_the_pages_about_studies(self):
        self.run_page("scenes/SWEEPS.md")
        self.run_page("scenes/CALIBRATION.md")
        made = {path.name for path in self.folder.iterdir()}
        self.assertLessEqual({"joint_sweep.csv", "joint_sweep.svg", "trunk_lhs.html", "joint_fit.svg", "joint_fit.html", "troels.yaml"}, made)

    def test_no_page_is_left_out(self):
        pages = [path for folder in ("scenes", "lib", "schemas", "tests", "app", "tools") for path in (ROOT / folder).rglob("*.md")]
        with_commands = {str(path.relative_to(ROOT)) for path in [ROOT / "README.md", *pages] if commands_of(path.read_text(encoding="utf-8"))}
        self.assertEqual(with_commands, set(PAGES) | RUN_BY_TOOLS)


class Verbs(ProgramTest):
    def test_of_the_table_are_those_of_the_program(self):
        """Every verb of `muldi-sim --help` has a row in the README, and every row is a verb."""
        helped = self.program("--help").stdout
        verbs = set(re.findall(r"^  (\w+)[ ,]", helped[helped.index("ubcommands:") :], re.MULTILINE))
        self.assertGreater(len(verbs), 8)
        table = re.findall(r"^\| `tools/run (\S+)", (ROOT / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
        named = {"run" if word.endswith(".yaml") else word for word in table}
        self.assertEqual(named, verbs)

    def test_named_in_the_texts_of_pages_exist(self):
        helped = self.program("--help").stdout
        for page in ("README.md", "scenes/README.md", "scenes/SWEEPS.md", "scenes/CALIBRATION.md", "lib/THEORY.md", "lib/HOW_TO_ADD.md", "schemas/SCENE.md", "schemas/RESULTS_LAYOUT.md"):
            for verb in re.findall(r"`(?:muldi-sim|tools/run) ([a-z]+)\b[^`]*`", (ROOT / page).read_text(encoding="utf-8")):
                self.assertRegex(helped, rf"(?m)^  {verb}\b", page)


class Editors(unittest.TestCase):
    def test_find_the_schema_where_the_readme_says(self):
        self.assertIn("`schemas/scene.schema.json`", (ROOT / "README.md").read_text(encoding="utf-8"))
        json.loads((ROOT / "schemas" / "scene.schema.json").read_text())


if __name__ == "__main__":
    unittest.main()
