"""What the animated view shows: frames of bodies, lines and surfaces, cut down to a bounded size."""

import base64

import numpy

MAX_FRAMES = 240
MAX_SURFACE_VALUES = 1_500_000  # positions and colours of all surfaces and frames
FIELD_NAMES = ("potential", "displacement", "stretch", "pressure", "stress", "field", "true_field", "jacobian")
# Faces of a hexahedron, seen from outside against the clock.
FACES = numpy.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
CORNERS = numpy.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])


def chosen_rows(count, limit):
    """At most `limit` row numbers spread evenly, first and last among them."""
    return numpy.unique(numpy.linspace(0, count - 1, min(count, limit)).round().astype(int))


def floats(values):
    """Little-endian single precision as text."""
    return base64.b64encode(numpy.ascontiguousarray(values, dtype="<f4").tobytes()).decode()


def quantised(values):
    """Values as 16-bit numbers between their bounds, which stand beside them; all frames together."""
    finite = values[numpy.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
    span = high - low or 1.0
    scaled = numpy.nan_to_num((values - low) / span * 65535).round().clip(0, 65535)
    return {"low": low, "high": high, "values": base64.b64encode(scaled.astype("<u2").tobytes()).decode()}


def quaternions(matrices):
    """(n, 4) x, y, z, w of rotation matrices (n, 3, 3) with the directors as columns."""
    m = numpy.asarray(matrices)
    # The largest eigenvector of this symmetric matrix is the quaternion; exact also at half turns.
    k = numpy.empty((len(m), 4, 4))
    k[:, 0, 0] = m[:, 0, 0] - m[:, 1, 1] - m[:, 2, 2]
    k[:, 1, 1] = m[:, 1, 1] - m[:, 0, 0] - m[:, 2, 2]
    k[:, 2, 2] = m[:, 2, 2] - m[:, 0, 0] - m[:, 1, 1]
    k[:, 3, 3] = m[:, 0, 0] + m[:, 1, 1] + m[:, 2, 2]
    k[:, 0, 1] = k[:, 1, 0] = m[:, 0, 1] + m[:, 1, 0]
    k[:, 0, 2] = k[:, 2, 0] = m[:, 0, 2] + m[:, 2, 0]
    k[:, 1, 2] = k[:, 2, 1] = m[:, 1, 2] + m[:, 2, 1]
    k[:, 0, 3] = k[:, 3, 0] = m[:, 2, 1] - m[:, 1, 2]
    k[:, 1, 3] = k[:, 3, 1] = m[:, 0, 2] - m[:, 2, 0]
    k[:, 2, 3] = k[:, 3, 2] = m[:, 1, 0] - m[:, 0, 1]
    return numpy.linalg.eigh(k)[1][:, :, 3]


def bodies_of(series, drawing, rows):
    bodies = []
    for body in drawing.get("bodies", []):
        folder = f"{series.prefix}bodies/{body['name']}"
        if f"{folder}/position" not in series.result:
            return []
        position = series.result.rows(f"{folder}/position", rows)
        orientation = series.result.rows(f"{folder}/orientation", rows)
        bodies.append(body | {"position": floats(position), "quaternion": floats(quaternions(orientation))})
    return bodies


def lines_of(series, drawing, rows):
    """Muscles and springs with their recorded scalars, but those that are seen as meshes."""
    lines, meshes = [], mesh_folders(series)
    for line in drawing.get("lines", []):
        folder = series.prefix + line["folder"]
        if f"{folder}/length" not in series.result or any(f"{mesh}/".startswith(f"{line['folder']}/") for mesh in meshes):
            continue
        fields = {}
        for name in series.result.names(folder):
            one_number, length = series.result.is_column(f"{folder}/{name}")
            attributes = series.result.attributes(f"{folder}/{name}")
            if one_number and length >= len(series.x) and "axis" not in attributes:
                fields[name] = {"unit": attributes.get("unit", ""), "values": floats(series.result.rows(f"{folder}/{name}", rows))}
        lines.append(line | {"fields": fields})
    return lines


def outer_faces(cells):
    """Faces that belong to one cell only, as (n, 4) node numbers."""
    faces = cells[:, FACES].reshape(-1, 4)
    keys = numpy.sort(faces, axis=1)
    _, first, count = numpy.unique(keys, axis=0, return_index=True, return_counts=True)
    return faces[numpy.sort(first[count == 1])]


def largest_stretch(reference, position, cells):
    """(frames, cells) largest principal stretch at the centres of trilinear hexahedra."""
    X = reference[cells]  # (cells, 8, 3)
    dX = numpy.einsum("cak,al->ckl", X, CORNERS / 8.0)
    dN = CORNERS / 8.0 @ numpy.linalg.inv(dX)  # (cells, 8, 3)
    F = numpy.einsum("fcai,caj->fcij", position[:, cells], dN)
    C = numpy.einsum("fcki,fckj->fcij", F, F)
    return numpy.sqrt(numpy.linalg.eigvalsh(C)[..., -1])


def magnitude(name, values):
    """One number to colour by: the length of a vector, the equivalent stress after Mises of xx, yy, zz, xy, yz, zx."""
    if values.ndim == 2:
        return values
    if values.shape[-1] == 6:
        xx, yy, zz, xy, yz, zx = numpy.moveaxis(values, -1, 0)
        return numpy.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * (xy**2 + yz**2 + zx**2))
    return numpy.linalg.norm(values, axis=-1)


