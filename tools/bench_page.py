"""The page and the ratios of tools/bench_work_precision.py, from its JSON."""

import math

OURS = "muldi-sim"
# A ratio is given at these errors, where both curves reach them.
LEVELS = [10.0**-k for k in range(1, 10)]
MIDDLE = {"step": "time step", "mesh": "mesh", "iteration": "iterations of the optimiser"}


def is_ours(method):
    return method == OURS or method.startswith(OURS + ", ")


def curves(whole, scene, sweep):
    """The points (seconds, error, setting) of each method, in the order of the file."""
    found = {}
    for point in whole["points"]:
        if point["scene"] == scene and point["sweep"] == sweep:
            found.setdefault(point["method"], []).append((point["seconds"], point["error"], point["setting"]))
    return found


def scenes(whole):
    return list(dict.fromkeys(point["scene"] for point in whole["points"]))


def reference(whole, scene):
    return next(entry for entry in whole["references"] if entry["scene"] == scene)


def frontier(points, floor):
    """The points that no other beats in both time and error, by falling error; those below the floor are unknown."""
    known = sorted((s, e) for s, e, _ in points if s and e and e > floor)
    best = []
    for seconds, error in known:
        if not best or error < best[-1][1]:
            best.append((seconds, error))
    return best


def seconds_at(best, error):
    """Time at an error, by straight lines between logarithms; None outside of the curve."""
    for (s0, e0), (s1, e1) in zip(best, best[1:]):
        if e1 <= error <= e0:
            weight = math.log(e0 / error) / math.log(e0 / e1)
            return math.exp((1 - weight) * math.log(s0) + weight * math.log(s1))
    if len(best) == 1 and best[0][1] == error:
        return best[0][0]
    return None


def common_levels(ours, theirs):
    """Round errors that both curves reach; where there is none, one in the middle of what they share."""
    if not ours or not theirs:
        return []
    high, low = min(ours[0][1], theirs[0][1]), max(ours[-1][1], theirs[-1][1])
    slack = 1 + 1e-9
    levels = [level for level in LEVELS if low / slack <= level <= high * slack]
    return levels if levels or low > high else [math.sqrt(low * high)]


def ratios(whole):
    """Time of each rival over that of our best curve at equal errors."""
    found = []
    for scene in scenes(whole):
        floor = 2.0 * (reference(whole, scene)["uncertainty"] or 0.0)
        for sweep in MIDDLE:
            all_curves = curves(whole, scene, sweep)
            ours = frontier([p for m, points in all_curves.items() if is_ours(m) for p in points], floor)
            for method, points in all_curves.items():
                if is_ours(method):
                    continue
                theirs = frontier(points, floor)
                for level in common_levels(ours, theirs):
                    mine, other = seconds_at(ours, level), seconds_at(theirs, level)
                    if mine and other:
                        found.append({"scene": scene, "sweep": sweep, "rival": method, "error": level, "seconds": mine, "rival_seconds": other,
                                      "times_faster": other / mine})
    return found


def reaches(points, floor):
    return any(error is not None and error <= floor for _, error, _ in points)


def apart(whole):
    """Pairs of curves that share no error: ours is everywhere better, or everywhere worse."""
    for scene in scenes(whole):
        floor = 2.0 * (reference(whole, scene)["uncertainty"] or 0.0)
        for sweep in MIDDLE:
            all_curves = curves(whole, scene, sweep)
            ours = frontier([p for m, points in all_curves.items() if is_ours(m) for p in points], floor)
            for method, points in all_curves.items():
                theirs = frontier(points, floor)
                if is_ours(method) or not ours or not theirs:
                    continue
                # Errors below the floor are smaller than what can be told.
                if ours[0][1] < theirs[-1][1] and not reaches(points, floor):
                    yield scene, method, ours[0], theirs[-1], "smaller than any of"
                elif theirs[0][1] < ours[-1][1] and not any(reaches(p, floor) for m, p in all_curves.items() if is_ours(m)):
                    yield scene, method, ours[-1], theirs[0], "larger than all of"


def number(value, digits=3):
    return "-" if value is None else f"{value:.{digits}g}"


def milliseconds(seconds):
    return "-" if seconds is None else f"{1e3 * seconds:.3g}"


def factor(times_faster):
    size = max(times_faster, 1 / times_faster)
    return f"{size:.0f}" * (size >= 9.95) + f"{size:.1f}" * (size < 9.95) + (" times faster" if times_faster >= 1 else " times slower")


