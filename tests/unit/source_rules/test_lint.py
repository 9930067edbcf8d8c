#!/usr/bin/env python3
"""The text rules of tools/lint find each kind of offence, and nothing else."""

import importlib.machinery
import importlib.util
import pathlib
import unittest

PATH = pathlib.Path(__file__).resolve().parents[3] / "tools" / "lint"
LOADER = importlib.machinery.SourceFileLoader("lint", str(PATH))
lint = importlib.util.module_from_spec(importlib.util.spec_from_loader("lint", LOADER))
LOADER.exec_module(lint)


class SourceRules(unittest.TestCase):
    def test_accepts_a_clean_header(self):
        self.assertEqual(lint.check_text("lib/math/a.hpp", b"#pragma once\n/// The work/energy ratio.\n"), [])

    def test_finds_characters_beyond_ascii(self):
        self.assertEqual(lint.check_text("lib/math/a.cpp", "// \u03c6\n".encode()), ["lib/math/a.cpp:1: sources are ASCII only"])

    def test_leaves_scenes_their_alphabet_and_bad_scenes_their_tabs(self):
        self.assertEqual(lint.check_text("scenes/a.yaml", "# \u00b5m\n".encode()), [])
        self.assertEqual(lint.check_text("tests/bad_scenes/tab.yaml", b"a:\tb \n"), [])

    def test_finds_white_space_and_a_missing_end(self):
        self.assertEqual(lint.check_text("lib/math/a.cpp", b"int a; \n\tint b;"),
                         ["lib/math/a.cpp:2: the last line has no end", "lib/math/a.cpp:1: white space at the end of the line",
                          "lib/math/a.cpp:2: a tab"])

    def test_finds_unfinished_work(self):
        for words in ("TO" "DO", "FIX" "ME", "not yet imple" "mented", "place" "holder", "St" "ub"):
            self.assertEqual(lint.check_text("app/main.cpp", f"// {words}: x\n".encode()), [f"app/main.cpp:1: '{words}' is unfinished: finish it"])

    def test_finds_paths_of_one_machine(self):
        path = "/ho" "me/a"
        self.assertEqual(lint.check_text("tests/a.cpp", f'"{path}/b"\n'.encode()), [f"tests/a.cpp:1: '{path}' is a path of one machine"])

    def test_finds_tests_that_are_off(self):
        off = "DISAB" "LED_Swings"
        self.assertEqual(lint.check_text("tests/unit/a.cpp", f"TEST(Pendulum, {off}) {{\n".encode()),
                         ["tests/unit/a.cpp:1: 'DISAB" "LED_S' switches a test off or asserts nothing"])

    def test_finds_long_files_and_headers_without_pragma(self):
        self.assertEqual(lint.check_text("lib/math/a.cpp", b"\n" * 400), [])
        self.assertEqual(lint.check_text("lib/math/a.cpp", b"\n" * 401), ["lib/math/a.cpp: 401 lines; at most 400"])
        self.assertEqual(lint.check_text("lib/math/a.hpp", b"int a;\n"), ["lib/math/a.hpp: a header without #pragma once"])

    def test_finds_names_that_say_nothing(self):
        sentence = "the name says nothing about the content (utils, helpers, common, manager, data)"
        for name in ("lib/math/utils.hpp", "lib/common/a.hpp", "app/step_manager.cpp", "tests/data/a.hpp"):
            self.assertEqual(lint.check_name(name), [f"{name}: {sentence}"])
        self.assertEqual(lint.check_name("lib/math/metadata.hpp"), [])
        self.assertEqual(lint.check_name("lib/math/RigidBody.hpp"), ["lib/math/RigidBody.hpp: file names are snake_case"])


if __name__ == "__main__":
    unittest.main()
