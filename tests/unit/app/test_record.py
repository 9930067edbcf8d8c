#!/usr/bin/env python3
"""What a result file holds and what it does not: test_record.py MULDI_SIM."""

import os
import re
import shutil
import unittest

import h5py

from program import PROGRAM, ROOT, SCENES, ProgramTest, attribute, data_sets, options

ALL = sorted(path.stem for path in SCENES.glob("*.yaml"))
LONG = re.compile(r".*_fe|dea_.*|(boxed_)?cube.*|revolute_joint_twin")  # these get 20 steps
COARSER = {
    "surface_wave": "solids.layer.mesh.stack.section.box.cells=[12, 1]",
    "real_geometry": "solids.actuator.mesh.stack.section.cylinder.rings=2",
    **{f"boxed_cube_{model}": "solids.cube.mesh.box.cells=[4, 4, 4]" for model in ("I", "II", "III", "IV")},
}
SHORT = ["elephant_trunk_lumped.yaml", "four_bar.yaml", "membrane_lumped.yaml", "tree.yaml"]


class Attributes(ProgramTest):
    """Scene format, section 4."""

    def setUp(self):
        super().setUp()
        self.output = self.run_scene("revolute_joint_lumped.yaml", "a.h5", "--threads", 2)

    def test_say_what_made_the_file(self):
        said = self.program("--version").stdout.splitlines()
        with h5py.File(self.output, "r") as file:
            attributes = dict(file.attrs)
        self.assertEqual(f"muldi-sim {attributes['muldi_version']} ({attributes['git_hash']})", said[0])
        self.assertEqual(attributes["compiler"], f"{said[1]} {said[2]}")
        self.assertEqual(attributes["libraries"], ", ".join(said[3:]))
        self.assertEqual(attributes["format"], 1)
        self.assertEqual(attributes["title"], "Revolute joint with two antagonistic muscles")
        self.assertEqual(attributes["units"], "mm, g, ms, A")
        self.assertEqual(attributes["command_line"], f"{PROGRAM} run {SCENES / 'revolute_joint_lumped.yaml'} -o a.h5 --threads 2")
        self.assertEqual(attributes["threads"], 2)
        self.assertEqual((attributes["status"], attributes["status_time"], attributes["status_where"]), ("completed", 1000, ""))
        self.assertRegex(attributes["created"], r"^20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ$")

    def test_give_the_wall_time_of_every_phase(self):
        with h5py.File(self.output, "r") as file:
            phases = {name: value for name, value in file.attrs.items() if name.startswith("wall_time.")}
        self.assertEqual(sorted(phases), [f"wall_time.{name}" for name in ("build", "dynamics", "prepare", "read", "statics")])
        self.assertTrue(all(0 < seconds < 60 for seconds in phases.values()))


class ResolvedScene(ProgramTest):
    def test_of_every_shipped_scene_runs_to_the_same_bits(self):
        for mesh in SCENES.glob("*.msh"):
            shutil.copy(mesh, self.folder)
        for name in ALL:
            with self.subTest(name):
                arguments = ["--force", "--set", "title=with an override"]
                scene = SCENES / f"{name}.yaml"
                text = scene.read_text(encoding="utf-8")
                verb = "run" if re.search("^(statics|dynamics):", text, re.MULTILINE) else "optimise"
                if name in COARSER:
                    arguments += ["--set", COARSER[name]]
                step = re.search(r"^dynamics:[^}]*\bstep: ([\d.e+-]+) ms", text, re.MULTILINE)
                if step and LONG.fullmatch(name):
                    arguments += ["--set", f"dynamics.duration={20 * float(step[1])} ms"]
                first = self.run_scene(scene, "first.h5", *arguments, verb=verb)
                again = self.write("resolved.yaml", attribute(first, "scene"))
                second = self.run_scene(again, "second.h5", "--force", verb=verb)
                self.assert_same_bits(first, second)
                self.assertEqual(attribute(first, "scene"), attribute(second, "scene"))


