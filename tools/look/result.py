"""A result file of muldi-sim as plot and report see it: finished, interrupted, or still being written."""

import contextlib
import fcntl
import os
import pathlib
import re
import time

import h5py
import numpy
import yaml

from guarded import reading

ATTEMPTS = 5  # to open a file that is being written


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


def is_being_written(path):
    """Whether another process has it open: writers share their lock with readers."""
    with open(path, "rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
    return False


def opened(path):
    """The file, as readers beside a writer open it if there is one: these try again, ever more slowly, where a check sum does not fit,
    which in a damaged file never ends. A file may also grow between two looks that the library takes at its beginning."""
    for _ in range(ATTEMPTS):
        if not is_being_written(path):
            break
        with contextlib.suppress(OSError):
            return h5py.File(path, "r", swmr=True)
        time.sleep(0.01)
    return h5py.File(path, "r")


class Result:
    """An open file; `label` tells it from the others in legends."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        self.label = self.path.stem
        with self.reading():
            try:
                self.file = opened(path)
            except OSError as error:
                raise WrongInput(f"cannot read '{path}': {error}") from error
            if "status" not in self.file.attrs:
                raise WrongInput(f"'{path}' is no result of muldi-sim: it has no status")
        try:
            self.scene = yaml.safe_load(self.text("scene")) or {}
        except yaml.YAMLError:
            self.scene = {}
        self.series = []

    def reading(self):
        """Around everything that HDF5 reads of this file."""
        size = os.path.getsize(self.path) if self.path.exists() else 0
        return reading(size)

    def read_series(self):
        """Finds the series that have rows; after the labels are settled."""
        for prefix, axis in (("", "time"), ("replay/", "time"), ("statics/", "load")):
            if prefix + axis in self and len(self.values(prefix + axis)):
                self.series.append(Series(self, prefix, prefix + axis))

    def text(self, name):
        with self.reading():
            value = self.file.attrs.get(name, "")
        return value.decode() if isinstance(value, bytes) else str(value)

    def __contains__(self, name):
        with self.reading():
            return name in self.file

    def names(self, folder):
        with self.reading():
            item = self.file.get(folder)
            return sorted(item, key=natural) if isinstance(item, h5py.Group) else []

    def attribute(self, name, attribute):
        with self.reading():
            value = self.file[name].attrs.get(attribute, "")
        return value.decode() if isinstance(value, bytes) else str(value)

    def attributes(self, name="/"):
        """All attributes of the file, or of what `name` is."""
        with self.reading():
            return dict(self.file[name].attrs)

    def unit(self, name):
        return self.attribute(name, "unit")

    def doc(self, name):
        return self.attribute(name, "doc")

    def values(self, name):
        """All rows that are there now."""
        with self.reading():
            data = self.file[name]
            with contextlib.suppress(RuntimeError, OSError):
                data.id.refresh()
            return data[()]

    def is_column(self, name):
        """Whether it is a data set of one number a row; and its rows."""
        with self.reading():
            data = self.file[name]
            return isinstance(data, h5py.Dataset) and data.ndim == 1, len(data)

    def below(self, folder):
        """Paths of everything below a group, which need not exist."""
        found = []
        with self.reading():
            group = self.file.get(folder)
            if isinstance(group, h5py.Group):
                group.visit(found.append)
        return found

    def rows(self, name, rows):
        """Some rows by number, in rising order."""
        with self.reading():
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
