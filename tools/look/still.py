"""still.py -o FIGURE FILE: bodies, muscles and solids of a result as a still picture, with the first state faint behind the one that is
furthest from it; called by `muldi-sim plot --what view`, which gives the drawing of the scene as JSON on standard input."""

import argparse
import base64
import json
import sys

import guarded
import numpy

BODY, GROUND = (0.72, 0.78, 0.86), (0.35, 0.39, 0.45)
LIGHT = numpy.array([0.3, 0.55, 0.78])
BOX_FACES = numpy.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
BOX_CORNERS = numpy.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
SIDES = 10
COLOURED_BY = ("potential", "true_field", "largest stretch", "stretch", "displacement")
MAX_TRAIL = 400


def floats(text, shape):
    return numpy.frombuffer(base64.b64decode(text), dtype="<f4").astype(float).reshape(shape)


def quantised(entry, shape):
    numbers = numpy.frombuffer(base64.b64decode(entry["values"]), dtype="<u2").astype(float).reshape(shape)
    return entry["low"] + numbers / 65535 * (entry["high"] - entry["low"])


def rotation(quaternion):
    x, y, z, w = quaternion
    return numpy.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


class Moving:
    """A view of view.py with its numbers unpacked."""

    def __init__(self, view):
        self.frames = len(view["frames"])
        self.times = numpy.array(view["frames"])
        self.bodies = [
            (body, floats(body["position"], (self.frames, 3)), floats(body["quaternion"], (self.frames, 4))) for body in view["bodies"]
        ]
        self.lines = view["lines"]
        self.joints = view["joints"]
        self.surfaces = []
        for surface in view["surfaces"]:
            faces = numpy.frombuffer(base64.b64decode(surface["faces"]), dtype="<u4").reshape(-1, 4)
            rows = len(surface["frames"])
            position = quantised(surface["position"], (rows, surface["nodes"], 3))
            name = next((name for name in COLOURED_BY if name in surface["fields"]), None)
            field = surface["fields"].get(name)
            values = quantised(field, (rows, surface["nodes"])) if field else None
            self.surfaces.append((numpy.array(surface["frames"]), faces, position, values, name, field["unit"] if field else ""))

    def pose(self, index, frame):
        _, position, quaternion = self.bodies[index]
        return position[frame], rotation(quaternion[frame])

    def place(self, point, frame):
        if point["body"] < 0:
            return numpy.array(point["at"])
        position, turn = self.pose(point["body"], frame)
        return position + turn @ numpy.array(point["at"])

    def ends(self, line, frame):
        if line["isolated"]:
            length = floats(line["fields"]["length"]["values"], (self.frames,))[frame]
            axis = 0.5 * length * numpy.array(line["axis"])
            return -axis, axis
        return tuple(self.place(point, frame) for point in line["ends"])

    def boxes(self, frame):
        found = []
        for index, (body, _, _) in enumerate(self.bodies):
            position, turn = self.pose(index, frame)
            found.append(position + (numpy.array(body["centre"]) + BOX_CORNERS * numpy.array(body["half"])) @ turn.T)
        return found

    def row_of(self, times, frame):
        return int(numpy.argmin(abs(times - self.times[frame])))

    def cloud(self, frame):
        """All points that move, one below the other."""
        parts = self.boxes(frame) + [numpy.array(self.ends(line, frame)) for line in self.lines]
        parts += [position[self.row_of(times, frame)] for times, _, position, *_ in self.surfaces]
        return numpy.concatenate(parts)

    def furthest(self):
        """The frame whose points are furthest from those of the first."""
        start = self.cloud(0)
        return max(range(self.frames), key=lambda frame: numpy.linalg.norm(self.cloud(frame) - start))