def sentences(whole):
    """One statement a scene and rival: at the largest and the smallest error that both reach, and at 1e-3 where that lies between."""
    grouped = {}
    for entry in whole["ratios"]:
        grouped.setdefault((entry["scene"], entry["rival"]), []).append(entry)
    for (scene, rival), entries in grouped.items():
        entries.sort(key=lambda entry: -entry["error"])
        chosen = [e for i, e in enumerate(entries) if i in (0, len(entries) - 1) or math.isclose(e["error"], 1e-3)]
        yield f"{scene}, against {rival}: " + ", ".join(f"{factor(e['times_faster'])} at an error of {e['error']:.1g}" for e in chosen)


def apart_sentences(whole):
    for scene, method, (seconds, error), (rival_seconds, rival_error), relation in apart(whole):
        which = "largest" if relation.startswith("smaller") else "smallest"
        nearest = "smallest" if which == "largest" else "largest"
        yield (f"{scene}: our {which} error ({error:.1g} in {milliseconds(seconds)} ms) is {relation} {method} "
               f"({nearest}: {rival_error:.1g} in {milliseconds(rival_seconds)} ms)")


def summary(whole):
    return "\n".join([*sentences(whole), *apart_sentences(whole)])


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "| " + " | ".join("---" for _ in head) + " |"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def ratio_table(whole):
    rows = [(e["scene"], e["rival"], f"{e['error']:.1g}", milliseconds(e["seconds"]), milliseconds(e["rival_seconds"]), factor(e["times_faster"]))
            for e in whole["ratios"]]
    return table(("scene", "rival", "error", "ours, ms", "rival, ms", "ours is"), rows)


def scene_section(whole, scene):
    entry = reference(whole, scene)
    uncertainty = "" if entry["uncertainty"] is None else f" Uncertain by {entry['uncertainty']:.1g}; smaller errors are not used."
    parts = [f"### {scene}", f"Error: {entry['measure']}.\nReference: {entry['how']}.{uncertainty}"]
    rows = [(p["method"], p["sweep"], p["setting"], milliseconds(p["seconds"]), number(p["error"]) if p["error"] else "failed")
            for p in whole["points"] if p["scene"] == scene]
    order = list(dict.fromkeys(row[:2] for row in rows))
    rows.sort(key=lambda row: order.index(row[:2]))
    parts += ["<details><summary>all points</summary>", table(("method", "sweep", "setting", "ms", "error"), rows), "</details>"]
    return "\n\n".join(parts)


INTRODUCTION = """\
# Run time against error

Written by `tools/bench work-precision` from its own measurements; no figure here was typed. Times are processor times (user and
system) of one thread, the least of several runs, so that other work on the machine hardly matters. Each section says what the
error is and what it is measured against. "Equal error" reads both curves, drawn through the points that nothing beats,
at the same error.

What to expect: small systems whose equations somebody wrote out by hand in joint coordinates integrate faster with a high-order
adaptive method than any general program does; the price of generality and of second order is in the first figure. Nobody writes
out finite elements or a changed scene by hand: there the rival is another general library. Without damping the question is what
remains of the energy after a long time, which order alone does not answer."""


def text(whole, figures):
    libraries = ", ".join(f"{name} {version}" for name, version in whole["libraries"].items())
    machine = table(("", ""), [("processor", f"{whole['cpu']}, {whole['cores']} cores"), ("compiler", whole["compiler"]), ("flags", f"`{whole['flags']}`"),
                               ("muldi-sim", f"{whole['version']}, commit {whole['commit']}"), ("libraries", libraries)])
    methods = table(("method", "version", "all options"), [(m["method"], m["version"], m["options"]) for m in whole["methods"]])
    parts = [INTRODUCTION]
    if whole["quick"]:
        parts.append("A quick run (`--quick`): fewer points and coarser references than the committed page has.")
    parts += ["## At equal error", "\n".join(f"- {sentence}" for sentence in (*sentences(whole), *apart_sentences(whole))), "## Figures"]
    parts += [f"![{caption}]({path.name})" for caption, path in figures]
    parts += ["## The same as a table", ratio_table(whole), "## Machine and build", machine, "## Methods with all options", methods, "## Scenes"]
    parts += [scene_section(whole, scene) for scene in scenes(whole)]
    return "\n\n".join(parts) + "\n"
