"""The figures of tools/bench_work_precision.py: processor time against error, one panel a scene and sweep."""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

import bench_page  # noqa: E402

GROUPS = (("multibody", "Lumped scenes: steps, and tolerances of CVODE", "work_multibody", ("step",)),
          ("solids", "Finite elements: steps, meshes, formulations", "work_solids", ("step", "mesh", "formulation")),
          ("optimal_control", "Optimal control: iterations", "work_optimal_control", ("iteration",)),
          ("settings", "Our own settings: tolerances and solvers", None, ("tolerance", "solver")))
MARKERS = "osD^vPX*<>"


def panels(whole, program, sweeps):
    found = {}
    for point in whole["points"]:
        if (program is None or point["program"] == program) and point["sweep"] in sweeps:
            found[(point["scene"], point["sweep"])] = True
    return list(found)


def draw(axes, whole, scene, sweep):
    for i, (method, points) in enumerate(bench_page.curves(whole, scene, sweep).items()):
        good = [(seconds, error) for seconds, error, _ in points if seconds and error]
        if not good:
            continue
        ours = bench_page.is_ours(method)
        axes.plot([1e3 * seconds for seconds, _ in good], [error for _, error in good], marker=MARKERS[i % len(MARKERS)], markersize=3.5,
                  linewidth=1.6 if ours else 0.9, label=method)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.minorticks_off()
    axes.set_title(f"{scene} ({sweep})", fontsize=8)
    axes.set_xlabel("processor time, ms", fontsize=7)
    axes.set_ylabel("error", fontsize=7)
    axes.tick_params(labelsize=6)
    axes.grid(True, which="major", linewidth=0.3)
    axes.legend(fontsize=5.5)


def write(whole, folder):
    """Writes the figures; returns (caption, path) of each."""
    plt.rcParams["svg.fonttype"] = "none"
    plt.rcParams["svg.hashsalt"] = "muldi"
    written = []
    for name, caption, program, sweeps in GROUPS:
        wanted = panels(whole, program, sweeps)
        if not wanted:
            continue
        columns = min(3, len(wanted))
        rows = math.ceil(len(wanted) / columns)
        figure, grid = plt.subplots(rows, columns, figsize=(3.6 * columns, 3.0 * rows), squeeze=False)
        for axes in grid.flat[len(wanted):]:
            axes.set_axis_off()
        for axes, (scene, sweep) in zip(grid.flat, wanted):
            draw(axes, whole, scene, sweep)
        figure.tight_layout()
        path = folder / f"work_precision_{name}.svg"
        figure.savefig(path, metadata={"Date": None})
        plt.close(figure)
        written.append((caption, path))
    return written
