#!/usr/bin/env python3
"""Run time against error: bench_work_precision.py BUILD [--quick | --again]. See tools/bench.

Runs the programs bench_work_* of a build folder, writes BUILD/work_precision.json, and from it the page
tests/bench/WORK_PRECISION.md with its figures; --quick writes the page into the build folder instead, --again writes it anew from the
JSON of the last run."""

import argparse
import json
import pathlib
import subprocess
import sys
import time

import bench_page
import bench_plots

ROOT = pathlib.Path(__file__).resolve().parents[1]
PROGRAMS = ("work_multibody", "work_solids", "work_optimal_control")
ORIGIN = ("cpu", "cores", "compiler", "flags", "version", "commit", "libraries")


def run(build, name, arguments):
    program = build / "bench" / f"bench_{name}"
    print(f"bench_{name} ...", file=sys.stderr, flush=True)
    start = time.monotonic()
    done = subprocess.run([str(program), *arguments], cwd=build, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"bench_{name} failed (exit code {done.returncode})")
    report = json.loads(done.stdout)
    print(f"  {time.monotonic() - start:.0f} s", file=sys.stderr)
    return report


def collected(reports):
    """All reports as one: the origin once, methods, references and points of all."""
    whole = {key: reports[0][key] for key in ORIGIN}
    methods = {}
    for report in reports:
        for method in report["methods"]:
            # One name, several programs: the options of each.
            methods.setdefault((method["method"], method["options"]), method | {"program": report["name"]})
    whole["methods"] = list(methods.values())
    whole["references"] = [reference for report in reports for reference in report["references"]]
    whole["points"] = [point | {"program": report["name"]} for report in reports for point in report["points"]]
    return whole


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--again", action="store_true")
    given = parser.parse_args()
    build = given.build.resolve()
    data = build / "work_precision.json"
    if given.again:
        whole = json.loads(data.read_text(encoding="utf-8"))
    else:
        whole = collected([run(build, name, ["--quick"] if given.quick else []) for name in PROGRAMS]) | {"quick": given.quick}
    whole["ratios"] = bench_page.ratios(whole)
    data.write_text(json.dumps(whole, indent=1) + "\n", encoding="utf-8")
    folder = build / "work_precision" if whole["quick"] else ROOT / "tests" / "bench"
    folder.mkdir(exist_ok=True)
    figures = bench_plots.write(whole, folder)
    page = folder / "WORK_PRECISION.md"
    page.write_text(bench_page.text(whole, figures), encoding="utf-8")
    print(bench_page.summary(whole))
    print(f"written: {data}, {page}", file=sys.stderr)


if __name__ == "__main__":
    main()
