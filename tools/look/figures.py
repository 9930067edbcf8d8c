"""Panels as figures of matplotlib, ready for print."""

import math
import re

import matplotlib
import numpy

matplotlib.use("Agg")
import matplotlib.lines  # noqa: E402  after the choice of what draws
import matplotlib.pyplot as pyplot  # noqa: E402
import matplotlib.ticker  # noqa: E402
import matplotlib.transforms  # noqa: E402

import study_figures  # noqa: E402

# Okabe and Ito: told apart by everyone, also in grey.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999")
DASHES = ("-", (0, (4, 1.5)), (0, (1, 1)), (0, (5, 1, 1, 1)), (0, (3, 1, 1, 1, 1, 1)))
STYLE = {
    "font.family": "sans-serif",
    "font.size": 8,
    "axes.titlesize": 9,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.1,
    "lines.markersize": 3.5,
    "legend.frameon": True,  # what lies below is seen as such
    "legend.framealpha": 0.8,
    "legend.edgecolor": "none",
    "legend.fontsize": 7,
    "legend.handlelength": 1.8,
    "axes.formatter.limits": (-3, 5),
    "savefig.bbox": "tight",
    "savefig.dpi": 200,
    "pdf.fonttype": 42,
    "svg.hashsalt": "muldi-sim",  # the same file every time
}
PANEL_WIDTH, PANEL_HEIGHT = 3.5, 2.3  # inches: two columns fill a page
MAX_LEGEND = 16


class Formatter(matplotlib.ticker.ScalarFormatter):
    """Plain numbers with a power of ten beside the axis; formulas on every tick would take most of the time of a figure."""

    def get_offset(self):
        offset = super().get_offset().replace("\u2212", "-")
        found = re.fullmatch(r"(?:1e([+-]?[0-9]+))?(?:([+-])([0-9.]+)(?:e([+-]?[0-9]+))?)?", offset)
        if not found:
            return offset
        factor, sign, number, power = found.groups()
        text = rf"\times 10^{{{int(factor)}}}" if factor else ""
        text += rf"{sign}{number}" if sign else ""
        text += rf"\times 10^{{{int(power)}}}" if power else ""
        return f"${text}$" if text else ""


def line(colour, dashes, label):
    return matplotlib.lines.Line2D([], [], color=colour, linestyle=dashes, label=label)