def camera(moving, gravity):
    """Directions right, up, towards the viewer."""
    up = numpy.array([0.0, 1.0, 0.0])
    if numpy.linalg.norm(gravity):
        up = -numpy.round(gravity / numpy.linalg.norm(gravity))
    spread = numpy.ptp(numpy.concatenate([moving.cloud(frame) for frame in (0, moving.frames // 2, moving.frames - 1)]), axis=0)
    towards = numpy.eye(3)[2 if up[1] or not up.any() else 1] * (1 if up[1] else -1)
    if up[1] and spread[2] > 1.5 * spread[0] and spread[2] > 2 * spread[1]:
        towards = numpy.array([1.0, 0.0, 0.0])
    right = numpy.cross(up, towards)
    turn, lift = numpy.radians([24.0, 18.0] if moving.bodies else [48.0, 28.0])
    towards, right = numpy.cos(turn) * towards + numpy.sin(turn) * right, numpy.cos(turn) * right - numpy.sin(turn) * towards
    towards, up = numpy.cos(lift) * towards + numpy.sin(lift) * up, numpy.cos(lift) * up - numpy.sin(lift) * towards
    return numpy.array([right, up, towards])


def tube(a, b, radius):
    """Faces of a cylinder between two points."""
    axis = (b - a) / max(numpy.linalg.norm(b - a), 1e-30)
    side = numpy.cross(axis, [1.0, 0, 0] if abs(axis[0]) < 0.9 else [0, 1.0, 0])
    side /= numpy.linalg.norm(side)
    angles = numpy.linspace(0, 2 * numpy.pi, SIDES, endpoint=False)
    ring = radius * (numpy.outer(numpy.cos(angles), side) + numpy.outer(numpy.sin(angles), numpy.cross(axis, side)))
    around = [numpy.array([a + ring[i], a + ring[i - 1], b + ring[i - 1], b + ring[i]]) for i in range(SIDES)]
    return [*around, a + ring[::-1], b + ring]


class Faces:
    """Polygons with a colour each, drawn from the back."""

    def __init__(self, directions):
        self.directions = directions
        self.found = []

    def add(self, corners, colour, edge=0.35, alpha=1.0):
        seen = corners @ self.directions.T
        normal = numpy.cross(corners[1] - corners[0], corners[2] - corners[0])
        size = numpy.linalg.norm(normal)
        shade = 0.62 + 0.38 * abs(normal @ self.directions.T @ LIGHT) / size if size else 1.0
        self.found.append((seen[:, 2].mean(), seen[:, :2], (*numpy.clip(numpy.array(colour[:3]) * shade, 0, 1), alpha), edge))

    def draw(self, axes):
        import matplotlib.collections

        self.found.sort(key=lambda face: face[0])
        if self.found:
            edges = [(0.2, 0.24, 0.3, min(face[2][3], face[3])) for face in self.found]
            axes.add_collection(
                matplotlib.collections.PolyCollection(
                    [face[1] for face in self.found], facecolors=[face[2] for face in self.found], edgecolors=edges, linewidths=0.35
                )
            )


def colour_of(line, moving, frame, colours, top):
    field = line["fields"].get("true_field") or line["fields"].get("field")
    if field is None or not top:
        return (0.80, 0.62, 0.45)
    return colours(0.15 + 0.8 * min(abs(floats(field["values"], (moving.frames,))[frame]) / top, 1.0))


def state(moving, frame, faces, scale, faint=False):
    """The faces of everything in one frame; faint ones are outlines of what was."""
    import matplotlib

    colours = matplotlib.colormaps["YlOrRd"]
    fields = [line["fields"].get("true_field") or line["fields"].get("field") for line in moving.lines]
    top = max((abs(floats(field["values"], (moving.frames,))).max() for field in fields if field), default=0.0)
    for corners in moving.boxes(frame):
        for face in BOX_FACES:
            faces.add(corners[face], BODY, edge=0.15 if faint else 0.8, alpha=0.1 if faint else 1.0)
    for line in moving.lines:
        a, b = moving.ends(line, frame)
        colour = colour_of(line, moving, frame, colours, top)
        stretched = numpy.linalg.norm(b - a)
        radius = max(line["radius"], 0.006 * scale)
        for corners in tube(a, b, radius) if stretched else []:
            faces.add(corners, colour, edge=0.0 if faint else 0.12, alpha=0.06 if faint else 1.0)
    for times, quads, position, values, _, _ in moving.surfaces:
        row = moving.row_of(times, frame)
        if faint and len(times) > 1 and moving.bodies:
            continue
        low, high = (values.min(), values.max()) if values is not None else (0, 0)
        hues = matplotlib.colormaps["viridis"]
        for quad in quads:
            part = 0.5 if values is None or high <= low else (values[row, quad].mean() - low) / (high - low)
            faces.add(position[row, quad], hues(0.1 + 0.85 * part), edge=0.08 if faint else 0.5, alpha=0.06 if faint else 1.0)


def trails(result):
    """Paths of recorded points."""
    found = []
    for series in result.series[:1]:
        for name in series.names("points") if not series.is_statics else ():
            values = series.values(f"points/{name}")[1]
            found.append(values[:: max(1, len(values) // MAX_TRAIL)])
    return found


def gravity_of(result):
    value = result.scene.get("gravity")
    try:
        return numpy.array([float(part) for part in value])
    except (TypeError, ValueError):
        return numpy.zeros(3)


def figure_of(result, drawing, size=(3.5, 2.4)):
    """A picture of the first series that has something to show."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot

    import result as files
    import view

    views = view.views_of(result, drawing)
    if not views:
        raise files.WrongInput(f"'{result.path}' holds nothing to see: no bodies, muscles or springs, and no fields of solids (record.fields)")
    moving = Moving(views[0])
    last = moving.furthest()
    directions = camera(moving, gravity_of(result))
    scale = numpy.linalg.norm(numpy.ptp(moving.cloud(0), axis=0))
    figure, axes = pyplot.subplots(figsize=size)
    if last:
        ghosts = Faces(directions)
        state(moving, 0, ghosts, scale, faint=True)
        ghosts.draw(axes)
    for path in trails(result):
        seen = path @ directions.T
        axes.plot(seen[:, 0], seen[:, 1], color="#D55E00", linewidth=0.6, alpha=0.55)
    faces = Faces(directions)
    state(moving, last, faces, scale)
    faces.draw(axes)
    for joint in moving.joints:
        seen = directions @ moving.place(joint["at"], last)
        axes.plot(seen[0], seen[1], marker="o", markersize=2.2, color=GROUND if joint["at"]["body"] < 0 else "#333333", zorder=5)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.margins(0.04)
    axes.set_axis_off()
    figure.subplots_adjust(0, 0, 1, 1)
    return figure


def main():
    parser = argparse.ArgumentParser(prog="muldi-sim plot --what view")
    parser.add_argument("-o", dest="output", required=True)
    parser.add_argument("file")
    arguments = parser.parse_args()

    import figures
    import result

    (opened,) = result.open_all([arguments.file])
    figures.save(figure_of(opened, json.load(sys.stdin)), arguments.output)


if __name__ == "__main__":
    guarded.run("plot", main)
