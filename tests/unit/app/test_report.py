#!/usr/bin/env python3
"""The verb report: test_report.py MULDI_SIM. The page as text; test_report_in_browser.py looks at it in a browser."""

import base64
import html.parser
import json
import re
import unittest

import h5py
import numpy

from program import SCENES, ProgramTest, options

BLOCK = """\
muldi: 1
title: "Block <b> & more"
materials: {m: {density: 1e-3, elastic: {model: neo_hookean, mu: 0.2, poisson: 0.5}, electric: {model: ideal_dielectric, relative_permittivity: 3}}}
controls: {supply: {potential: 20 kV}}
solids:
  block:
    mesh: {box: {size: [2, 2, 2], cells: [2, 2, 3], centre: [0, 0, 0]}}
    material: m
    conditions:
      - {where: x-, displacement: [0, ~, ~]}
      - {where: y-, displacement: [~, 0, ~], potential: 0}
      - {where: z-, displacement: [~, ~, 0]}
      - {where: y+, potential: {control: supply}}
dynamics: {duration: 0.1, step: 0.01}
record: {fields: {block: [position, potential, pressure, stress]}}
"""


class Page(html.parser.HTMLParser):
    """The texts of a page by their nearest named part, and all addresses in it."""

    VOID = {"meta", "input", "br", "link", "img"}

    def __init__(self, text):
        super().__init__()
        self.open, self.text, self.addresses, self.ids, self.elements = [], {}, [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        self.elements.append(tag)
        self.addresses += [attrs[name] for name in ("src", "href", "xlink:href", "data") if name in attrs]
        if "id" in attrs:
            self.ids.append(attrs["id"])
        if tag not in self.VOID:
            self.open.append((tag, attrs.get("id")))

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in self.VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open and self.open[-1][0] == tag, f"</{tag}> closes {self.open[-3:]}"
        self.open.pop()

    def handle_data(self, data):
        name = next((name for _, name in reversed(self.open) if name), "")
        self.text[name] = self.text.get(name, "") + data


def floats(text):
    return numpy.frombuffer(base64.b64decode(text), "<f4")


def quantised(field):
    coded = numpy.frombuffer(base64.b64decode(field["values"]), "<u2")
    return field["low"] + coded / 65535 * (field["high"] - field["low"])


class Report(ProgramTest):
    def page(self, output):
        """The parsed page of a result; it is whole and asks for nothing outside."""
        self.program("report", output, "-o", "a.html")
        text = (self.folder / "a.html").read_text(encoding="utf-8")
        page = Page(text)
        self.assertEqual(page.open, [])
        self.assertEqual([address for address in page.addresses if not address.startswith("#")], [])
        self.assertNotIn("@import", text)
        self.assertEqual(sorted({name for name in page.ids if page.ids.count(name) > 1}), [])
        self.assertLess(len(text), 4_000_000)
        page.source = text
        return page

    def test_shows_status_curves_ledger_solver_and_scene_and_moves_as_recorded(self):
        output = self.run_scene("revolute_joint_lumped.yaml", "a.h5", *options(["dynamics.duration=600"]))
        page = self.page(output)
        self.assertIn("Revolute joint with two antagonistic muscles", page.source)
        self.assertIn('<span class="badge ">completed</span>', page.source)
        self.assertIn("joint coordinates", page.text["curves"].lower() + page.source.lower())
        self.assertGreaterEqual(page.elements.count("svg"), 10)
        for word in ("dissipated", "balance", "energy (mJ)"):
            self.assertIn(word, page.text["energy"])
        with h5py.File(output) as file:
            self.assertIn(f"{file['energy/total'][-1]:.6g}", page.text["energy"])
            self.assertIn(str(file["solver/iterations"][()].sum()), page.text["solver"])
            self.assertIn("constraint violation", page.text["solver"])
        self.assertIn("relative_permittivity: 3.1", page.source)
        self.check_view(output, page)

    def check_view(self, output, page):
        motion, equilibria = json.loads(page.text["views"])
        self.assertEqual((motion["name"], equilibria["name"], motion["unit"]), ("motion", "equilibria", "ms"))
        self.assertEqual(len(motion["frames"]), 240)
        self.assertEqual((motion["frames"][0], motion["frames"][-1]), (0, 600))
        (body,) = motion["bodies"]
        position, turn = floats(body["position"]).reshape(-1, 3), floats(body["quaternion"]).reshape(-1, 4)
        with h5py.File(output) as file:
            numpy.testing.assert_allclose(position[-1], file["bodies/pendulum/position"][-1], rtol=1e-6)
            angle = file["joints/hinge/coordinate"][-1, 0]
            stretch = file["muscles/upper/stretch"][()]
        self.assertAlmostEqual(abs(turn[-1, 2]), numpy.sin(abs(angle) / 2), places=6)
        self.assertEqual([line["folder"] for line in motion["lines"]], ["muscles/upper", "muscles/lower"])
        upper = motion["lines"][0]
        self.assertEqual(upper["ends"], [{"body": -1, "at": [-10, 15, 0]}, {"body": 0, "at": [44, 15, 0]}])
        self.assertAlmostEqual(upper["radius"], 5.5)
        self.assertAlmostEqual(floats(upper["fields"]["stretch"]["values"])[-1], stretch[-1], places=6)
        # The box holds all points of the body.
        self.assertEqual((body["centre"][:2], body["half"][:2]), ([-1, 0], [45, 15]))

    def test_surfaces_carry_their_fields(self):
        output = self.run_scene(self.write("a.yaml", BLOCK + "statics: {control: supply, from: 0, to: 20 kV, steps: 2}\n"), "a.h5")
        page = self.page(output)
        self.assertIn("Block &lt;b&gt; &amp; more", page.source)
        motion, view = json.loads(page.text["views"])
        self.assertEqual((motion["name"], view["axis"], view["unit"]), ("motion", "control supply", "V"))
        self.assertEqual(len(motion["surfaces"]), 1)
        (surface,) = view["surfaces"]
        # 2 x 2 x 3 cells have 2 (4 + 6 + 6) outer faces; of 36 nodes 2 are inside.
        faces = numpy.frombuffer(base64.b64decode(surface["faces"]), "<u4").reshape(-1, 4)
        self.assertEqual((len(faces), surface["nodes"], faces.max()), (32, 34, 33))
        self.assertEqual(list(surface["fields"]), ["displacement", "largest stretch", "potential", "pressure", "stress (Mises)"])
        frames = len(surface["frames"])
        position = quantised(surface["position"]).reshape(frames, -1, 3)
        with h5py.File(output) as file:
            recorded = file["statics/solids/block/position"][-1]
            self.assertEqual(surface["frames"], list(file["statics/solids/block/load"]))
            potential = file["statics/solids/block/potential"][-1]
        step = surface["position"]["high"] - surface["position"]["low"]
        distance = numpy.abs(position[-1][:, None] - recorded[None]).max(axis=2).min(axis=1)
        self.assertLess(distance.max(), step / 65535)
        self.assertEqual((surface["fields"]["potential"]["low"], surface["fields"]["potential"]["high"]), (0, potential.max()))
        # A block pressed along y keeps its volume: the largest stretch is that of the other two directions, 1 / sqrt(height).
        height = (recorded[:, 1].max() - recorded[:, 1].min()) / 2
        stretch = quantised(surface["fields"]["largest stretch"]).reshape(frames, -1)[-1]
        numpy.testing.assert_allclose(stretch, 1 / numpy.sqrt(height), rtol=1e-5)  # 16 bits
        # Outer faces look outwards: the volume that they enclose is positive and that of the block.
        a, b, c, d = (position[-1][faces[:, i]] for i in range(4))
        volume = sum(numpy.einsum("ij,ij->", p, numpy.cross(q, r)) for p, q, r in ((a, b, c), (a, c, d))) / 6
        self.assertAlmostEqual(volume, 8, places=2)

    def test_large_surfaces_are_cut_down(self):
        fine = ["solids.block.mesh.box.cells=[10, 10, 10]", "dynamics.step=0.001"]
        page = self.page(self.run_scene(self.write("a.yaml", BLOCK), "a.h5", *options(fine)))
        (view,) = json.loads(page.text["views"])
        surface = view["surfaces"][0]
        self.assertEqual(surface["nodes"], 602)
        self.assertLess(len(surface["frames"]) * 602 * 8, 1_500_000)
        self.assertEqual((surface["frames"][0], surface["frames"][-1]), (0, 0.1))

    def test_tells_what_went_wrong(self):
        self.run_scene("pull_in.yaml", "a.h5")
        page = self.page("a.h5")
        self.assertRegex(page.text["warnings"], r"23 of 57 equilibria are unstable, from 57949\.1 V/mm on the path\.")
        self.program("run", SCENES / "pull_in.yaml", "-o", "b.h5", "--set", "statics.continuation=natural", code=3)
        page = self.page("b.h5")
        self.assertIn('<span class="badge stopped">loss_of_equilibrium</span>', page.source)
        self.assertIn("Equilibrium was lost: beyond this load there is no equilibrium near", page.source)

    def test_the_drawing_is_left_out_where_the_scene_cannot_be_read_again(self):
        output = self.run_scene("pendulum.yaml", "a.h5", *options(["dynamics.duration=10"]))
        with h5py.File(output, "r+") as file:
            file.attrs["scene"] = "muldi: 1\nbodies: {arm: {mass: -1}}\n"
        done = self.program("report", output, "-o", "a.html")
        self.assertIn("bodies and muscles are not drawn, the scene in 'a.h5' cannot be read again", done.stderr.replace(str(self.folder) + "/", ""))
        self.assertNotIn("views", Page((self.folder / "a.html").read_text()).text)

    def test_refuses_an_ending_that_is_no_page(self):
        self.run_scene("pendulum.yaml", "a.h5", *options(["dynamics.duration=10"]))
        self.assertEqual(self.message("report", "a.h5", "-o", "a.pdf", code=2), "error: -o: 'a.pdf' must end in .html, .htm")
        self.assertTrue(re.match(r"error: ", self.message("report", code=2)))


if __name__ == "__main__":
    unittest.main()
