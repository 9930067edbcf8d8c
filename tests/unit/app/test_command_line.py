#!/usr/bin/env python3
"""Verbs, options, exit codes and streams: test_command_line.py MULDI_SIM."""

import json
import subprocess
import unittest

import h5py

from program import PROGRAM, ROOT, SCENES, TIME_LIMIT, ProgramTest, attribute, values

PENDULUM = SCENES / "pendulum.yaml"


class Usage(ProgramTest):
    """Wrong words: exit code 2, one line with what is wrong and where help is."""

    def expect(self, arguments, sentence):
        self.assertEqual(self.message(*arguments, code=2), "error: " + sentence)

    def test_no_verb(self):
        self.expect([], "give a verb: run, optimise, check, validate, compare, info, schema, plot, report, paraview, new, explain, sweep, calibrate; see 'muldi-sim --help'")

    def test_misspelt_verb(self):
        self.expect(["valdate", "x.yaml"], "no verb 'valdate' (did you mean 'validate'?); see 'muldi-sim --help'")

    def test_misspelt_option(self):
        self.expect(["run", PENDULUM, "--treads", 2], "unexpected '--treads' (did you mean '--threads'?); see 'muldi-sim run --help'")

    def test_missing_scene(self):
        self.expect(["run"], "scene is required; see 'muldi-sim run --help'")

    def test_one_argument_too_many(self):
        self.expect(["info", "a.h5", "b.h5"], "unexpected 'b.h5'; see 'muldi-sim info --help'")

    def test_threads_out_of_range(self):
        self.expect(["run", PENDULUM, "--threads", 0], "--threads: Value 0 not in range 1 to 1024; see 'muldi-sim run --help'")

    def test_tolerance_that_is_no_number(self):
        self.expect(["compare", "a.h5", "b.h5", "--rtol", "x"], "Could not convert: --rtol = x; see 'muldi-sim compare --help'")

    def test_set_without_value(self):
        self.expect(["run", PENDULUM, "--set"], "--set: 1 required PATH=VALUE missing; see 'muldi-sim run --help'")

    def test_resume_writes_into_the_resumed_file_only(self):
        self.expect(["run", PENDULUM, "--resume", "a.h5", "-o", "b.h5"], "--output excludes --resume; see 'muldi-sim run --help'")
        self.expect(["run", PENDULUM, "--resume", "a.h5", "--force"], "--force excludes --resume; see 'muldi-sim run --help'")


class Scenes(ProgramTest):
    def test_missing_scene_file(self):
        for verb in ("run", "validate"):
            self.assertEqual(self.message(verb, "none.yaml", code=2), "none.yaml: error: cannot read: No such file or directory")

    def test_nothing_to_run(self):
        self.write("a.yaml", "muldi: 1\n")
        self.assertEqual(self.message("run", "a.yaml", code=2), "a.yaml: error: nothing to run: give `statics:` or `dynamics:`")
        self.program("validate", "a.yaml")

    def test_overrides_change_the_scene(self):
        output = self.run_scene("pendulum.yaml", "a.h5", "--set", "dynamics.duration=10 ms", "--set", "title=short")
        self.assertEqual(list(values(output, "time")), [0, 5, 10])
        self.assertEqual(attribute(output, "title"), "short")

    def test_overrides_may_stand_before_the_scene(self):
        self.program("run", "--set", "dynamics.duration=10", "--set", "title=x", PENDULUM)
        self.assertEqual(attribute(self.folder / "pendulum.h5", "title"), "x")

    def test_errors_in_overrides_are_located_there(self):
        message = self.message("run", PENDULUM, "--set", "bodies.pendulum.mas=3", "--set", "dynamics.step=0", code=2)
        self.assertEqual(
            message,
            "--set bodies.pendulum.mas=3: error: bodies.pendulum.mas: unknown key (did you mean 'mass'?)\n"
            "--set dynamics.step=0: error: dynamics.step: must be > 0, got '0'",
        )


