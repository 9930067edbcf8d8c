#!/usr/bin/env python3
"""Reports in a headless browser: test_report_in_browser.py MULDI_SIM. Debian's chromium is needed (tools/test --all)."""

import json
import re
import subprocess
import unittest

import numpy
import PIL.Image

from program import ProgramTest, options

BROWSER = [
    "chromium",
    "--headless=new",
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--hide-scrollbars",
    "--window-size=1150,900",
    "--virtual-time-budget=6000",
    "--host-resolver-rules=MAP * ~NOTFOUND",  # no network
]
BACKGROUND = (0xF7, 0xF8, 0xFA)


def pixels(path):
    """(height, width, 3) colours of a picture."""
    return numpy.asarray(PIL.Image.open(path).convert("RGB")).astype(int)


class Browser(ProgramTest):
    def browse(self, page, *arguments):
        address = f"file://{self.folder}/{page}"
        done = subprocess.run([*BROWSER, f"--user-data-dir={self.folder}/profile", *arguments, address], capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual(done.returncode, 0, f"{done.stderr}\na browser is needed: apt-get install chromium")
        return done

    def look(self, page, name):
        """The page as the browser made it, and its picture."""
        errors = self.browse(page, f"--screenshot={self.folder}/{name}.png", "--enable-logging=stderr").stderr
        self.assertNotRegex(errors, r"CONSOLE.*(Error|error)")
        return pixels(self.folder / f"{name}.png")

    def body_of(self, page):
        return re.search(r"<body[^>]*>", self.browse(page, "--dump-dom").stdout).group()

    def test_a_trunk_is_drawn_and_moves(self):
        self.program("new", "trunk", "-o", "a.yaml")
        self.run_scene(self.folder / "a.yaml", "a.h5")
        self.program("report", "a.h5")
        self.assertEqual(self.body_of("a.html"), '<body data-view="ready" data-frames="201">')
        first, last = self.look("a.html#frame=0", "first"), self.look("a.html#frame=200", "last")
        # The view lies below the head of the page, its background around what is drawn.
        self.assertGreater((first == BACKGROUND).all(axis=2).sum(), 20_000)
        self.assertGreater((first != last).any(axis=2).sum(), 2_000)

    def test_a_solid_is_coloured_by_its_potential(self):
        self.program("new", "solid", "-o", "a.yaml")
        self.run_scene(self.folder / "a.yaml", "a.h5", *options(["dynamics.duration=1"]))
        self.program("report", "a.h5")
        self.assertIn('data-view="ready"', self.body_of("a.html"))
        r, g, b = numpy.moveaxis(self.look("a.html#frame=12", "a"), -1, 0)
        # The ends of viridis: the electrode and, in the shade, the ground.
        yellow = (r > 150) & (g > 140) & (b < 90)
        violet = (r > 15) & (r < 80) & (g < 30) & (b > 20) & (b < 110)
        self.assertGreater(yellow[250:].sum(), 1_000)
        self.assertGreater(violet[250:].sum(), 1_000)

    def test_statics_alone_have_a_view(self):
        self.program("new", "muscle", "-o", "a.yaml")
        text = (self.folder / "a.yaml").read_text()
        self.run_scene(self.write("b.yaml", text[: text.index("dynamics:")]), "b.h5")
        self.program("report", "b.h5")
        self.assertEqual(self.body_of("b.html"), '<body data-view="ready" data-frames="21">')
        views = json.loads(re.search(r'id="views">(.*?)</script>', (self.folder / "b.html").read_text()).group(1))
        self.assertEqual([view["name"] for view in views], ["equilibria"])


if __name__ == "__main__":
    unittest.main()