def at_nodes(values, cells, n_nodes):
    """Averages of (frames, cells) over the cells around each node."""
    count = numpy.bincount(cells.ravel(), minlength=n_nodes)
    return numpy.stack([numpy.bincount(cells.ravel(), weights=numpy.repeat(row, 8), minlength=n_nodes) for row in values]) / numpy.maximum(count, 1)


SHOWN_AS = {"stress": "stress (Mises)", "stretch": "largest stretch"}


def surface_of(series, folder, rows, budget):
    """The outer faces of one mesh at some of the rows of its own axis; None where only the mesh was recorded."""
    result = series.result
    base = f"{series.prefix}{folder}"
    cells = result.values(f"{base}/cells").astype(int)
    reference = result.values(f"{base}/reference")
    faces = outer_faces(cells)
    used, numbers = numpy.unique(faces, return_inverse=True)
    faces = numbers.reshape(-1, 4)
    grown = [name for name in result.names(base) if name not in ("cells", "reference") and result.attribute(f"{base}/{name}", "located")]
    shown = [name for name in FIELD_NAMES if name in grown]
    moves = "position" in grown
    per_row = len(used) * (3 * moves + len(shown) + 2 * moves)
    rows = rows[chosen_rows(len(rows), max(2, budget // max(per_row, 1)))] if per_row * len(rows) > budget else rows
    surface = {"name": folder, "faces": base64.b64encode(faces.astype("<u4").tobytes()).decode(), "nodes": len(used), "rows": [], "fields": {}}
    position = result.rows(f"{base}/position", rows) if moves else numpy.repeat(reference[None], len(rows), axis=0)
    surface["position"] = quantised(position[:, used])
    unit = result.unit(f"{base}/reference")
    if moves:
        surface["fields"]["displacement"] = quantised(numpy.linalg.norm(position - reference, axis=-1)[:, used]) | {"unit": unit}
        stretch = largest_stretch(reference, position, cells)
        surface["fields"][SHOWN_AS["stretch"]] = quantised(at_nodes(stretch, cells, len(reference))[:, used]) | {"unit": "1"}
    for name in shown:
        values = magnitude(name, result.rows(f"{base}/{name}", rows))
        if result.attribute(f"{base}/{name}", "located") == "in the cells":
            values = at_nodes(values, cells, len(reference))
        surface["fields"][SHOWN_AS.get(name, name)] = quantised(values[:, used]) | {"unit": result.unit(f"{base}/{name}")}
    return surface, rows


def mesh_folders(series):
    """Groups of solids, and of muscles of finite elements, that hold a mesh."""
    folders = []
    for family in ("solids", "muscles"):
        below = series.result.below(series.prefix + family)
        folders.extend(f"{family}/{name}"[: -len("/cells")] for name in below if name.endswith("/cells"))
    return folders


def view_of(series, drawing):
    """Everything that moves in one series, or None where there is nothing to see."""
    rows = chosen_rows(len(series.x), MAX_FRAMES)
    bodies, lines = bodies_of(series, drawing, rows), lines_of(series, drawing, rows)
    if drawing.get("bodies") and not bodies:
        lines = []
    view = {
        "name": series.name,
        "axis": series.x_name,
        "unit": "" if series.x_unit == "1" else series.x_unit,
        "frames": series.x[rows].tolist(),
        "bodies": bodies,
        "lines": lines,
        "joints": drawing.get("joints", []) if bodies else [],
        "surfaces": [],
    }
    folders = mesh_folders(series)
    for folder in folders:
        axis = "load" if series.is_statics else "times"
        times = series.result.values(f"{series.prefix}{folder}/{axis}")
        if not len(times):
            continue
        own = chosen_rows(len(times), MAX_FRAMES)
        surface, own = surface_of(series, folder, own, MAX_SURFACE_VALUES // len(folders))
        surface["frames"] = times[own].tolist()
        view["surfaces"].append(surface)
    if view["surfaces"] and not (bodies or lines):
        view["frames"] = view["surfaces"][0]["frames"]
    return view if bodies or lines or view["surfaces"] else None


def views_of(result, drawing):
    """The motion first, then the others, as far as there is something to show."""
    views = [view_of(series, drawing) for series in result.series]
    return [view for view in views if view]