class Validate(ProgramTest):
    def test_several_scenes_print_a_summary_each_on_stdout(self):
        done = self.program("validate", PENDULUM, SCENES / "four_bar.yaml")
        self.assertEqual(done.stderr, "")
        self.assertEqual(
            done.stdout,
            f"{PENDULUM}: Pendulum released from the horizontal\n"
            "  bodies 1, joints 1, muscles 0 (lumped), isolated actuators 0, springs 0, loads 0, joint forces 0\n"
            "  chain 1: anchored, 0 cut joint(s): pendulum\n"
            "  degrees of freedom 1: 1 minimal velocities less 0 loop constraints; 12 redundant coordinates\n"
            "  assembled: gravity yes, damping no, electric no, finite elements no\n"
            "  linear solver tree\n"
            "  statics no, dynamics 400 steps\n"
            "  estimated memory 0.0 MiB, results 0.2 MiB\n"
            f"{SCENES / 'four_bar.yaml'}: Four-bar linkage, closed and redundant\n"
            "  bodies 3, joints 4, muscles 0 (lumped), isolated actuators 0, springs 0, loads 0, joint forces 0\n"
            "  chain 1: anchored, 1 cut joint(s): crank coupler rocker\n"
            "  cut joint: D\n"
            "  redundant loop constraints left out: 3\n"
            "  degrees of freedom 1: 3 minimal velocities less 2 loop constraints; 36 redundant coordinates\n"
            "  assembled: gravity no, damping no, electric no, finite elements no\n"
            "  linear solver dense\n"
            "  statics no, dynamics 1000 steps\n"
            "  estimated memory 0.0 MiB, results 0.5 MiB\n",
        )

    def test_all_scenes_are_checked_though_one_is_wrong(self):
        wrong = self.write("wrong.yaml", "muldi: 1\nbodie: {}\n")
        done = self.program("validate", PENDULUM, wrong, SCENES / "tree.yaml", code=2)
        self.assertEqual(done.stderr, f"{wrong}:2:1: error: bodie: unknown key (did you mean 'bodies'?)\n")
        self.assertIn("pendulum.yaml: Pendulum", done.stdout)
        self.assertIn("tree.yaml: Free tree", done.stdout)

    def test_writes_no_file(self):
        self.program("validate", PENDULUM)
        self.assertEqual(list(self.folder.iterdir()), [])


class Streams(ProgramTest):
    def test_run_prints_on_stderr_only(self):
        done = self.program("run", PENDULUM)
        self.assertEqual((done.stdout, done.stderr), ("", "completed: pendulum.h5\n"))

    def test_quiet_leaves_warnings_and_errors(self):
        done = self.program("run", PENDULUM, "--quiet")
        self.assertEqual((done.stdout, done.stderr), ("", ""))
        refused = self.program("--quiet", "run", PENDULUM, code=2)
        self.assertEqual(refused.stderr, "error: 'pendulum.h5' exists (--force overwrites it, --output names another file)\n")

    def test_verbose_tells_what_is_built_and_where_time_goes(self):
        lines = self.program("run", PENDULUM, "-v").stderr.splitlines()
        self.assertEqual(lines[0], "Pendulum released from the horizontal")
        self.assertEqual(lines[-2], "completed: pendulum.h5")
        self.assertRegex(lines[-1], r"^wall time: read \S+ s, build \S+ s, prepare \S+ s, dynamics \S+ s$")

    def test_very_verbose_tells_the_resolved_scene(self):
        text = self.program("run", PENDULUM, "-vv").stderr
        self.assertIn(attribute(self.folder / "pendulum.h5", "scene").strip(), text)

    def test_schema_is_the_shipped_one(self):
        done = self.program("schema")
        self.assertEqual(done.stderr, "")
        self.assertEqual(done.stdout, (ROOT / "schemas" / "scene.schema.json").read_text())
        self.assertEqual(json.loads(done.stdout)["$schema"], "http://json-schema.org/draft-07/schema#")

    def test_version_names_the_libraries(self):
        done = self.program("--version")
        self.assertEqual(done.stderr, "")
        for name in ("muldi-sim", "GNU" if "GNU" in done.stdout else "Clang", "CLI11", "Eigen", "HDF5", "yaml-cpp", "muParser", "spdlog", "fmt"):
            self.assertRegex(done.stdout, rf"(?m)^{name} \d")

    def test_help_goes_to_stdout(self):
        for verb in ("run", "optimise", "check", "validate", "compare", "info", "schema"):
            done = self.program(verb, "--help")
            self.assertEqual(done.stderr, "")
            self.assertIn(f"muldi-sim {verb}", done.stdout)

    def test_a_full_disk_behind_stdout_is_an_error(self):
        with open("/dev/full", "w", encoding="ascii") as full:
            done = subprocess.run([PROGRAM, "schema"], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (4, "error: cannot write the output\n"))


