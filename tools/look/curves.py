"""What is drawn of results: panels with curves, by kind."""

import dataclasses

import numpy

from result import WrongInput, axis_label


@dataclasses.dataclass
class Curve:
    """One line of a panel; `name` tells it from others of its file, `source` is the label of the file; `stable` marks equilibria."""

    name: str
    source: str
    x: numpy.ndarray
    y: numpy.ndarray
    stable: numpy.ndarray = None


@dataclasses.dataclass
class Panel:
    """One pair of axes."""

    title: str
    x_label: str
    y_label: str
    curves: list
    log_x: bool = False
    log_y: bool = False
    zero_line: bool = False
    markers: bool = False
    held: bool = False  # each value holds over the interval that ends at its time
    plain_log_x: bool = False  # a logarithmic axis without guides of orders
    scatter: bool = False  # points without lines
    ticks: list = None  # words in the place of the numbers 0, 1, ... of the axis
    failed: numpy.ndarray = None  # where points of a sweep failed
    grid: object = None  # values over two numbers, in colours
    intervals: list = None  # parameters of a fit
    colours: list = None  # numbers of colours by name, where these mean something
    wide_first: bool = False  # the first curve is a wide line under the others


class Panels:
    """Panels by title and axes, so that curves of several files meet in one."""

    def __init__(self):
        self.found = {}

    def add(self, series, title, quantity, unit, curves, **options):
        if series.is_statics:
            title += ", equilibria"
        x_label, y_label = axis_label(series.x_name, series.x_unit), axis_label(quantity, unit)
        panel = self.found.setdefault((title, x_label, y_label), Panel(title, x_label, y_label, [], **options))
        for name, x, y in curves:
            panel.curves.append(Curve(name, series.label, x, y, series.stable[: len(x)] if series.is_statics else None))

    def all(self):
        panels = [panel for panel in self.found.values() if panel.curves]
        for panel in panels:
            # A single name needs no legend.
            names = {curve.name for curve in panel.curves}
            if len(names) == 1 and not panel.title.startswith("Solver") and min(names) not in ("", "balance", "total"):
                what, comma, rest = panel.title.partition(",")
                panel.title = f"{what} of {min(names)}{comma}{rest}"
        return panels


COMPONENTS = ("x", "y", "z")


def columns(series, path, name, labels=None):
    """(label, x, y) for each column of a data set; one column keeps the name."""
    x, values = series.values(path)
    if values.ndim == 1:
        return [(name, x, values)]
    values = values.reshape(len(values), -1)
    if values.shape[1] == 1:
        return [(name, x, values[:, 0])]
    labels = labels or range(values.shape[1])
    return [(f"{name} {label}".strip(), x, values[:, i]) for i, label in enumerate(labels)]


HARDLY_SEEN = 0.05  # of the height of a panel


def add_energy(panels, series):
    names = [name for name in ("kinetic", "elastic", "electric", "gravity", "dissipated", "external", "source", "total") if f"energy/{name}" in series]
    curves = [curve for name in names for curve in columns(series, f"energy/{name}", name) if name == "total" or numpy.any(curve[2])]
    if names:
        panels.add(series, "Energy", "energy", series.unit(f"energy/{names[0]}"), curves)
    # A field may hold so much energy at rest that what goes to and fro beside it cannot be seen.
    if curves and max(numpy.ptp(y) for _, _, y in curves) < HARDLY_SEEN * max(numpy.abs(y).max() for _, _, y in curves):
        changes = [(name, x, y - y[0]) for name, x, y in curves]
        panels.add(series, "Energy exchange", "change of energy", series.unit(f"energy/{names[0]}"), changes, zero_line=True)
    if "energy/balance" in series:
        panels.add(series, "Energy balance", "error", series.unit("energy/balance"), columns(series, "energy/balance", "balance"), zero_line=True)


def add_joints(panels, series):
    for joint in series.names("joints"):
        path = f"joints/{joint}/coordinate"
        if path in series:
            panels.add(series, "Joint coordinates", "coordinate", series.unit(path), columns(series, path, joint))


def is_free(series, muscle):
    return ((series.result.scene.get("muscles") or {}).get(muscle) or {}).get("ends") == "free"


def add_muscles(panels, series):
    for folder in ("muscles", "springs"):
        for quantity in ("stretch", "force", "field", "layer_voltage", "charge") if folder == "muscles" else ("length", "force"):
            for name in series.names(folder):
                path = f"{folder}/{name}/{quantity}"
                # The force of a free actuator in equilibrium is zero: only its round-off would be seen.
                idle = quantity == "force" and series.is_statics and is_free(series, name)
                if path in series and not idle:
                    title = f"{folder[:-1].capitalize()} {quantity.replace('_', ' ')}"
                    panels.add(series, title, quantity.replace("_", " "), series.unit(path), columns(series, path, name))


def add_controls(panels, series):
    for name in series.names("controls"):
        path = f"controls/{name}"
        panels.add(series, "Controls", "control", series.unit(path), columns(series, path, name), held=not series.is_statics)


def add_points(panels, series):
    for name in series.names("points"):
        path = f"points/{name}"
        panels.add(series, f"Point {name}", "position", series.unit(path), columns(series, path, "", COMPONENTS))


def add_probes(panels, series):
    for name in series.names("probes"):
        path = f"probes/{name}"
        panels.add(series, "Probes", "probe", series.unit(path), columns(series, path, name, COMPONENTS))


