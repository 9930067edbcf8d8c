"""report.py -o PAGE FILE: one page about a result, without any network; called by `muldi-sim report`, which gives the drawing of the scene as
JSON on standard input."""

import argparse
import html
import json
import pathlib
import sys

import guarded
from page import card, document, head_card, inline_svg, list_of, table

HERE = pathlib.Path(__file__).resolve().parent
THREE = ("three.min.js", "examples/js/controls/OrbitControls.js")
THREE_FOLDERS = ("/usr/share/javascript/three", "/usr/share/nodejs/three")
REPORT_KINDS = ("joints", "points", "probes", "muscles", "controls", "energy", "momentum", "optimum", "solver")
MAX_SCENE = 60_000  # characters of the scene that are shown


def script(text):
    """JavaScript or JSON that may stand inside a page."""
    return text.replace("</", "<\\/")


def three():
    """The text of the library of the view."""
    for folder in THREE_FOLDERS:
        files = [pathlib.Path(folder) / name for name in THREE]
        if all(file.is_file() for file in files):
            return "\n".join(file.read_text(encoding="utf-8") for file in files)
    return guarded.fail(
        guarded.ENVIRONMENT_FAILED, "report needs the library three.js; as root: apt-get install libjs-three (tools/run report does it by itself)"
    )


def plots(result):
    import curves

    parts, number = [], 0
    for kind in REPORT_KINDS:
        panels = curves.panels_of([result], kind)
        drawn = []
        for panel in panels:
            number += 1
            drawn.append(inline_svg(panel, number))
        if drawn:
            parts.append(f'<h3>{kind.capitalize()}</h3><div class="plots">{"".join(drawn)}</div>')
    return "".join(parts)


def ledger(result):
    import tables

    parts = []
    for series in result.series:
        rows, unit = tables.ledger_of(series)
        if rows:
            heads = (f"energy ({unit})", "first", "last", "least", "largest", "meaning")
            cells = [(name, *(tables.number(value) for value in values), doc) for name, *values, doc in rows]
            title = f"<h3>{series.name.capitalize()}</h3>" if len(result.series) > 1 else ""
            parts.append(title + table(heads, cells, words=(5,), last="total" if series.is_statics else "balance"))
    return "".join(parts)


def solver(result):
    import tables

    parts = []
    for series in result.series:
        cells = [(name, tables.number(mean), tables.number(largest), "" if total is None else str(total), doc) for name, mean, largest, total, doc in tables.solver_rows(series)]
        if cells:
            title = f"<h3>{series.name.capitalize()}, {len(series.x)} rows</h3>"
            parts.append(title + table(("", "mean", "largest", "sum", "meaning"), cells, words=(4,)))
    times = tables.wall_times(result)
    if times:
        parts.append("<h3>Wall time</h3>" + table([name for name, _ in times], [[f"{seconds:.3g} s" for _, seconds in times]]))
    return "".join(parts)


VIEW = """<div id="view"><div id="bar"><div id="quantity"></div><div class="scale"></div><div class="ends"><span id="low"></span><span id="high"></span></div></div></div>
<div class="tools"><button id="play" type="button">&#9654; Play</button><input id="slider" type="range" min="0" value="0" aria-label="frame"><span id="time"></span></div>
<div class="tools"><label id="series-choice">Show <select id="series"></select></label><label id="colouring">Colour by <select id="colour"></select></label>
<label>Speed <select id="speed"><option value="0.25">1/4</option><option value="0.5">1/2</option><option value="1" selected>1</option><option value="2">2</option><option value="4">4</option></select></label>
<label id="mesh-choice"><input id="mesh" type="checkbox" checked> mesh lines</label><button id="reset" type="button">Reset view</button>
<span style="color:var(--soft)">drag: turn, wheel: zoom, right button: move</span></div>"""


def view(result, drawing):
    """The card of the view and the scripts that it needs; nothing where nothing moves."""
    import view as moving

    views = moving.views_of(result, drawing)
    if not views:
        return "", ""
    content = script(json.dumps(views, separators=(",", ":")))
    scripts = f'<script type="application/json" id="views">{content}</script><script>{script(three())}</script><script>{(HERE / "view.js").read_text(encoding="utf-8")}</script>'
    return card("Animated view", VIEW), scripts


def page(result, drawing):
    import tables

    title = result.text("title") or result.path.stem
    status, kind, sentence = tables.status_of(result)
    warnings = tables.warnings_of(result)
    shown, scripts = view(result, drawing)
    scene = result.text("scene")
    cut = "" if len(scene) <= MAX_SCENE else f"\n... {len(scene) - MAX_SCENE} more characters"
    origin = ", ".join(result.text(name) for name in ("created", "compiler") if result.text(name))
    sections = [
        head_card(title, status, kind, sentence, tables.facts_of(result)),
        card("Warnings", list_of(warnings), "warnings", "warnings") if warnings else "",
        shown,
        card("Curves", plots(result), name="curves"),
        card("Energy ledger", ledger(result), name="energy"),
        card("Solver", solver(result), name="solver"),
        f'<section class="card"><details><summary>The scene, with every default</summary><pre>{html.escape(scene[:MAX_SCENE] + cut)}</pre></details></section>',
        f"<footer>{html.escape(str(result.path.name))}, made by muldi-sim {html.escape(result.text('muldi_version'))} ({html.escape(result.text('git_hash')[:12])}), {html.escape(origin)}<br><code>{html.escape(result.text('command_line'))}</code></footer>",
    ]
    return document(title, "".join(sections), scripts)


def main():
    parser = argparse.ArgumentParser(prog="muldi-sim report")
    parser.add_argument("-o", dest="output", required=True)
    parser.add_argument("file")
    arguments = parser.parse_args()
    drawing = json.loads("" if sys.stdin.isatty() else sys.stdin.read() or "{}")

    import result

    import studies

    (opened,) = result.open_all([arguments.file])
    if studies.kind_of(opened):
        import study_report

        pathlib.Path(arguments.output).write_text(study_report.page(opened), encoding="utf-8")
        return
    if not opened.series:
        raise result.WrongInput(f"'{arguments.file}' holds no rows yet")
    for series in opened.series:
        series.label = series.name  # of one file: what differs is what was computed
    pathlib.Path(arguments.output).write_text(page(opened, drawing), encoding="utf-8")


if __name__ == "__main__":
    guarded.run("report", main)
