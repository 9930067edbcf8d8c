"""Axes of studies: values over two keys in colours, points that failed, parameters with their intervals."""

import math

import matplotlib.lines
import numpy


def edges(values, log):
    """Borders of cells around points that need not be equally far from each other."""
    if log:
        return numpy.exp(edges(numpy.log(values), False))
    middle = 0.5 * (values[1:] + values[:-1])
    return numpy.concatenate([[values[0] - (middle[0] - values[0])], middle, [values[-1] + (values[-1] - middle[-1])]])


def draw_map(axes, panel, formatter):
    """A cell a point; grey where it failed."""
    grid = panel.grid
    axes.set_facecolor("#c8c8c8")
    image = axes.pcolormesh(edges(grid.x, grid.log_x), edges(grid.y, grid.log_y), numpy.ma.masked_invalid(grid.z), cmap="viridis", rasterized=True)
    axes.set_xscale("log" if grid.log_x else "linear")
    axes.set_yscale("log" if grid.log_y else "linear")
    axes.grid(False)
    axes.figure.colorbar(image, ax=axes, pad=0.02, format=formatter)
    if not numpy.isfinite(grid.z).all():
        axes.legend(handles=[matplotlib.lines.Line2D([], [], linestyle="none", marker="s", color="#c8c8c8", label="failed")], loc="upper right", bbox_to_anchor=(1, -0.12))
    axes.set_title(panel.title)
    axes.set_xlabel(panel.x_label)
    axes.set_ylabel(panel.y_label)


def draw_failed(axes, panel):
    """Crosses on the axis where points failed; their legend entry."""
    style = {"color": "#b3261e", "marker": "x", "linestyle": "none"}
    axes.plot(panel.failed, numpy.zeros(len(panel.failed)), transform=axes.get_xaxis_transform(), clip_on=False, zorder=5, **style)
    return matplotlib.lines.Line2D([], [], label="failed", **style)


def value_text(interval):
    unit = "" if interval.unit in ("", "1") else f" {interval.unit}"
    if math.isinf(interval.half_width):
        return f"{interval.value:.4g}{unit}, not determined"
    if math.isnan(interval.half_width):
        return f"{interval.value:.6g}{unit}, no interval"
    digits = max(0, 1 - math.floor(math.log10(interval.half_width))) if interval.half_width > 0 else 0
    if 0 < digits <= 8 and abs(interval.value) >= 1e-3:
        return f"{interval.value:.{digits}f} $\\pm$ {interval.half_width:.{digits}f}{unit}"
    return f"{interval.value:.6g} $\\pm$ {interval.half_width:.2g}{unit}"


def draw_intervals(axes, panel, colours):
    """Each parameter on a line from its lower bound (0) to its upper one (1): where it began, what was fitted, its interval."""
    rows = panel.intervals
    for row, interval in enumerate(rows):
        width = interval.upper - interval.lower
        at, start = (interval.value - interval.lower) / width, (interval.start - interval.lower) / width
        half = interval.half_width / width
        low, high = (0.0, 1.0) if math.isinf(half) else (max(0.0, at - half), min(1.0, at + half))
        axes.plot([0, 1], [row, row], color="#d8d8d8", linewidth=0.8, zorder=1)
        if not math.isnan(half):
            axes.plot([low, high], [row, row], color=colours[2], linewidth=3, alpha=0.5, solid_capstyle="butt", zorder=2)
        axes.plot([start], [row], marker="o", color=colours[1], markerfacecolor="white", zorder=3)
        axes.plot([at], [row], marker="o", color=colours[2], zorder=4)
        axes.annotate(interval.name, (0, row), xytext=(0, 12), textcoords="offset points", fontsize=7, va="bottom")
        axes.annotate(value_text(interval), (0, row), xytext=(0, 4), textcoords="offset points", fontsize=7, va="bottom", color="#444444")
        axes.annotate(f"{interval.lower:.4g}", (0, row), xytext=(0, -4), textcoords="offset points", fontsize=6, va="top", color="#777777")
        axes.annotate(f"{interval.upper:.4g}", (1, row), xytext=(0, -4), textcoords="offset points", fontsize=6, va="top", ha="right", color="#777777")
    axes.set_ylim(len(rows) - 0.5, -0.8)
    axes.set_yticks([])
    axes.set_xticks([])
    axes.grid(False)
    axes.spines["left"].set_visible(False)
    axes.spines["bottom"].set_visible(False)
    axes.set_title(panel.title)
    axes.set_xlabel(panel.x_label, loc="left")
    style = {"linestyle": "none", "marker": "o"}
    handles = [
        matplotlib.lines.Line2D([], [], color=colours[1], markerfacecolor="white", label="start", **style),
        matplotlib.lines.Line2D([], [], color=colours[2], label="fitted", **style),
    ]
    axes.legend(handles=handles, loc="upper right", bbox_to_anchor=(1, 0), ncol=2, borderaxespad=0)
