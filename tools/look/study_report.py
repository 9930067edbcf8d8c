"""The pages of sweeps and calibrations."""

import collections
import html
import math

import studies
import tables
from page import card, document, head_card, inline_svg, list_of, table

MAX_ROWS = 500  # of a table; the CSV file holds all


def plots(panels):
    return '<div class="plots">' + "".join(inline_svg(panel, number) for number, panel in enumerate(panels)) + "</div>"


def footer(result):
    return f"<footer>{html.escape(result.path.name)}, made by muldi-sim {html.escape(result.text('muldi_version'))} from {html.escape(result.text('study'))}</footer>"


def count(n, noun):
    return str(n), noun if n == 1 else noun + "s"


def head_of(column):
    unit = "" if column.unit in ("", "1") else f" ({column.unit})"
    return column.name + unit


def extremes(sweep):
    """The table of the outputs: where they are least and largest."""
    rows = []
    for output in sweep.outputs:
        found = [i for i, value in enumerate(output.values) if math.isfinite(value)]
        if not found:
            rows.append((head_of(output), "-", "-", "-", "-"))
            continue
        least, largest = min(found, key=lambda i: output.values[i]), max(found, key=lambda i: output.values[i])
        at = [", ".join(f"{key.name} {key.text(key.values[i])}" for key in sweep.varied) for i in (least, largest)]
        rows.append((head_of(output), tables.number(output.values[least]), at[0], tables.number(output.values[largest]), at[1]))
    return table(("output", "least", "at", "largest", "at"), rows, words=(2, 4))


def points(sweep):
    columns = sweep.keys + sweep.outputs
    rows = []
    for i in range(min(sweep.n_points, MAX_ROWS)):
        cells = [column.words[int(column.values[i])] if column.words else tables.number(column.values[i]) for column in columns]
        rows.append((i, *cells, sweep.status[i].replace("_", " ")))
    cut = "" if sweep.n_points <= MAX_ROWS else f"<p>and {sweep.n_points - MAX_ROWS} more in the CSV file</p>"
    heads = ("point", *(head_of(column) for column in columns), "status")
    return f"<details{' open' if sweep.n_points <= 40 else ''}><summary>{sweep.n_points} points</summary>{table(heads, rows)}{cut}</details>"


def sweep_page(result):
    sweep = studies.Sweep(result)
    failed = collections.Counter(status for status in sweep.status if status != "completed")
    n_failed = sum(failed.values())
    title = f"Sweep {result.text('study')}"
    kind, status = ("stopped", "failed") if n_failed == sweep.n_points else ("open", "with failures") if n_failed else ("", "completed")
    sentence = "Every point came to its end." if not n_failed else f"{n_failed} of {sweep.n_points} points have no result."
    facts = [count(sweep.n_points, "point"), count(len(sweep.varied), "varied key"), count(len(sweep.outputs), "output")]
    warnings = [f"{n} {'point' if n == 1 else 'points'}: {status}. {tables.SENTENCES.get(status, '')}".strip() for status, n in failed.items()]
    keys = [(key.name, key.full, len(key.distinct()), key.text(key.values.min()), key.text(key.values.max())) for key in sweep.keys]
    return document(
        title,
        "".join(
            (
                head_card(title, status, kind, sentence, facts),
                card("Warnings", list_of(warnings), "warnings", "warnings") if warnings else "",
                card("Curves", plots(studies.sweep_panels(sweep)), name="curves"),
                card("Keys", table(("", "key of the scene", "values", "first", "last"), keys, words=(1,)), name="keys"),
                card("Outputs", extremes(sweep), name="outputs"),
                card("Points", points(sweep), name="points"),
                footer(result),
            )
        ),
    )


def interval_text(half_width):
    return "not determined" if math.isinf(half_width) else "-" if math.isnan(half_width) else f"{half_width:.2g}"


def parameters(result):
    rows = [
        (interval.name, tables.number(interval.start), f"{interval.value:.7g}", interval_text(interval.half_width), tables.number(interval.lower), tables.number(interval.upper), "" if interval.unit == "1" else interval.unit)
        for interval in studies.intervals_of(result)
    ]
    return table(("parameter", "start", "fitted", "\u00b1 (95 %)", "lower bound", "upper bound", "unit"), rows)


def rms(values):
    return math.sqrt(float((values**2).mean()))


def residuals(result):
    rows = []
    for name, _, _, x, values, unit in studies.compared_of(result):
        before, after = (values[what] - values["reference"] for what in ("before", "after"))
        cells = (rms(before), rms(after), abs(before).max(), abs(after).max())
        rows.append((name, len(x), *(tables.number(cell) for cell in cells), "" if unit == "1" else unit))
    return table(("compared", "rows", "rms before", "rms after", "largest before", "largest after", "unit"), rows)


def calibration_page(result):
    title = f"Calibration {result.text('study')}"
    status = result.text("status")
    kind = "" if status == "completed" else "open" if status == "interrupted" else "stopped"
    iterations = int(result.attributes()["iterations"])
    sentence = f"{'Converged' if status == 'completed' else 'Stopped'} after {iterations} {'iteration' if iterations == 1 else 'iterations'}."
    warnings = [text for text in result.text("warnings").split("\n") if text]
    names = result.names("parameters")
    facts = [count(len(names), "parameter"), count(len(result.names("curves")), "compared curve")]
    if "singular_values" in result:
        values = result.values("singular_values")
        facts.append((tables.number(values.min()), "least singular value of the relative sensitivities (largest 1)"))
    return document(
        title,
        "".join(
            (
                head_card(title, status, kind, sentence, facts),
                card("Warnings", list_of(text[:1].upper() + text[1:] + "." for text in warnings), "warnings", "warnings") if warnings else "",
                card("Parameters", parameters(result), name="parameters"),
                card("Differences", residuals(result), name="differences"),
                card("Curves", plots(studies.calibration_panels(result)), name="curves"),
                footer(result),
            )
        ),
    )


def page(result):
    return sweep_page(result) if studies.kind_of(result) == "sweep" else calibration_page(result)
