#!/usr/bin/env python3
"""Side files for ParaView with bodies and muscles: test_paraview.py MULDI_SIM. test_paraview_reads.py opens them in ParaView."""

import signal
import unittest

from program import SCENES, ProgramTest, options, values
from xdmf_check import check_side_file, points_of

LINE_FIELDS = {"stretch": "Cell", "force": "Cell", "length": "Cell", "field": "Cell", "true_field": "Cell"}


class SideFile(ProgramTest):
    def test_bodies_are_boxes_and_muscles_are_lines(self):
        output = self.run_scene("revolute_joint_lumped.yaml", "a.h5", *options(["dynamics.duration=20"]))
        bodies, muscles = check_side_file(self, self.folder / "a.xdmf")
        times = list(values(output, "time"))
        self.assertEqual(bodies, ("bodies", times, {"body": "Cell", "velocity": "Cell"}))
        self.assertEqual(muscles, ("muscles", times, LINE_FIELDS))
        bodies, muscles = check_side_file(self, self.folder / "a.statics.xdmf")
        self.assertEqual((bodies[2], len(muscles[1])), ({"body": "Cell"}, 7))

    def test_lines_end_where_the_muscles_do(self):
        output = self.run_scene("revolute_joint_lumped.yaml", "a.h5", *options(["dynamics.duration=200"]))
        ends = points_of(self.folder / "a.xdmf", "muscles")
        self.assertEqual((ends[0], ends[2]), ([-10, 15, 0], [-10, -15, 0]))
        for row, name in ((0, "upper"), (2, "lower")):
            length = sum((p - q) ** 2 for p, q in zip(ends[row], ends[row + 1])) ** 0.5
            # Seven digits of positions of some 40 mm.
            self.assertAlmostEqual(length, values(output, f"muscles/{name}/length")[-1], delta=1e-4)
        corners = points_of(self.folder / "a.xdmf", "bodies", row=0)
        self.assertEqual([min(c[i] for c in corners) for i in (0, 1)], [0, -15])
        self.assertEqual([max(c[i] for c in corners) for i in (0, 1)], [90, 15])

    def test_many_rows_are_thinned_out_to_the_last_one(self):
        self.run_scene("revolute_joint_lumped.yaml", "a.h5", *options(["dynamics.duration=1003"]))
        ((_, times, _), _) = check_side_file(self, self.folder / "a.xdmf")
        self.assertLessEqual(len(times), 250)
        self.assertEqual((times[0], times[1], times[-1]), (0, 5, 1003))

    def test_a_free_actuator_is_as_long_as_recorded(self):
        output = self.run_scene("pull_in.yaml", "a.h5")
        ((name, numbers, _),) = check_side_file(self, self.folder / "a.xdmf")
        # The curve turns back: its rows are numbered.
        self.assertEqual((name, numbers), ("muscles", list(range(57))))
        low, high = points_of(self.folder / "a.xdmf", "muscles")
        self.assertAlmostEqual(high[2] - low[2], values(output, "statics/muscles/actuator/length")[-1], delta=1e-5)

    def test_springs_have_lines_of_their_own(self):
        self.run_scene("slack_cable.yaml", "a.h5")
        found = {name: fields for name, _, fields in check_side_file(self, self.folder / "a.xdmf")}
        self.assertEqual(sorted(found), ["bodies", "springs"])
        self.assertIn("force", found["springs"])


class Verb(ProgramTest):
    def test_writes_the_side_file_of_a_killed_run(self):
        output = self.folder / "a.h5"
        process = self.start("run", SCENES / "revolute_joint_lumped.yaml", "-o", output, *options(["dynamics.duration=10000 s"]))
        with self.open_live(output, process) as file:

            def has_rows():
                file["time"].id.refresh()
                return file["time"].shape[0] > 300

            self.wait_for(has_rows, process, "rows come in")
            self.assertEqual(self.program("paraview", output).stdout, f"{self.folder}/a.xdmf\n{self.folder}/a.statics.xdmf\n")
            check_side_file(self, self.folder / "a.xdmf")
        process.send_signal(signal.SIGKILL)
        process.wait()
        (self.folder / "a.xdmf").unlink()
        self.program("paraview", output)
        check_side_file(self, self.folder / "a.xdmf")

    def test_refuses_what_holds_nothing_to_draw(self):
        self.run_scene("membrane_fe.yaml", "a.h5", *options(["dynamics.duration=0.02"]))
        self.assertEqual(
            self.message("paraview", "a.h5", code=2),
            "error: 'a.h5' holds nothing to draw: no bodies, muscles or springs, and no fields of solids (record.fields)",
        )


if __name__ == "__main__":
    unittest.main()
