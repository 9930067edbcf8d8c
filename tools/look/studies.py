"""What is drawn of the tables of sweeps and of the files of calibrations."""

import dataclasses

import numpy

from curves import Curve, Panel
from result import WrongInput, axis_label

SWEEP, CALIBRATION = "muldi-sim sweep", "muldi-sim calibrate"
FAMILY = 6  # curves that are told apart at a glance; beyond, two numbers make a map
MANY_CURVES = 24


@dataclasses.dataclass
class Column:
    """A key or an output over the points: numbers, or numbers of words."""

    name: str
    unit: str
    values: numpy.ndarray
    words: list = None

    @property
    def label(self):
        return axis_label(self.name, self.unit)

    def distinct(self):
        return numpy.unique(self.values)

    def text(self, value):
        """A value with its key, as legends name it."""
        if self.words:
            return self.words[int(value)]
        unit = "" if self.unit in ("", "1") else f" {self.unit}"
        return f"{value:.6g}{unit}"


@dataclasses.dataclass
class Map:
    """Values over two numbers: z[i, j] at y[i], x[j]; NaN where a point failed."""

    x: numpy.ndarray
    y: numpy.ndarray
    z: numpy.ndarray
    log_x: bool
    log_y: bool


@dataclasses.dataclass
class Interval:
    """A fitted parameter between its bounds; half_width is infinite where the data do not determine it."""

    name: str
    unit: str
    start: float
    value: float
    lower: float
    upper: float
    half_width: float


def kind_of(result):
    """`sweep`, `calibration`, or nothing where the file is of a run."""
    return {SWEEP: "sweep", CALIBRATION: "calibration"}.get(result.text("format"), "")


def short(key, others):
    """The end of a key by which it differs from the others: `viscosity` for materials.silicone.viscous.viscosity."""
    parts = key.split(".")
    for n in range(1, len(parts)):
        end = ".".join(parts[-n:])
        if not any(other != key and (other == end or other.endswith("." + end)) for other in others):
            return end
    return key


class Sweep:
    """The table of a sweep."""

    def __init__(self, result):
        self.result = result
        self.keys = [self.column(f"parameters/{name}", name) for name in self.members("parameters")]
        self.outputs = [self.column(f"outputs/{name}", name) for name in self.members("outputs")]
        words = result.attribute("status", "words").split("\n")
        self.status = [words[int(number)] for number in result.values("status")]
        names = [key.name for key in self.keys]
        for key in self.keys:
            key.full = key.name
            key.name = short(key.name, names)

    def members(self, folder):
        return self.result.names(folder)

    def column(self, path, name):
        words = self.result.attribute(path, "words")
        return Column(name, self.result.unit(path), self.result.values(path).astype(float), words.split("\n") if words else None)

    @property
    def n_points(self):
        return len(self.status)

    @property
    def varied(self):
        return [key for key in self.keys if len(key.distinct()) > 1]

    def is_grid(self):
        """Every combination of the values of the keys is there once."""
        combinations = {tuple(row) for row in numpy.stack([key.values for key in self.varied], axis=1)}
        return len(combinations) == self.n_points == numpy.prod([len(key.distinct()) for key in self.varied])


def failed_at(sweep, values):
    """Where on the axis points have failed; nothing is drawn of them elsewhere."""
    return numpy.unique(values[[status != "completed" for status in sweep.status]])


def log_spread(values):
    """Whether positive values are spread as those of `logspace`."""
    distinct = numpy.unique(values)
    if len(distinct) < 3 or distinct[0] <= 0:
        return False
    steps, factors = numpy.diff(distinct), numpy.diff(numpy.log(distinct))
    return bool(distinct[-1] / distinct[0] >= 8 and numpy.ptp(factors) / factors.mean() < numpy.ptp(steps) / steps.mean())


def curves_over(sweep, output, x, others):
    """One curve for each combination of the other keys, in their order."""
    curves = []
    combinations = numpy.stack([key.values for key in others], axis=1) if others else numpy.zeros((sweep.n_points, 0))
    for combination in dict.fromkeys(map(tuple, combinations)):
        at = numpy.flatnonzero((combinations == combination).all(axis=1))
        at = at[numpy.argsort(x.values[at], kind="stable")]
        name = ", ".join(f"{key.name} {key.text(value)}" if len(others) > 1 else key.text(value) for key, value in zip(others, combination))
        curves.append(Curve(name, "", x.values[at], output.values[at]))
    return curves


