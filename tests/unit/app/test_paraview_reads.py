#!/usr/bin/env python3
"""Side files opened by ParaView's own reader: test_paraview_reads.py MULDI_SIM. Debian's python3-paraview is needed (tools/test --all)."""

import json
import subprocess
import unittest

import numpy

from program import ProgramTest, options, values

READ = """
import json, sys
from paraview import servermanager, simple
from vtkmodules.numpy_interface import dataset_adapter
reader = simple.XDMFReader(FileNames=[sys.argv[1]])
reader.UpdatePipeline()
times = list(reader.TimestepValues)
reader.UpdatePipeline(times[-1])
found = {}
def look(block, name):
    if block is None:
        return
    if hasattr(block, "GetNumberOfBlocks"):
        for i in range(block.GetNumberOfBlocks()):
            about = block.GetMetaData(i)
            look(block.GetBlock(i), about.Get(block.NAME()))
        return
    data = dataset_adapter.WrapDataObject(block)
    arrays = {key: data.PointData[key].tolist() for key in data.PointData.keys()} | {key: data.CellData[key].tolist() for key in data.CellData.keys()}
    found[name] = {"points": data.Points.tolist(), "cells": block.GetNumberOfCells(), "arrays": arrays}
look(servermanager.Fetch(reader), "only")
with open(sys.argv[2], "w") as out:
    json.dump({"times": times, "grids": found}, out)
"""


class ParaView(ProgramTest):
    def read(self, side):
        """Times and the grids at the last of them."""
        script = self.write("read.py", READ)
        command = ["/usr/bin/python3", str(script), str(self.folder / side), str(self.folder / "read.json")]
        done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual(done.returncode, 0, f"{done.stdout}{done.stderr}\nParaView is needed: apt-get install python3-paraview")
        self.assertNotIn("ERR|", done.stdout + done.stderr)
        return json.loads((self.folder / "read.json").read_text())

    def test_solids_with_their_fields(self):
        text = self.program("new", "solid").stdout
        text = text.replace("  block:\n", "  block: &block\n", 1).replace("\ndynamics:", "  other: {<<: *block, position: [4, 0, 0]}\n\ndynamics:", 1)
        text = text.replace("fields: {block:", "fields: {other: [position], block:")
        output = self.run_scene(self.write("a.yaml", text), "a.h5", *options(["dynamics.duration=1"]))
        found = self.read("a.xdmf")
        self.assertEqual(found["times"], list(values(output, "solids/block/times")))
        self.assertEqual(sorted(found["grids"]), ["block", "other"])
        for name, grid in found["grids"].items():
            self.assertEqual(grid["cells"], 64)
            position, reference = values(output, f"solids/{name}/position")[-1], values(output, f"solids/{name}/reference")
            numpy.testing.assert_array_equal(grid["points"], position)
            numpy.testing.assert_allclose(grid["arrays"]["displacement"], position - reference, rtol=0, atol=1e-15)
        for name in ("potential", "pressure", "stress"):
            numpy.testing.assert_array_equal(found["grids"]["block"]["arrays"][name], values(output, f"solids/block/{name}")[-1])

    def test_bodies_and_muscles(self):
        self.program("new", "trunk", "-o", "a.yaml")
        output = self.run_scene(self.folder / "a.yaml", "a.h5", *options(["dynamics.duration=300"]))
        found = self.read("a.xdmf")
        self.assertEqual((found["times"][0], found["times"][-1]), (0, 300))
        bodies, muscles = found["grids"]["bodies"], found["grids"]["muscles"]
        self.assertEqual((bodies["cells"], muscles["cells"]), (3, 6))
        stretch = [values(output, f"muscles/m{i}/stretch")[-1] for i in range(1, 7)]
        numpy.testing.assert_allclose(muscles["arrays"]["stretch"], stretch, rtol=1e-6)  # seven digits
        velocity = [values(output, f"bodies/{name}/velocity")[-1] for name in ("first", "second", "third")]
        numpy.testing.assert_allclose(bodies["arrays"]["velocity"], velocity, rtol=1e-6, atol=1e-12)


if __name__ == "__main__":
    unittest.main()
