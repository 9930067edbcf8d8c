#!/usr/bin/env python3
"""What a scene does not hold costs nothing: bench_skipped.py BUILD [--quick]. See tools/bench.

Runs each scene with and without one part, several times in turn, and compares processor time and peak memory of the whole
process, the least of all runs. Writes BUILD/skipped.json and the page tests/bench/SKIPPED.md (--quick: into the build folder)."""

import argparse
import copy
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import h5py
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[1]

# A process counts the memory of the one that it was forked from: a small one in between keeps that below what is measured.
LAUNCHER = """
import os, resource, sys
child = os.spawnv(os.P_WAIT, sys.argv[1], sys.argv[1:])
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(used.ru_utime + used.ru_stime, used.ru_maxrss)
sys.exit(child)
"""


def scene(name):
    return yaml.safe_load((ROOT / "scenes" / f"{name}.yaml").read_text(encoding="utf-8"))


def changed(given, change):
    result = copy.deepcopy(given)
    change(result)
    return result


def without_viscosity(given):
    for material in given["materials"].values():
        material.pop("viscous", None)


def hardly_viscous(given):
    """So little that the motion is that without."""
    for material in given["materials"].values():
        material["viscous"]["viscosity"] = 1e-9


def hardly_dielectric(given):
    given["materials"]["polymer"]["electric"] = {"model": "ideal_dielectric", "relative_permittivity": 1}
    given["controls"] = {"supply": {"potential": 1}}


def cube(steps):
    given = scene("cube")
    given["dynamics"]["duration"] = steps * 1e-3
    given["record"] = {"every": steps}
    return given


def drawn_cube(steps):
    """Moved by a traction, so that it moves without a voltage too."""
    given = cube(steps)
    given["solids"]["cube"]["conditions"].append({"where": {"face": "y+", "x": [None, 0]}, "traction": [0, -0.05, 0]})
    return given


def without_dielectric(given):
    given["materials"]["polymer"].pop("electric")
    given.pop("controls")
    solid = given["solids"]["cube"]
    solid.pop("electrodes")
    for condition in solid["conditions"]:
        condition.pop("potential", None)


def with_model(model):
    def change(given):
        for muscle in given["muscles"].values():
            muscle["model"] = model
        given["dynamics"]["duration"] = 200
    return change


def recording(every, fields):
    def change(given):
        given["record"] = {"every": every} | ({"fields": {"cube": ["position", "potential", "stress"]}} if fields else {})
    return change


def statics_alone(given):
    given.pop("dynamics")


def bare_numbers(given):
    """The same scene without a text that carries a unit."""
    silicone = given["materials"]["silicone"]
    silicone["density"] = 1e-3
    silicone["elastic"]["young"] = 0.7
    silicone["viscous"]["viscosity"] = 10
    given["controls"] = {"agonist": {"field": 30e3}, "antagonist": {"field": 0}}
    given["dynamics"] = {"duration": 1, "step": 1}


def short_joint():
    given = scene("revolute_joint_lumped")
    given["dynamics"]["duration"] = 1
    given.pop("statics")
    return given


def cases(build, quick):
    """(part, scene, with, without, environment of the first)."""
    steps = 20 if quick else 100
    module = build / "lib" / "control" / "libmuldi_ipopt.so"
    module = module if module.exists() else next(build.rglob("libmuldi_ipopt.so"))
    joint = short_joint()
    lumped_trunk = scene("elephant_trunk_lumped")
    boxed = scene("boxed_cube_II")
    boxed["dynamics"]["duration"] = 0.2
    drawn = drawn_cube(steps)
    twin = scene("revolute_joint_twin")
    return [
        ("viscosity", "cube, finite elements", changed(cube(steps), hardly_viscous), changed(cube(steps), without_viscosity), {}),
        ("viscosity", "trunk, lumped", changed(lumped_trunk, hardly_viscous), changed(lumped_trunk, without_viscosity), {}),
        ("unknown potentials", "cube, finite elements", changed(drawn, hardly_dielectric), changed(drawn, without_dielectric), {}),
        ("finite elements", "joint, fe against lumped muscles", changed(twin, with_model("fe")), changed(twin, with_model("lumped")), {}),
        ("fields in the file", "cube, every step", changed(cube(steps), recording(1, True)), changed(cube(steps), recording(1, False)), {}),
        ("rows in the file", "trunk, every step against every hundredth", changed(lumped_trunk, lambda g: g.update(record={"every": 1})),
         changed(lumped_trunk, lambda g: g.update(record={"every": 100})), {}),
        ("dynamics: mass, momenta, one step", "boxed cube", boxed, changed(boxed, statics_alone), {}),
        ("optimiser in memory", "joint, lumped, one step", joint, joint, {"LD_PRELOAD": str(module)}),
        ("units in texts", "joint, lumped, one step", joint, changed(joint, bare_numbers), {}),
    ]