def family(sweep, output, x, others):
    title = f"{output.name}" + (f" by {', '.join(key.name for key in others)}" if others else "")
    return Panel(title, x.label, output.label, curves_over(sweep, output, x, others), plain_log_x=log_spread(x.values), markers=True, failed=failed_at(sweep, x.values))


def heat_map(sweep, output, x, y):
    columns, rows = x.distinct(), y.distinct()
    z = numpy.full((len(rows), len(columns)), numpy.nan)
    z[numpy.searchsorted(rows, y.values), numpy.searchsorted(columns, x.values)] = output.values
    return Panel(output.label, x.label, y.label, [], grid=Map(columns, rows, z, log_spread(columns), log_spread(rows)))


def scatter(sweep, output, key):
    title = f"{output.name} over {key.name}"
    curve = Curve("", "", key.values, output.values)
    return Panel(title, key.label, output.label, [curve], plain_log_x=log_spread(key.values), scatter=True, ticks=key.words, failed=failed_at(sweep, key.values))


def sweep_panels(sweep):
    """Curves over one key, families or maps over two, clouds of points where the design is no grid."""
    varied = sweep.varied
    numbers = [key for key in varied if not key.words]
    if not varied:
        points = Column("point", "1", numpy.arange(sweep.n_points, dtype=float))
        return [scatter(sweep, output, points) for output in sweep.outputs]
    if not numbers or not sweep.is_grid():
        return [scatter(sweep, output, key) for output in sweep.outputs for key in varied]
    x = max(numbers, key=lambda key: len(key.distinct()))
    others = [key for key in varied if key is not x]
    n_curves = numpy.prod([len(key.distinct()) for key in others]) if others else 1
    if len(numbers) == len(varied) == 2 and n_curves > FAMILY:
        return [heat_map(sweep, output, x, others[0]) for output in sweep.outputs]
    if n_curves > MANY_CURVES:
        return [scatter(sweep, output, key) for output in sweep.outputs for key in varied]
    return [family(sweep, output, x, others) for output in sweep.outputs]


def number(result, path):
    return float(result.values(path)) if path in result else numpy.nan


def intervals_of(result):
    """The fitted parameters."""
    return [
        Interval(
            name,
            result.unit(f"parameters/{name}/value"),
            *(number(result, f"parameters/{name}/{what}") for what in ("start", "value", "lower", "upper", "half_width_95")),
        )
        for name in result.names("parameters")
    ]


def compared_of(result):
    """(name, axis, unit of the axis, x, {reference, before, after: values of n rows}, unit) of each curve."""
    for name in result.names("curves"):
        group = f"curves/{name}"
        axis = next(axis for axis in ("time", "load", "stretch") if f"{group}/{axis}" in result)
        values = {what: result.values(f"{group}/{what}") for what in ("reference", "before", "after")}
        yield name, axis, result.unit(f"{group}/{axis}"), result.values(f"{group}/{axis}"), values, result.unit(f"{group}/reference")


def calibration_panels(result):
    """Reference, before and after; what is left of the differences; the parameters between their bounds."""
    panels = []
    for name, axis, axis_unit, x, values, unit in compared_of(result):
        x_label = axis_label(axis, axis_unit)
        for i in range(values["reference"].shape[1]):
            title = name if values["reference"].shape[1] == 1 else f"{name}[{i}]"
            columns = {what: rows[:, i] for what, rows in values.items()}
            quantity = axis_label(title.rsplit(".", 1)[-1].replace("_", " "), unit)
            panels.append(Panel(title, x_label, quantity, [Curve(what, "", x, column) for what, column in columns.items()], colours=[7, 1, 2], wide_first=True))
            left = [Curve(what, "", x, columns[what] - columns["reference"]) for what in ("before", "after")]
            panels.append(Panel("Difference from the reference", x_label, axis_label("difference", unit), left, zero_line=True, colours=[1, 2]))
    panels.append(Panel("Parameters with 95 % intervals", "from the lower bound to the upper one", "", [], intervals=intervals_of(result)))
    return panels


def panels_of(results, kinds):
    """The panels of the one study that was given; WrongInput where words or files do not fit it."""
    (kind,) = {kind_of(result) for result in results if kind_of(result)}
    if len(results) > 1:
        raise WrongInput(f"'{next(result.path for result in results if kind_of(result))}' is of a {kind}: give it alone")
    if kinds:
        raise WrongInput(f"--what: a {kind} has no {', '.join(kinds)}: leave it out, everything is drawn")
    return sweep_panels(Sweep(results[0])) if kind == "sweep" else calibration_panels(results[0])


def has_study(results):
    return any(kind_of(result) for result in results)