def add_momentum(panels, series):
    for name in series.names("momentum"):
        path = f"momentum/{name}"
        panels.add(series, f"{name.capitalize()} momentum", "momentum", series.unit(path), columns(series, path, "", COMPONENTS))


def add_solver(panels, series):
    for name in ("iterations", "factorisations"):
        if f"solver/{name}" in series:
            panels.add(series, "Solver: work", "number a step", "1", columns(series, f"solver/{name}", name))
    for name in ("residual", "constraint_violation"):
        if f"solver/{name}" in series:
            curves = [(label, x, numpy.where(y > 0, y, numpy.nan)) for label, x, y in columns(series, f"solver/{name}", name.replace("_", " ")) if numpy.any(y > 0)]
            panels.add(series, "Solver: accuracy", "relative size", "1", curves, log_y=True)


def add_optimum(panels, series):
    """How the iterates of each stage came to the optimum."""
    if series.prefix:
        return
    for stage in series.names("optimum"):
        for quantity in ("objective", "infeasibility"):
            path = f"optimum/{stage}/iterates/{quantity}"
            if path in series:
                values = series.result.values(path)
                log = quantity == "infeasibility"
                title = f"Optimum: {quantity}"
                panel = panels.found.setdefault((title,), Panel(title, "iteration", quantity, [], log_y=log))
                shown = numpy.where(values > 0, values, numpy.nan) if log else values
                panel.curves.append(Curve(f"stage {stage}", series.label, numpy.arange(len(values)), shown))


KINDS = {
    "joints": add_joints,
    "muscles": add_muscles,
    "controls": add_controls,
    "points": add_points,
    "probes": add_probes,
    "energy": add_energy,
    "momentum": add_momentum,
    "solver": add_solver,
    "optimum": add_optimum,
}
# What is drawn where nobody says what, as far as the files hold it.
USUAL = ("joints", "points", "probes", "muscles", "controls", "energy")


def panels_of(results, kind):
    """The panels of one kind over all results."""
    if kind == "convergence":
        return convergence_panels(results)
    panels = Panels()
    for result in results:
        for series in result.series:
            KINDS[kind](panels, series)
    return panels.all()


def held_kinds(results):
    return [kind for kind in KINDS if panels_of(results, kind)]


def all_panels(results, kinds):
    """The panels of the kinds asked for; WrongInput where one is in none of the files."""
    if not kinds:
        found = [panel for kind in USUAL for panel in panels_of(results, kind)]
        if not found:
            raise WrongInput(f"'{results[0].path}' holds no rows yet")
        return found
    found = []
    for kind in kinds:
        panels = panels_of(results, kind)
        if not panels:
            held = ", ".join(held_kinds(results)) or "no rows yet"
            raise WrongInput(f"--what: no {kind} in {', '.join(str(result.path) for result in results)} (there: {held})")
        found += panels
    return found


def measured_paths(result):
    """Data sets whose convergence is shown: positions, coordinates, lengths, probes."""
    for folder, quantity in (("joints", "coordinate"), ("bodies", "position"), ("muscles", "length")):
        for name in result.names(folder):
            if f"{folder}/{name}/{quantity}" in result:
                yield f"{folder}/{name}/{quantity}"
    for folder in ("points", "probes"):
        for name in result.names(folder):
            yield f"{folder}/{name}"


def error_between(coarse, fine, path):
    """Largest difference at common times over the largest value of the fine one; None without common times."""
    times, fine_times = coarse.values("time"), fine.values("time")
    tolerance = 1e-9 * max(abs(fine_times[-1]), 1.0)
    at = numpy.clip(numpy.searchsorted(fine_times, times - tolerance), 0, len(fine_times) - 1)
    common = numpy.abs(fine_times[at] - times) <= tolerance
    common[0] = False  # the initial state is given
    if not common.any():
        return None
    reference = fine.values(path)
    scale = numpy.abs(reference).max()
    difference = numpy.abs(coarse.values(path)[common] - reference[at[common]]).max()
    return difference / scale if scale > 0 else None


def convergence_panels(results):
    """Errors against the result of the smallest step, over the step, with the slopes of their lines."""
    steps = {result: result.step() for result in results}
    missing = [str(result.path) for result in results if not steps[result] or "time" not in result]
    if missing:
        raise WrongInput(f"--what convergence: no dynamics with a step in {', '.join(missing)}")
    ordered = sorted(results, key=lambda result: steps[result])
    if len(set(steps.values())) < 3:
        raise WrongInput(f"--what convergence: give three or more results of different steps, got {len(set(steps.values()))}")
    finest, others = ordered[0], [result for result in ordered[1:] if steps[result] > steps[ordered[0]]]
    curves = []
    for path in measured_paths(finest):
        pairs = [(steps[other], error_between(other, finest, path)) for other in others if path in other]
        pairs = [(step, error) for step, error in pairs if error]
        if len(pairs) >= 2:
            x, y = numpy.array(pairs).T
            slope = numpy.polyfit(numpy.log(x), numpy.log(y), 1)[0]
            curves.append(Curve(f"{path}, slope {slope:.2f}", finest.label, x, y))
    if not curves:
        raise WrongInput("--what convergence: the results have no common times (record.every) or nothing moves")
    unit = finest.unit("time")
    title = f"Error against the step {steps[finest]:g} {unit} ({finest.label})"
    return [Panel(title, axis_label("step", unit), "relative error", curves, log_x=True, log_y=True, markers=True)]