def measure(program, given, environment, folder):
    """Processor seconds, peak MiB, size of the result in MiB and Newton iterations of one run."""
    path = folder / "scene.yaml"
    path.write_text(yaml.safe_dump(given, sort_keys=False), encoding="utf-8")
    output = folder / "out.h5"
    command = [str(program), "--quiet", "run", str(path), "-o", str(output), "--force", "--no-progress", "--no-paraview", "--threads", "1"]
    launch = [sys.executable, "-I", "-S", "-c", LAUNCHER, *command]
    done = subprocess.run(launch, env={**os.environ, **environment}, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed: {done.stderr}")
    seconds, peak = map(float, done.stdout.split()[-2:])
    with h5py.File(output, "r") as file:
        iterations = sum(int(file[path][()].sum()) for path in ("solver/iterations", "statics/solver/iterations") if path in file)
    return {"seconds": seconds, "peak": peak / 1024, "file": output.stat().st_size / 2**20, "iterations": iterations}


def count_iterations(program, given, folder):
    """Newton iterations of all steps, in a run that records every one."""
    return measure(program, changed(given, lambda g: g.update(record={"every": 1})), {}, folder)["iterations"]


def least(runs):
    return {key: min(run[key] for run in runs) for key in runs[0]}


def compare(program, case, repeats, folder):
    part, name, full, lean, environment = case
    print(f"{part}: {name} ...", file=sys.stderr, flush=True)
    # The first pair warms the file system's memory up.
    runs = [(measure(program, full, environment, folder), measure(program, lean, {}, folder)) for _ in range(repeats)]
    row = {"part": part, "scene": name, "with": least([run[0] for run in runs]), "without": least([run[1] for run in runs])}
    for which, given in (("with", full), ("without", lean)):
        row[which]["iterations"] = count_iterations(program, given, folder)
    return row


INTRODUCTION = """\
# What is skipped

Written by `tools/bench skipped` from its own measurements. The same scene with and without one part, in turn on one thread:
processor time and peak memory of the whole process, from its start to the closed file, the least of {repeats} runs. Where a
viscosity or a voltage is present it is so small that the system moves as without it.

That the absent parts are truly absent is asserted by `tests/unit/app/test_skipped.py` and `tests/unit/app/test_record.py`: no
page of the optimiser's library mapped, no unknown potential, no viscous term, no mass in statics, no finite element, no unit
system, no group in the file."""


def cell(value, digits=3):
    return f"{value:.{digits}g}"


def page(report):
    head = ("part", "scene", "ms with", "ms without", "time", "iterations with", "without", "MiB with", "without", "memory", "file, MiB with", "without")
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    for row in report["rows"]:
        full, lean = row["with"], row["without"]
        cells = (row["part"], row["scene"], cell(1e3 * full["seconds"]), cell(1e3 * lean["seconds"]), f"{full['seconds'] / lean['seconds']:.2f} x",
                 str(full["iterations"]), str(lean["iterations"]), cell(full["peak"]), cell(lean["peak"]), f"{full['peak'] / lean['peak']:.2f} x",
                 f"{full['file']:.2f}", f"{lean['file']:.2f}")
        lines.append("| " + " | ".join(cells) + " |")
    return "\n\n".join([INTRODUCTION.format(repeats=report["repeats"]), "\n".join(lines),
                        "`time` and `memory`: with the part over without it.", report["machine"]]) + "\n"


def machine(program):
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        cpu = next((line.split(": ", 1)[1].strip() for line in file if line.startswith("model name")), "unknown processor")
    version = subprocess.run([str(program), "--version"], capture_output=True, text=True, check=True).stdout.strip()
    return f"On {cpu}, {os.cpu_count()} cores:\n\n```\n{version}\n```"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    given = parser.parse_args()
    build = given.build.resolve()
    program = build / "app" / "muldi-sim"
    repeats = 2 if given.quick else 7
    with tempfile.TemporaryDirectory() as folder:
        rows = [compare(program, case, repeats, pathlib.Path(folder)) for case in cases(build, given.quick)]
    report = {"machine": machine(program), "repeats": repeats, "rows": rows}
    (build / "skipped.json").write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")
    target = (build if given.quick else ROOT / "tests" / "bench") / "SKIPPED.md"
    target.write_text(page(report), encoding="utf-8")
    print(page(report))
    print(f"written: {build / 'skipped.json'}, {target}", file=sys.stderr)


if __name__ == "__main__":
    main()
