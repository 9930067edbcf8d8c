#!/usr/bin/env python3
"""Runs the benchmark programs of a build folder and collects their JSON: bench_table.py BUILD [--page] [PATTERN...]. See tools/bench."""

import json
import os
import pathlib
import subprocess
import sys
import time


def run(program, build):
    """The report of one program; None if it failed."""
    print(f"{program.name} ...", file=sys.stderr, flush=True)
    start = time.monotonic()
    # A process counts the memory of the one that it was forked from: a small one in between keeps that below what is measured.
    done = subprocess.run(["/bin/sh", "-c", '"$0"; exit $?', str(program)], cwd=build, stdout=subprocess.PIPE, text=True)
    try:
        report = json.loads(done.stdout) if done.returncode == 0 else None
    except json.JSONDecodeError:
        report = None
    if report is None:
        print(f"{program.name} failed (exit code {done.returncode})", file=sys.stderr)
        return None
    report["wall_seconds"] = time.monotonic() - start
    return report


def rows(report):
    for value in report["values"]:
        bound = value.get("bound")
        aim = value.get("aim")
        number = float("inf") if value["value"] is None else value["value"]
        verdict = "" if bound is None else "OVER" if number > bound else "within" if aim is None or number > aim else "within, and the aim"
        figure = "nan" if value["value"] is None else f"{value['value']:.4g}"
        yield report["name"], value["name"], figure, value["unit"], "" if bound is None else f"{bound:.4g}", "" if aim is None else f"{aim:.4g}", verdict


def page(reports):
    """The figures that the project asks for first, then all others, as Markdown."""
    first = reports[0]
    text = [
        "# Speed",
        "",
        "Written by `tools/bench --page` from its own measurements; do not edit. Times hold for a machine with nothing else to do. Ratios",
        "are taken in one run: to the peer in deal.II ([its source](peer_dealii.cpp)), to a second thread, to another formulation, to what",
        "the machine's own peak of fused operations or its triad would take.",
        "",
        f"{first['cpu']}, {first['cores']} cores; {first['compiler']}; `{first['flags']}`; commit {first['commit']}.",
        "",
        "| program | figure | value | unit | must | aim | |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    table = [row for report in reports for row in rows(report)]
    text += ["| " + " | ".join(row) + " |" for row in table if row[4]]
    text += ["", "## Figures without a bound", "", "| program | figure | value | unit |", "| --- | --- | --- | --- |"]
    text += ["| " + " | ".join(row[:4]) + " |" for row in table if not row[4]]
    return "\n".join(text) + "\n"


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    patterns = [word for word in sys.argv[2:] if word != "--page"]
    programs = [path for path in sorted((build / "bench").glob("bench_*")) if path.is_file() and os.access(path, os.X_OK)]
    # Those of `bench work-precision` have curves, not figures.
    programs = [path for path in programs if not path.name.startswith("bench_work_")]
    chosen = [path for path in programs if not patterns or any(pattern in path.name for pattern in patterns)]
    if not chosen:
        print("no such benchmark; there are: " + ", ".join(path.name for path in programs), file=sys.stderr)
        return 2
    reports = [run(program, build) for program in chosen]
    good = [report for report in reports if report]
    (build / "bench.json").write_text(json.dumps(good, indent=2) + "\n")
    if good:
        first = good[0]
        print(f"{first['cpu']}, {first['cores']} cores; {first['compiler']} {first['flags']}; commit {first['commit']}")
        table = [("program", "figure", "value", "unit", "bound", "aim", "")] + [row for report in good for row in rows(report)]
        widths = [max(len(row[column]) for row in table) for column in range(7)]
        for row in table:
            print("  ".join(cell.rjust(width) if column in (2, 4, 5) else cell.ljust(width)
                            for column, (cell, width) in enumerate(zip(row, widths))).rstrip())
        if "--page" in sys.argv and len(good) == len(programs):
            (pathlib.Path(__file__).resolve().parent.parent / "tests" / "bench" / "SPEED.md").write_text(page(good))
    print(f"written: {build / 'bench.json'}", file=sys.stderr)
    return 0 if len(good) == len(reports) else 1


if __name__ == "__main__":
    sys.exit(main())
