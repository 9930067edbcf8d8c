#!/usr/bin/env python3
"""Scenes as an editor sees them: test_schema.py MULDI_SIM. Every scene and every snippet of the pages is valid by the JSON Schema."""

import json
import re
import unittest

import jsonschema
import yaml

from program import ROOT, SCENES, ProgramTest

MODELINE = re.compile(r"# yaml-language-server: \$schema=(\S+)")


def scene_files():
    return [*sorted(SCENES.glob("*.yaml")), *sorted((ROOT / "tests" / "golden" / "si").glob("*.yaml"))]


def pages():
    """Every page of the repository."""
    return [path for path in sorted(ROOT.rglob("*.md")) if not path.relative_to(ROOT).parts[0].startswith("build")]


def study_files():
    return sorted((SCENES / "studies").glob("*.yaml"))


def is_study(text):
    return any(word in yaml.safe_load(text) for word in ("sweep", "calibrate"))


class Schema(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scenes = self.validator("schema")
        self.studies = self.validator("schema", "--study")

    def validator(self, *command):
        schema = json.loads(self.program(*command).stdout)
        jsonschema.Draft7Validator.check_schema(schema)
        return jsonschema.Draft7Validator(schema)

    def problems(self, text):
        """What an editor would underline in a scene or a study."""
        errors = (self.studies if is_study(text) else self.scenes).iter_errors(yaml.safe_load(text))
        return [f"{'.'.join(map(str, error.absolute_path))}: {error.message}" for error in errors]

    def test_every_scene_is_valid(self):
        self.assertGreater(len(scene_files()), 20)
        for path in scene_files():
            self.assertEqual(self.problems(path.read_text()), [], path.name)

    def test_every_scene_names_its_schema(self):
        for path in [*scene_files(), *study_files()]:
            named = MODELINE.match(path.read_text())
            self.assertTrue(named, path.name)
            schema = "study.schema.json" if is_study(path.read_text()) else "scene.schema.json"
            self.assertEqual((path.parent / named.group(1)).resolve(), ROOT / "schemas" / schema, path.name)

    def test_every_study_is_valid_and_mistakes_in_them_are_found(self):
        self.assertEqual(self.program("schema", "--study").stdout, (ROOT / "schemas" / "study.schema.json").read_text())
        self.assertGreaterEqual(len(study_files()), 8)
        for path in study_files():
            self.assertEqual(self.problems(path.read_text()), [], path.name)
        sweep = (SCENES / "studies" / "joint_sweep.yaml").read_text()
        fit = (SCENES / "studies" / "joint_fit.yaml").read_text()
        for text, right, wrong, problem in (
            (sweep, "design: grid", "design: gird", "design: 'gird' is not valid under any of the given schemas"),
            (sweep, "outputs:", "ouputs:", "'outputs' is a required property"),
            (fit, "max: 5", "mx: 5", "'max' is a required property"),
        ):
            self.assertIn(right, text)
            self.assertTrue(any(problem in found for found in self.problems(text.replace(right, wrong, 1))), problem)

    def test_every_snippet_of_the_pages_is_valid_and_runs_through_the_reader(self):
        found = [(page, text) for page in pages() for text in re.findall(r"```yaml\n(.*?)```", page.read_text(), re.DOTALL)]
        self.assertIn(ROOT / "README.md", [page for page, _ in found])
        for number, (page, text) in enumerate(found):
            with self.subTest(page=page.name, number=number):
                self.assertEqual(self.problems(text), [])
                if not is_study(text):
                    self.assertTrue(text.startswith("muldi: "), "a whole scene (parts of one are ```yml)")
                    self.program("validate", self.write(f"snippet{number}.yaml", text))

    def test_every_part_of_a_scene_in_the_pages_is_valid(self):
        """```yml marks entries of a scene: checked without what a whole one needs beside them."""
        for page in pages():
            for text in re.findall(r"```yml\n(.*?)```", page.read_text(), re.DOTALL):
                self.assertEqual(self.problems("muldi: 1\n" + text), [], page.name)

    def test_starter_scenes_are_valid(self):
        for kind in ("joint", "muscle", "trunk", "solid", "optimal"):
            self.assertEqual(self.problems(self.program("new", kind).stdout), [], kind)

    def test_mistakes_are_found(self):
        text = (SCENES / "revolute_joint_lumped.yaml").read_text()
        for right, wrong, problem in (
            ("mass: 40 g", "maas: 40 g", "bodies.pendulum: Additional properties are not allowed ('maas' was unexpected)"),
            ("type: revolute, from", "from", "joints.hinge: 'type' is a required property"),
            ("poisson: 0.5", "poisson: 0.7", "materials.silicone.elastic.poisson: 0.7 is greater than the maximum of 0.5"),
        ):
            self.assertIn(right, text)
            self.assertIn(problem, self.problems(text.replace(right, wrong)))


if __name__ == "__main__":
    unittest.main()
