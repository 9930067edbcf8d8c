"""A result file of muldi-sim as plot and report see it: finished, interrupted, or still being written."""

import contextlib
import pathlib
import re

import h5py
import numpy
import yaml


class WrongInput(Exception):
    """What the user gave cannot be shown; the sentence says why (exit code 2)."""


def axis_label(name, unit):
    """`name (unit)` with powers raised; no unit for plain numbers."""
    if not unit or unit == "1":
        return name
    raised = re.sub(r"\^(-?[0-9]+)", lambda power: f"$^{{{power.group(1)}}}$", unit)
    return f"{name} ({raised})"


def natural(name):
    """Sorting key by which m2 comes before m10."""
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"([0-9]+)", name)]


class Series:
    """The rows of the dynamics, the statics or the replay of a file: values over an axis.

    prefix  '', 'statics/' or 'replay/'
    label   what legends call it
    x       values of the axis (rows), `x_name` and `x_unit` what they are
    """

    def __init__(self, result, prefix, axis):
        self.result = result
        self.prefix = prefix
        self.x = result.values(axis)
        self.x_unit = result.unit(axis)
        self.is_statics = prefix == "statics/"
        self.label = f"{result.label}, replay" if prefix == "replay/" else result.label
        self.name = {"": "motion", "statics/": "equilibria", "replay/": "replay"}[prefix]
        self.x_name = "time"
        if self.is_statics:
            swept = "swept control" in result.doc(axis)
            control = (result.scene.get("statics") or {}).get("control")
            self.x_name = f"control {control}" if swept and control else "load factor"
            self.stable = result.values(prefix + "stable") != 0

    def __contains__(self, name):
        return self.prefix + name in self.result

    def names(self, folder):
        """Names of the members of a group of this series, in natural order."""
        return self.result.names(self.prefix + folder)

    def unit(self, name):
        return self.result.unit(self.prefix + name)

    def values(self, name):
        """(x, values) of a data set, as many rows as both have."""
        values = self.result.values(self.prefix + name)
        rows = min(len(values), len(self.x))
        return self.x[:rows], values[:rows]


class Result:
    """An open file; `label` tells it from the others in legends."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        self.label = self.path.stem
        try:
            try:
                self.file = h5py.File(path, "r", swmr=True)
            except OSError:
                self.file = h5py.File(path, "r")
        except OSError as error:
            raise WrongInput(f"cannot read '{path}': {error}") from error
        if "status" not in self.file.attrs:
            raise WrongInput(f"'{path}' is no result of muldi-sim: it has no status")
        try:
            self.scene = yaml.safe_load(self.text("scene")) or {}
        except yaml.YAMLError:
            self.scene = {}
        self.series = []

    def read_series(self):
        """Finds the series that have rows; after the labels are settled."""
        for prefix, axis in (("", "time"), ("replay/", "time"), ("statics/", "load")):
            if prefix + axis in self.file and self.file[prefix + axis].shape[0]:
                self.series.append(Series(self, prefix, prefix + axis))

    def text(self, name):
        value = self.file.attrs.get(name, "")
        return value.decode() if isinstance(value, bytes) else str(value)

    def __contains__(self, name):
        return name in self.file

    def names(self, folder):
        item = self.file.get(folder)
        return sorted(item, key=natural) if isinstance(item, h5py.Group) else []

    def attribute(self, name, attribute):
        value = self.file[name].attrs.get(attribute, "")
        return value.decode() if isinstance(value, bytes) else str(value)

    def unit(self, name):
        return self.attribute(name, "unit")

    def doc(self, name):
        return self.attribute(name, "doc")

    def values(self, name):
        """All rows that are there now."""
        data = self.file[name]
        with contextlib.suppress(RuntimeError, OSError):
            data.id.refresh()
        return data[()]

    def rows(self, name, rows):
        """Some rows by number, in rising order."""
        return numpy.asarray(self.file[name][list(rows)])

    def step(self):
        """The time step of the dynamics, or None."""
        step = (self.scene.get("dynamics") or {}).get("step")
        return float(step) if step else None


def open_all(paths):
    """The results in the order given, with labels that differ."""
    results = [Result(path) for path in paths]
    labels = [result.label for result in results]
    for result in results:
        if labels.count(result.label) > 1:
            result.label = f"{result.path.parent.name or '.'}/{result.path.stem}"
        result.read_series()
    return results
