"""The words and numbers of a report: status, facts, energy ledger, solver statistics, warnings."""

import math

import numpy

SENTENCES = {
    "completed": "The run came to its end.",
    "running": "The run is going on, or its process was killed; everything recorded so far is shown.",
    "interrupted": "The run was interrupted; `muldi-sim run --resume` goes on with the same bits.",
    "no_convergence": "Newton's iteration did not converge. A smaller step or slower controls usually help.",
    "loss_of_equilibrium": "Equilibrium was lost: beyond this load there is no equilibrium near (pull-in, buckling or a snap). `continuation: arc_length` follows the path past the limit.",
    "muscle_collapse": "A muscle collapsed: it was pressed together below the stretch at which its model has a meaning.",
    "inverted_element": "An element was turned inside out. A finer mesh, a smaller step or a lower voltage usually help.",
    "breakdown": "The field in a deformed dielectric exceeded the strength of its material (`breakdown_field`). A lower field or thicker layers help.",
    "step_too_large": "A body turned too far in one step: take a smaller step.",
    "rank_change": "The constraints changed their rank: the mechanism passed through a singular position.",
    "infeasible": "No solution satisfies all conditions.",
    "iteration_limit": "The iterations came to their limit before the solution was found.",
    "write_error": "The file could not be written to its end.",
}
COUNTED = ("bodies", "joints", "muscles", "springs", "solids", "controls")
ONE = {"bodies": "body"}


def number(value):
    """Six digits at most, as people write them."""
    if value is None or not math.isfinite(value):
        return "-"
    if value == 0:
        return "0"
    return f"{value:.6g}"


def with_unit(value, unit):
    return f"{number(value)} {unit}" if unit and unit != "1" else number(value)


def status_of(result):
    """(status, class of its badge, sentence)."""
    status = result.text("status")
    sentence = SENTENCES.get(status, "")
    where = result.text("status_where")
    time = result.attributes().get("status_time", math.nan)
    if status != "completed" and isinstance(time, float) and math.isfinite(time):
        sentence = f"At t = {with_unit(time, result.unit('time') if 'time' in result else '')}: " + sentence
    kind = "" if status == "completed" else "open" if status in ("running", "interrupted") else "stopped"
    return status, kind, f"{sentence} {where[:1].upper() + where[1:]}{'.' if where and not where.endswith('.') else ''}".strip()


def facts_of(result):
    """(number, what) of what the scene holds."""
    counts = [(len(result.scene[key]), key) for key in COUNTED if result.scene.get(key)]
    facts = [(str(count), key if count > 1 else ONE.get(key, key[:-1])) for count, key in counts]
    dynamics, statics = result.scene.get("dynamics"), result.scene.get("statics")
    unit = result.text("units").split(", ")[2] if result.text("units").count(",") == 3 else ""
    if dynamics:
        facts.append((with_unit(float(dynamics["duration"]), unit), f"of motion in steps of {with_unit(float(dynamics['step']), unit)}"))
    if statics:
        facts.append((str(statics.get("steps", "")), f"load steps, {statics.get('continuation', 'natural').replace('_', ' ')}"))
    attributes = result.attributes()
    seconds = sum(value for name, value in attributes.items() if name.startswith("wall_time."))
    if seconds:
        threads = int(attributes.get("threads", 1))
        facts.append((f"{seconds:.3g} s", f"wall time, {threads} thread{'s' if threads > 1 else ''}"))
    return facts


LEDGER = ("kinetic", "elastic", "electric", "gravity", "total", "dissipated", "external", "source", "balance")


def ledger_of(series):
    """Rows of the energy table: name, first, last, least, largest, meaning; and the unit."""
    rows, unit = [], ""
    for name in LEDGER:
        if f"energy/{name}" not in series:
            continue
        _, values = series.values(f"energy/{name}")
        unit = series.unit(f"energy/{name}")
        if len(values) and (numpy.any(values) or name in ("total", "balance")):
            doc = series.result.doc(f"{series.prefix}energy/{name}")
            rows.append((name, values[0], values[-1], values.min(), values.max(), doc))
    return rows, unit


def solver_rows(series):
    """Rows of the solver table: name, mean, largest, sum where it is a number of things, meaning."""
    rows = []
    for name in series.names("solver"):
        _, values = series.values(f"solver/{name}")
        if len(values):
            total = int(values.sum()) if values.dtype.kind == "i" else None
            rows.append((name.replace("_", " "), values.mean(), values.max(), total, series.result.doc(f"{series.prefix}solver/{name}")))
    return rows


def wall_times(result):
    return [(name.split(".", 1)[1], value) for name, value in result.attributes().items() if name.startswith("wall_time.")]


def extent(values):
    return float(numpy.max(values) - numpy.min(values)) if len(values) else 0.0


def warnings_of(result):
    """What a careful reader should know, from the numbers in the file."""
    found = []
    tolerance = float((result.scene.get("solver") or {}).get("tolerance", 1e-10))
    for series in result.series:
        where = series.name
        if series.is_statics and not series.stable.all():
            x = series.x[: len(series.stable)][~series.stable]
            found.append(f"{int((~series.stable).sum())} of {len(series.stable)} equilibria are unstable, from {with_unit(x[0], series.x_unit)} on the path.")
        if "solver/residual" in series:
            _, residual = series.values("solver/residual")
            worst = int((residual > 10 * tolerance).sum())
            if worst:
                found.append(f"{where}: the residual is above ten times the tolerance {tolerance:g} in {worst} rows (largest {residual.max():.3g}).")
        if "solver/constraint_violation" in series:
            _, violation = series.values("solver/constraint_violation")
            if len(violation) and violation.max() > 1e-8:
                found.append(f"{where}: constraints are violated by up to {violation.max():.3g} of the scene's size.")
        if "energy/balance" in series:
            _, balance = series.values("energy/balance")
            scale = max(extent(series.values(f"energy/{name}")[1]) for name in ("kinetic", "elastic", "electric", "gravity") if f"energy/{name}" in series)
            if len(balance) and scale > 0 and abs(balance).max() > 0.02 * scale:
                found.append(
                    f"The energy ledger closes only to {100 * abs(balance).max() / scale:.2g} % of the energies that change hands; half the step makes this a quarter where the motion is resolved."
                )
        for name in series.names("muscles"):
            if f"muscles/{name}/stretch" in series:
                _, stretch = series.values(f"muscles/{name}/stretch")
                if len(stretch) and stretch.min() < 0.6:
                    found.append(f"{where}: muscle '{name}' is pressed to the stretch {stretch.min():.3g}; beyond pull-in its model describes an unstable branch.")
    if result.text("git_hash").endswith("-dirty"):
        found.append("The program was built from sources with uncommitted changes: the commit below does not tell all.")
    return found