class CompareAndInfo(ProgramTest):
    def test_equal_files_agree(self):
        output = self.run_scene("pendulum.yaml", "a.h5")
        done = self.program("compare", output, output)
        self.assertEqual((done.stdout, done.stderr), (f"'{output}' and '{output}' agree: 22 data sets, 20050 values\n", ""))

    def test_a_difference_is_exit_code_1_and_a_table(self):
        self.run_scene("pendulum.yaml", "a.h5")
        self.run_scene("pendulum.yaml", "b.h5", "--set", "bodies.pendulum.mass=41")
        done = self.program("compare", "a.h5", "b.h5", code=1)
        self.assertEqual(done.stderr, "")
        self.assertRegex(done.stdout.splitlines()[0], r"^'a.h5' and 'b.h5' differ: \d+ in 22 data sets, the worst first$")
        self.assertEqual(done.stdout.splitlines()[1].split(), ["data", "set", "index", "time", "first", "second", "|a-b|/tolerance"])
        self.program("compare", "a.h5", "b.h5", "--only", "time", "--only", "controls/*")
        self.program("compare", "--only", "time", "a.h5", "b.h5")
        self.program("compare", "--ignore", "*", "a.h5", "b.h5")

    def test_info_of_a_finished_run(self):
        self.run_scene("pendulum.yaml", "a.h5")
        done = self.program("info", "a.h5")
        self.assertEqual(done.stderr, "")
        lines = [line.split() for line in done.stdout.splitlines()]
        self.assertIn(["status", "completed", "at", "2000", "ms"], lines)
        self.assertIn("/time 401 rows from 0 to 2000 ms".split(), lines)
        self.assertIn("final values".split(), lines)


class UnreadableRecords(ProgramTest):
    """Every verb that reads records refuses what is none: exit code 2 with a sentence, the file untouched."""

    def refused(self, content, sentence):
        good = self.run_scene("pendulum.yaml", "good.h5", "--no-paraview")
        bad = self.folder / "bad.h5"
        if content is not None:
            bad.write_bytes(content if isinstance(content, bytes) else content(good))
        said = f"cannot read 'bad.h5': {sentence}"
        for verb in (["info", "bad.h5"], ["compare", "bad.h5", "good.h5"], ["compare", "good.h5", "bad.h5"], ["run", PENDULUM, "--resume", "bad.h5"]):
            self.assertEqual(self.message(*verb, code=2), "error: " + said)
        place = f"--set initial.from={bad}: error: initial.from: "
        for verb in ("run", "validate"):
            message = self.message(verb, PENDULUM, "--set", f"initial.from={bad}", code=2)
            self.assertEqual(message, place + said.replace("bad.h5", str(bad)))
        if isinstance(content, bytes):
            self.assertEqual(bad.read_bytes(), content)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["bad.h5"] * (content is not None) + ["good.h5"])

    def test_missing(self):
        self.refused(None, "No such file or directory")

    def test_empty(self):
        self.refused(b"", "it is empty: no result, or its run was killed before its start was recorded")

    def test_noise(self):
        self.refused(bytes(range(256)) * 16, "not an HDF5 file")

    def test_text(self):
        self.refused(b"muldi: 1\n", "not an HDF5 file")

    def test_truncated(self):
        size = self.run_scene("pendulum.yaml", "good.h5", "--no-paraview").stat().st_size
        (self.folder / "good.h5").unlink()
        self.refused(lambda good: good.read_bytes()[:2000], f"truncated, it has 2000 of {size} bytes")

    def test_any_damaged_byte_range_is_no_crash(self):
        good = self.run_scene("pendulum.yaml", "good.h5", "--no-paraview")
        whole = good.read_bytes()
        step = len(whole) // 40
        for begin in range(48, len(whole), step):
            damaged = bytearray(whole)
            damaged[begin : begin + 400] = b"\xa5" * len(damaged[begin : begin + 400])
            (self.folder / "bad.h5").write_bytes(damaged)
            for verb in (["info", "bad.h5"], ["compare", "good.h5", "bad.h5"], ["run", PENDULUM, "--resume", "bad.h5"]):
                done = subprocess.run([PROGRAM, *verb], cwd=self.folder, capture_output=True, text=True, timeout=TIME_LIMIT, check=False)
                self.assertIn(done.returncode, (0, 1, 2), f"{verb} with bytes from {begin} on damaged: {done.stderr}")

    def test_a_foreign_file_can_be_looked_at_but_not_resumed(self):
        with h5py.File(self.folder / "foreign.h5", "w") as file:
            file["a/b"] = [1.0, 2.0]
        self.program("info", "foreign.h5")
        self.program("compare", "foreign.h5", "foreign.h5")
        self.assertEqual(self.message("run", PENDULUM, "--resume", "foreign.h5", code=2), "error: 'foreign.h5' cannot be resumed: it is no record of a run")
        place = f"initial.from={self.folder}/foreign.h5"
        self.assertEqual(
            self.message("run", PENDULUM, "--set", place, code=2),
            f"--set {place}: error: initial.from: the record holds no state of a motion to start from",
        )


if __name__ == "__main__":
    unittest.main()
