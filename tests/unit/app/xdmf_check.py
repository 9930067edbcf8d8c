"""Side files for ParaView as text: every item has the size that it states, and everything it refers to exists."""

import math
import xml.etree.ElementTree

import h5py

WIDTH = {"Scalar": (), "Vector": (3,), "Matrix": (6,)}
CORNERS = {"Hexahedron": 8, "Polyline": 2}


def shape_of(item):
    return tuple(map(int, item.get("Dimensions").split()))


def meant(item, root):
    """The item that a reference points to, any other itself."""
    if item.get("Reference") != "XML":
        return item
    begin = "/Xdmf/"
    return root.find("./" + item.text[len(begin) :]) if item.text.startswith(begin) else None


def check_item(test, item, shape):
    """A DataItem of this shape: numbers in place, a data set, rows of one, or a formula of two of these."""
    test.assertEqual(shape_of(item), shape)
    kind = item.get("ItemType", "Uniform")
    if kind == "Function":
        test.assertEqual(item.get("Function"), "$0 - $1")
        parts = item.findall("DataItem")
        test.assertEqual(len(parts), 2)
        for part in parts:
            check_item(test, part, shape)
    elif kind == "HyperSlab":
        selection, data = item.findall("DataItem")
        start, stride, count = [list(map(int, selection.text.split()))[i :: 1][: len(shape) + 1] for i in (0, len(shape) + 1, 2 * len(shape) + 2)]
        test.assertEqual((start[1:], stride, count), ([0] * len(shape), [1] * (len(shape) + 1), [1, *shape]))
        check_data(test, data, start[0])
    elif item.get("Format") == "HDF":
        check_data(test, item)
    else:
        numbers = list(map(float, item.text.split()))
        test.assertEqual(len(numbers), math.prod(shape))
        test.assertTrue(all(map(math.isfinite, numbers)))


def check_data(test, item, row=None):
    file, path = item.text.split(":")
    with h5py.File(test.folder / file, "r") as opened:
        data = opened[path]
        test.assertEqual(data.shape, shape_of(item))
        test.assertEqual((data.dtype.kind, data.dtype.itemsize), ({"Int": "i", "Float": "f"}[item.get("NumberType")], int(item.get("Precision"))))
        if row is not None:
            test.assertLess(row, data.shape[0])


def check_side_file(test, path):
    """(name, times, {field: where}) of each collection of a side file, everything in it looked up."""
    found = []
    root = xml.etree.ElementTree.parse(path).getroot()
    for collection in root.findall("./Domain/Grid"):
        test.assertEqual((collection.get("GridType"), collection.get("CollectionType")), ("Collection", "Temporal"))
        times, fields = [], {}
        for row, grid in enumerate(collection.findall("Grid")):
            times.append(float(grid.find("Time").get("Value")))
            topology, geometry = grid.find("Topology"), grid.find("Geometry")
            cells = int(topology.get("NumberOfElements"))
            test.assertEqual(geometry.get("GeometryType"), "XYZ")
            check_item(test, topology.find("DataItem"), (cells, CORNERS[topology.get("TopologyType")]))
            places = meant(geometry.find("DataItem"), root)
            points = shape_of(places)[0]
            check_item(test, places, (points, 3))
            if places is not geometry.find("DataItem"):
                # Its own positions, of the row of its number.
                test.assertIs(places, grid.find("DataItem"))
                test.assertEqual(int(places.find("DataItem").text.split()[0]), row)
            for field in grid.findall("Attribute"):
                n = {"Node": points, "Cell": cells}[field.get("Center")]
                check_item(test, field.find("DataItem"), (n, *WIDTH[field.get("AttributeType")]))
                fields[field.get("Name")] = field.get("Center")
        test.assertEqual(times, sorted(set(times)))
        found.append((collection.get("Name"), times, fields))
    return found


def points_of(path, name, row=-1):
    """The positions of one frame where they stand in the text, as rows."""
    (collection,) = [each for each in xml.etree.ElementTree.parse(path).findall("./Domain/Grid") if each.get("Name") == name]
    numbers = list(map(float, collection.findall("Grid")[row].find("Geometry/DataItem").text.split()))
    return [numbers[i : i + 3] for i in range(0, len(numbers), 3)]
