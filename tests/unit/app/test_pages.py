#!/usr/bin/env python3
"""The pages about theory and about adding components name what exists: test_pages.py."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
CASE = re.compile(r"^(?:TYPED_)?TEST(?:_[PF])?\((\w+),\s*(\w+)\)", re.MULTILINE)


def pages():
    return [path for path in sorted(ROOT.rglob("*.md")) if not path.relative_to(ROOT).parts[0].startswith("build")]


def test_cases():
    return {f"{suite}.{name}" for path in (ROOT / "tests").rglob("*.cpp") for suite, name in CASE.findall(path.read_text())}


class Theory(unittest.TestCase):
    text = (ROOT / "lib" / "THEORY.md").read_text()

    def sections(self):
        return re.split(r"^## ", self.text, flags=re.MULTILINE)[1:]

    def test_every_section_names_files_and_tests(self):
        numbered = [section for section in self.sections() if section[0].isdigit()]
        self.assertEqual(len(numbered), 16)
        for section in numbered:
            self.assertRegex(section, r"\nFiles: `lib/", section[:40])
            self.assertRegex(section, r"\nTests: `\w+\.\w+`", section[:40])

    def test_the_tests_exist(self):
        named = {name for part in re.findall(r"^Tests: ((?:.+\n)+)", self.text, re.MULTILINE) for name in re.findall(r"`(\w+\.\w+)`", part)}
        self.assertGreater(len(named), 60)
        self.assertEqual(sorted(named - test_cases()), [])


class Names(unittest.TestCase):
    def test_files_that_pages_name_exist(self):
        """`lib/...`, `tests/...`, `tools/...`, `scenes/...` in backticks; links too."""
        checked = 0
        for page in pages():
            text = page.read_text()
            named = re.findall(r"`((?:lib|app|tests|tools|scenes|schemas)/[\w./-]*\w)`", text)
            named = [(ROOT / name, name) for name in named]
            links = re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", text)
            named += [(page.parent / name, name) for name in links]
            for path, name in named:
                checked += 1
                self.assertTrue(path.exists(), f"{page.relative_to(ROOT)} names {name}")
        self.assertGreater(checked, 150)


class HowToAdd(unittest.TestCase):
    def test_blocks_are_the_files_that_are_compiled(self):
        text = (ROOT / "lib" / "HOW_TO_ADD.md").read_text()
        blocks = re.findall(r"`(tests/unit/examples/\w+\.hpp)`:\n\n```cpp\n(.*?)```", text, re.DOTALL)
        self.assertEqual(len(blocks), 4)
        for name, block in blocks:
            self.assertEqual(block, (ROOT / name).read_text(), name)
        compiled = (ROOT / "tests" / "unit" / "examples" / "test_examples.cpp").read_text()
        for name, _ in blocks:
            self.assertIn(f'#include "{pathlib.Path(name).name}"', compiled)


if __name__ == "__main__":
    unittest.main()
