#!/usr/bin/env python3
"""Figures and pages of sweeps and calibrations: test_look_at_studies.py MULDI_SIM."""

import re
import unittest

from program import SCENES, ProgramTest

JOINT = SCENES / "revolute_joint_lumped.yaml"


def texts(path):
    """The texts of a figure: matplotlib leaves each as a comment beside its outlines."""
    return re.findall(r"<!-- (.*?) -->", path.read_text(encoding="utf-8"))


class Sweeps(ProgramTest):
    def sweep(self, vary, design="grid", code=0, duration="10 ms"):
        text = f"sweep: 1\nscene: {JOINT}\nset: {{dynamics.duration: {duration}}}\ndesign: {design}\nvary:\n{vary}"
        study = self.write("s.yaml", text + "outputs:\n  angle: 'statics.joints.hinge.coordinate[-1]'\n  fastest: 'largest(joints.hinge.velocity)'\n")
        self.program("sweep", study, "--quiet", "--force", code=code)

    def figure(self):
        self.program("plot", "s.h5", "-o", "s.svg")
        return texts(self.folder / "s.svg")

    def test_one_key_makes_a_curve_with_units(self):
        self.sweep("  controls.agonist.field: {linspace: [0, 30 kV/mm, 4]}\n")
        found = self.figure()
        for text in ("angle", "angle (rad)", "fastest", "fastest (rad/ms)", "field (V/mm)"):
            self.assertIn(text, found)
        self.assertNotIn("failed", found)

    def test_two_keys_make_a_family(self):
        self.sweep("  controls.agonist.field: {linspace: [0, 30 kV/mm, 4]}\n  muscles.*.section.diameter: [10, 11 mm]\n")
        found = self.figure()
        for text in ("angle by diameter", "field (V/mm)", "10 mm", "11 mm"):
            self.assertIn(text, found)

    def test_words_are_told_by_their_names(self):
        self.sweep("  controls.agonist.field: [10 kV/mm, 20 kV/mm]\n  muscles.*.lumped.inertia: [consistent, thesis]\n")
        self.assertLessEqual({"angle by inertia", "consistent", "thesis"}, set(self.figure()))

    def test_many_values_of_two_keys_make_a_map_in_which_failures_are_grey(self):
        self.sweep("  controls.agonist.field: {linspace: [0, 60 kV/mm, 7]}\n  materials.silicone.viscous.viscosity: {logspace: [1, 50, 7]}\n", code=3)
        found = self.figure()
        self.assertLessEqual({"angle (rad)", "viscosity (MPa ms)", "field (V/mm)", "failed"}, set(found))
        # Two maps and their scales of colours.
        self.assertEqual((self.folder / "s.svg").read_text().count("<image"), 4)

    def test_designs_without_a_grid_make_points_over_every_key(self):
        self.sweep("  controls.agonist.field: {min: 0, max: 30 kV/mm}\n  muscles.*.section.diameter: {min: 9, max: 11}\n", design="lhs\nsamples: 8")
        found = self.figure()
        for text in ("angle over field", "angle over diameter", "fastest over field", "fastest over diameter"):
            self.assertIn(text, found)

    def test_a_failed_point_is_a_cross_on_the_axis(self):
        self.sweep("  controls.agonist.field: [10 kV/mm, 20 kV/mm, 200 kV/mm]\n", code=3)
        self.assertIn("failed", self.figure())

    def test_the_page_tells_points_keys_and_failures(self):
        self.sweep("  controls.agonist.field: [10 kV/mm, 20 kV/mm, 200 kV/mm]\n", code=3)
        self.program("report", "s.h5")
        page = (self.folder / "s.html").read_text(encoding="utf-8")
        for text in (
            "<h1>Sweep s.yaml</h1>",
            "1 of 3 points have no result.",
            "1 point: loss_of_equilibrium. Equilibrium was lost",
            "<code>continuation: arc_length</code>",
            "<td class=\"words\">controls.agonist.field</td>",
            "<th>angle (rad)</th>",
            "<td>loss of equilibrium</td>",
        ):
            self.assertIn(text, page)
        for title in ("Warnings", "Curves", "Keys", "Outputs", "Points"):
            self.assertIn(f"<h2>{title}</h2>", page)
        self.assertNotIn("http://", re.sub(r'xmlns(:\w+)?="[^"]*"|<!DOCTYPE[^>]*>|<metadata>.*?</metadata>', "", page, flags=re.DOTALL))

    def test_a_study_is_drawn_alone_and_whole(self):
        self.sweep("  controls.agonist.field: [10 kV/mm, 20 kV/mm]\n")
        self.run_scene("pendulum.yaml", "a.h5", "--set", "dynamics.duration=10")
        self.assertEqual(self.message("plot", "s.h5", "a.h5", code=2), "error: 's.h5' is of a sweep: give it alone")
        self.assertEqual(self.message("plot", "s.h5", "--what", "joints", code=2), "error: --what: a sweep has no joints: leave it out, everything is drawn")


class Calibrations(ProgramTest):
    def calibrate(self, fit):
        short = ["--set", "dynamics.duration=60 ms"]
        self.program("run", JOINT, "-o", "r.h5", "--set", "materials.silicone.electric.relative_permittivity=3.3", *short)
        study = self.write("f.yaml", f"calibrate: 1\nscene: {JOINT}\nreference: r.h5\nfit:\n{fit}compare:\n  statics.joints.hinge.coordinate:\n  joints.hinge.coordinate:\n")
        self.program("calibrate", study, "-o", "c.yaml", *short)

    def test_figure_and_page_show_curves_differences_and_intervals(self):
        self.calibrate("  materials.silicone.electric.relative_permittivity: {min: 2, max: 5}\n")
        self.program("plot", "f.h5", "-o", "f.svg")
        found = texts(self.folder / "f.svg")
        for text in ("joints.hinge.coordinate", "statics.joints.hinge.coordinate", "coordinate (rad)", "time (ms)", "load", "reference", "before", "after"):
            self.assertIn(text, found)
        for text in ("Difference from the reference", "difference (rad)", "Parameters with 95 % intervals", "start", "fitted", "2", "5"):
            self.assertIn(text, found)
        self.program("report", "f.h5")
        page = (self.folder / "f.html").read_text(encoding="utf-8")
        for text in ("<h1>Calibration f.yaml</h1>", "Converged after ", "<td>materials.silicone.electric.relative_permittivity</td><td>3.1</td><td>3.3</td>", "<th>rms after</th>"):
            self.assertIn(text, page)
        self.assertNotIn("<h2>Warnings</h2>", page)

    def test_what_the_data_do_not_tell_stands_on_the_page(self):
        self.calibrate("  materials.silicone.electric.relative_permittivity: {min: 2, max: 5}\n  muscles.lower.lumped.relative_permittivity: {min: 2, max: 5, start: 3.1}\n")
        self.program("plot", "f.h5", "-o", "f.svg")
        self.assertTrue(any("not determined" in text for text in texts(self.folder / "f.svg")))
        self.program("report", "f.h5")
        page = (self.folder / "f.html").read_text(encoding="utf-8")
        self.assertIn("<li>The data say nothing about muscles.lower.lumped.relative_permittivity: take it out of <code>fit</code>.</li>", page)
        self.assertIn("<td>not determined</td>", page)


if __name__ == "__main__":
    unittest.main()