def styles_of(panel):
    """(colour, dashes) of each curve and the entries of the legend: colours for names and dashes for files, or both for files
    where there is one name."""
    names = list(dict.fromkeys(curve.name for curve in panel.curves))
    sources = list(dict.fromkeys(curve.source for curve in panel.curves))

    def style(curve):
        name, source = names.index(curve.name), sources.index(curve.source)
        if len(names) == 1:
            return COLOURS[source % len(COLOURS)], DASHES[source % len(DASHES)]
        if panel.colours:
            return COLOURS[panel.colours[name]], "-"
        return COLOURS[name % len(COLOURS)], DASHES[(source if len(sources) > 1 else name // len(COLOURS)) % len(DASHES)]

    styles = [style(curve) for curve in panel.curves]
    if len(names) == 1 or len(sources) == 1:
        labels = [curve.source if len(names) == 1 else curve.name for curve in panel.curves]
        named = len(labels) > 1 or (panel.markers and any(labels))
        return styles, [line(*each, label) for each, label in zip(styles, labels)] if named else []
    entries = [line(COLOURS[i % len(COLOURS)], "-", name) for i, name in enumerate(names)]
    return styles, entries + [line("#555555", DASHES[i % len(DASHES)], source) for i, source in enumerate(sources)]


def draw_slopes(axes, panel):
    """Guides of first and second order below the lowest curve; returns their legend entries."""
    low = min(panel.curves, key=lambda curve: curve.y.min())
    x = numpy.sort(low.x)[[0, -1]]
    entries = []
    for order, dashes in ((1, (0, (1, 2))), (2, (0, (4, 2)))):
        axes.plot(x, 0.5 * low.y.min() * (x / x[0]) ** order, color="#888888", linewidth=0.8, linestyle=dashes)
        entries.append(line("#888888", dashes, f"order {order}"))
    return entries


def draw_curve(axes, curve, colour, dashes, marker, held=False):
    """Unstable equilibria are dotted; true if there are any."""
    if curve.stable is None or curve.stable.all():
        axes.plot(curve.x, curve.y, color=colour, linestyle=dashes, marker=None if held else marker, drawstyle="steps-pre" if held else "default")
        return False
    # The last stable point begins the unstable piece.
    unstable = ~curve.stable | numpy.append(~curve.stable[1:], False) | numpy.insert(~curve.stable[:-1], 0, False)
    axes.plot(curve.x, numpy.where(curve.stable, curve.y, numpy.nan), color=colour, linestyle=dashes, marker=marker)
    axes.plot(curve.x, numpy.where(unstable, curve.y, numpy.nan), color=colour, linestyle=(0, (1, 1.2)))
    return True


def draw_steps(axes, panel):
    """The steps that were computed are the ticks."""
    steps = sorted({x for curve in panel.curves for x in curve.x})
    axes.set_xscale("log")
    axes.set_xticks(steps, [f"{step:g}" for step in steps])
    axes.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())


def draw(axes, panel):
    if panel.grid is not None:
        study_figures.draw_map(axes, panel, Formatter())
        return
    if panel.intervals is not None:
        study_figures.draw_intervals(axes, panel, COLOURS)
        return
    styles, entries = styles_of(panel)
    axes.xaxis.set_major_formatter(Formatter())
    axes.yaxis.set_major_formatter(Formatter())
    unstable = False
    for curve, (colour, dashes) in zip(panel.curves, styles):
        marker = "o" if panel.markers or panel.scatter or len(curve.x) < 12 else None
        unstable |= draw_curve(axes, curve, colour, "none" if panel.scatter else dashes, marker, panel.held)
        if panel.wide_first and curve is panel.curves[0]:
            axes.lines[-1].set(linewidth=3.5, alpha=0.7)
    if unstable:
        entries.append(line("#555555", (0, (1, 1.2)), "unstable"))
    if panel.zero_line:
        axes.axhline(0, color="#888888", linewidth=0.6)
    if panel.log_x:
        entries += draw_slopes(axes, panel)
        draw_steps(axes, panel)
    if panel.log_y:
        axes.set_yscale("log")
    if panel.plain_log_x:
        axes.set_xscale("log")
    if panel.ticks:
        axes.set_xticks(range(len(panel.ticks)), panel.ticks)
    if panel.failed is not None and len(panel.failed):
        entries.append(study_figures.draw_failed(axes, panel))
    axes.set_title(panel.title)
    axes.set_xlabel(panel.x_label)
    axes.set_ylabel(panel.y_label)
    axes.margins(x=0.02)
    add_legend(axes, entries)


def has_room(axes, entries, longest):
    """True if a legend finds a place inside the axes where no curve passes, in parts of their size."""
    width, height = 0.13 + 0.019 * longest, 0.03 + 0.085 * len(entries)
    axes.get_xlim(), axes.get_ylim()  # settles both before anything is measured
    to_axes = axes.transData - axes.transAxes
    points = [to_axes.transform(line.get_xydata()) for line in axes.get_lines() if line.get_transform() == axes.transData and len(line.get_xydata())]
    if not points:
        return True
    x, y = numpy.concatenate(points).T
    places = [(a, b) for a in (0.0, 0.5 - 0.5 * width, 1.0 - width) for b in (0.0, 0.5 - 0.5 * height, 1.0 - height)]
    return any(not numpy.any((x >= a) & (x <= a + width) & (y >= b) & (y <= b + height)) for a, b in places)


def add_legend(axes, entries):
    """Inside where it is short and finds room, otherwise below the axes."""
    if not entries:
        return
    if len(entries) > MAX_LEGEND:
        entries = [*entries[:MAX_LEGEND], line("none", "-", f"and {len(entries) - MAX_LEGEND} more")]
    longest = max(len(entry.get_label()) for entry in entries)
    if len(entries) <= 4 and longest <= 22 and has_room(axes, entries, longest):
        axes.legend(handles=entries, loc="best", borderaxespad=0.2)
    else:
        # Below the numbers and the label of the axis, however high the axes are.
        below = axes.transAxes + matplotlib.transforms.ScaledTranslation(0, -34 / 72, axes.figure.dpi_scale_trans)
        columns = 1 if longest > 26 else 2 if longest > 18 else 3 if longest > 12 else 4
        axes.legend(handles=entries, loc="upper left", bbox_to_anchor=(-0.08, 0), bbox_transform=below, ncol=columns, borderaxespad=0, columnspacing=1.2)


def figure_of(panels, columns=None):
    """One figure with all panels, two in a row."""
    with matplotlib.rc_context(STYLE):
        columns = columns or (1 if len(panels) == 1 else 2)
        rows = math.ceil(len(panels) / columns)
        width = PANEL_WIDTH * (1.3 if len(panels) == 1 else columns)
        figure, grid = pyplot.subplots(rows, columns, figsize=(width, (PANEL_HEIGHT + 0.25 if len(panels) > 1 else 3.2) * rows), squeeze=False, constrained_layout=len(panels) > 1)
        flat = list(grid.flat)
        for axes, panel in zip(flat, panels):
            draw(axes, panel)
        for axes in flat[len(panels) :]:
            axes.remove()
        return figure


def save(figure, target, **options):
    """Writes a figure to a path or to an open file; no dates in it."""
    with matplotlib.rc_context(STYLE | options.pop("style", {})):
        metadata = {} if str(target).endswith(".png") else {"CreationDate" if str(target).endswith(".pdf") else "Date": None}
        figure.savefig(target, metadata=metadata, **options)
        pyplot.close(figure)