class OnlyWhatTheSceneHolds(ProgramTest):
    ALWAYS = {"energy", "solver", "checkpoint"}

    def expect(self, scene, families):
        with h5py.File(self.run_scene(scene, "a.h5"), "r") as file:
            self.assertEqual(set(file), self.ALWAYS | families)
        (self.folder / "a.h5").unlink()

    def test_gives_no_group_of_another_family(self):
        self.expect("free_body.yaml", {"bodies", "points", "momentum", "time"})
        self.expect("pendulum.yaml", {"bodies", "joints", "points", "momentum", "time"})
        self.expect("membrane_lumped.yaml", {"muscles", "controls", "statics", "momentum", "time"})
        self.expect("revolute_joint_lumped.yaml", {"bodies", "joints", "muscles", "controls", "statics", "momentum", "time"})

    def test_statics_alone_have_no_time(self):
        with h5py.File(self.run_scene("pull_in.yaml", "a.h5"), "r") as file:
            self.assertEqual(set(file), {"checkpoint", "statics"})
            self.assertEqual(set(file["statics"]), {"controls", "energy", "load", "muscles", "solver", "stable"})

    def test_maps_no_library_that_lumped_scenes_do_not_need(self):
        output = self.folder / "a.h5"
        process = self.start("run", SCENES / "elephant_trunk_lumped.yaml", "-o", output, *options(["dynamics.duration=1000 s", "record.every=100"]))
        self.open_live(output, process).close()
        with open(f"/proc/{process.pid}/maps", encoding="utf-8") as file:
            maps = file.read()
        self.assertIn("muldi-sim", maps)
        for library in ("ipopt", "coin", "umfpack", "cholmod", "klu", "metis", "blas", "lapack", "mumps", "gfortran"):
            self.assertNotRegex(maps, rf"lib{library}")
        self.assertEqual(self.interrupt(process, output, 0), 130)

    def test_reads_no_unit_database(self):
        # A path that leads nowhere would be an error of the library if it were opened; the scene has unit strings.
        self.program("run", SCENES / "elephant_trunk_lumped.yaml", "--set", "dynamics.duration=0.01 s", env={**os.environ, "UDUNITS2_XML_PATH": "/none.xml"})
        traced = self.program("run", SCENES / "pendulum.yaml", env={**os.environ, "LD_DEBUG": "files"}).stderr
        loaded = set(re.findall(r"file=(\S+?)\.so", traced))
        self.assertIn("libfmt", loaded)
        self.assertEqual({name for name in loaded if re.match(r"lib(ipopt|umfpack|cholmod|klu|blas|lapack)", name)}, set())


class SameBits(ProgramTest):
    def test_for_1_and_2_threads(self):
        for name in SHORT:
            with self.subTest(name):
                self.run_scene(name, "one.h5", "--threads", 1)
                self.run_scene(name, "two.h5", "--threads", 2)
                self.assert_same_bits("one.h5", "two.h5")
                for output in ("one.h5", "two.h5"):
                    (self.folder / output).unlink()

    def test_run_after_run(self):
        for name in SHORT:
            first, second = (data_sets(self.run_scene(name, "a.h5", "--force")) for _ in range(2))
            self.assertEqual(first, second, name)

    def test_from_any_folder(self):
        self.run_scene("tree.yaml", "a.h5")
        self.program("run", "tree.yaml", "-o", self.folder / "b.h5", folder=SCENES)
        self.program("run", "scenes/tree.yaml", "-o", self.folder / "c.h5", folder=ROOT)
        self.assert_same_bits("a.h5", "b.h5")
        self.assert_same_bits("a.h5", "c.h5")


class FunctionsFromFiles(ProgramTest):
    TABLE = "t, push\n0, 0\n100, 20\n200, -10\n2000, 0\n"
    SCENE = """\
loads: {{drive: {{body: pendulum, at: tip, force: [0, 1, 0], control: push}}}}
controls: {{push: {{force: {}}}}}
"""

    def scene(self, function):
        return (SCENES / "pendulum.yaml").read_text() + self.SCENE.format(function)

    def test_are_found_from_the_folder_of_the_scene(self):
        self.write("case/tables/push.csv", self.TABLE)
        scene = self.write("case/a.yaml", self.scene("{file: tables/push.csv, column: 2, interpolation: linear}"))
        output = self.run_scene(scene, "file.h5")
        self.program("run", "a.yaml", "-o", "../inside.h5", folder=self.folder / "case")
        written = self.write("b.yaml", self.scene("{table: [[0, 0], [100, 20], [200, -10], [2000, 0]]}"))
        self.run_scene(written, "table.h5")
        self.assert_same_bits("file.h5", "inside.h5")
        self.assert_same_bits("file.h5", "table.h5")
        # The record holds the values: it can be run, and resumed, without the file.
        (self.folder / "case" / "tables" / "push.csv").unlink()
        self.run_scene(self.write("resolved.yaml", attribute(output, "scene")), "again.h5")
        self.assert_same_bits("file.h5", "again.h5")

    def test_a_missing_one_is_located(self):
        scene = self.write("a.yaml", self.scene("{file: none.csv, column: 2, interpolation: linear}"))
        line = len(self.scene("").splitlines())
        message = self.message("run", scene, code=2)
        self.assertRegex(message, rf"^{scene}:{line}:\d+: error: controls.push.force.file: cannot read '{self.folder}/none.csv': No such file or directory$")


if __name__ == "__main__":
    unittest.main()
