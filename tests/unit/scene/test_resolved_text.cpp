#include <gtest/gtest.h>

#include "reading.hpp"

namespace muldi::scene {
namespace {

/// Something of everything.
const std::string rich =
    "title: \"all: kinds\\n of # text\"\n"
    "units: {length: m, mass: kg, time: s, current: A}\n"
    "gravity: [0, -9.81, 0]\n"
    "materials:\n"
    "  silicone:\n"
    "    density: 1 g/cm^3\n"
    "    elastic: {model: neo_hookean, young: 0.7 MPa, poisson: 0.5}\n"
    "    electric: {model: ideal_dielectric, relative_permittivity: 3.1}\n"
    "    viscous: {model: kelvin_voigt, viscosity: 10 g/(ms*mm)}\n"
    "  other:\n"
    "    density: 1\n"
    "    elastic: {model: neo_hookean, mu: 1, kappa: 10}\n"
    "    electric: {model: invariants, c1: 1e-12, c2: -1e-12, c3: 0}\n"
    "bodies:\n"
    "  a: {mass: 1, inertia: [1, 1, 1], position: [0.1, 0, 0], orientation: {euler: [10 deg, 20 deg, 30 deg]}, points: "
    "{p: [1, 0, 0]}}\n"
    "  b: {mass: 2, inertia: [[2, 0.1, 0], [0.1, 2, 0], [0, 0, 2]], place: {joint: ball}}\n"
    "joints:\n"
    "  ball: {type: spherical, from: {body: a, at: p}, to: {body: b, at: [0, 0, 0]}, frame: from, stiffness: 2}\n"
    "  rail: {type: cylindrical, from: {body: ground, at: [0, 0, 0]}, to: {body: a, at: p}, axis: [1, 0, 0],\n"
    "         force: {control: push}, torque: {ramp: {to: 3, over: 1}}, stops: [{range: [0, 1], stiffness: 3}, ~]}\n"
    "controls:\n"
    "  push: {force: {sine: {amplitude: 1, frequency: 2, phase: 30 deg}}}\n"
    "  e: {field: {expression: 1+t, unit: kV/mm}}\n"
    "  u: {layer_voltage: {steps: [[0, 1], [2, 3]]}}\n"
    "  v: {total_voltage: {table: [[0, 1], [2, 3]]}}\n"
    "muscles:\n"
    "  m: {model: lumped, from: {body: a, at: p}, to: {body: ground, at: [0, 0, 0]}, section: {shape: square, edge: "
    "3},\n"
    "      material: silicone, control: u, layer_thickness: 10 um, rest_length: 2, lumped: {inertia: thesis, mu: 3}}\n"
    "  free: {model: lumped, ends: free, axis: [0, 0, 1], length: 1, section: {shape: round, diameter: 3}, material: "
    "other,\n"
    "         control: v}\n"
    "  third: {model: lumped, from: {body: a, at: p}, to: {body: ground, at: [0, 0, 1]}, section: {shape: square, "
    "edge: 3},\n"
    "      material: silicone, control: e}\n"
    "springs: {s: {from: {body: a, at: p}, to: {body: ground, at: [0, 0, 0]}, stiffness: 2, rest_length: 10, damping: "
    "0.1}}\n"
    "loads:\n"
    "  l: {body: a, at: p, force: [1, 0, 0], control: push}\n"
    "  t: {body: a, torque: [1, 0, 0], magnitude: 3, frame: body}\n"
    "initial: {from: old/run.h5, joints: {ball: {position: [1, 2, 3]}}, bodies: {a: {velocity: [1, 0, 0]}}, momentum: "
    "{rail: [1, 2]}}\n"
    "statics: {control: e, to: 50 kV/mm, steps: 25, continuation: arc_length}\n"
    "dynamics: {duration: 1, step: 1 ms}\n"
    "optimal_control:\n"
    "  duration: 2\n"
    "  steps: 20\n"
    "  controls: {push: {min: -1}, e: {max: 50 kV/mm}}\n"
    "  initial: {joints: {rail: [0, ~], ball: [1, 2, 3]}, momentum: {rail: [1, 2]}}\n"
    "  final: {bodies: {a: {position: [0, ~, 1]}}, points: {a.p: [~, 1, 2]}, orientations: {b: {euler: [1, 2, 3]}},\n"
    "          velocity: {rail: [~, 3]}, equilibrium: {push: 1, e: 2}}\n"
    "  limits: {joints: {rail: [[0, 1], ~]}, points: {a.p: [[~, 0, ~], [~, ~, 3]]}, true_field: 80 kV/mm, "
    "pull_in_margin: 0.1}\n"
    "  guess: {simulate: {push: {sine: {amplitude: 1, frequency: 2}}, e: 30 kV/mm}}\n"
    "  stages:\n"
    "    - {minimise: {feasibility: 1}, max_iterations: 7}\n"
    "    - {minimise: {effort: {scale: 1e-14}, rate: 0.1, peak_field: 3, kinetic_energy: 4,\n"
    "                  tracking: {joints: {rail: [{table: [[0, 1], [1, 2]]}, ~]}, points: {a.p: [1, ~, {ramp: {to: 3, "
    "over: 1}}]}},\n"
    "                  terminal: {joints: {rail: [1, ~]}, points: {a.p: [~, 1, ~]}}}}\n"
    "  replay: {step: 1 ms, muscles: lumped, interpolation: linear, then: {duration: 800 ms, controls: {e: 30 "
    "kV/mm}}}\n"
    "record: {every: 10, points: [a.p]}\n"
    "solver: {tolerance: 1e-9, max_iterations: 7, linear: tree}\n";

TEST(ResolvedText, OfAFreeDurationReadsBackEqual) {
  std::string text = rich;
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("duration: 2\n", "duration: {min: 1, max: 2}\n");
  replace("rate: 0.1,", "rate: 0.1, final_time: {weight: 2},");
  text.erase(text.find("tracking:"), text.find("terminal:") - text.find("tracking:"));
  const Scene scene = scene_of(text);
  EXPECT_TRUE(read_scene_text(resolved_text(scene), "resolved.yaml") == scene);
}

TEST(ResolvedText, ReadsBackEqual) {
  const Scene scene = scene_of(rich);
  const std::string text = resolved_text(scene);
  const Scene again = read_scene_text(text, "resolved.yaml");
  EXPECT_TRUE(again == scene) << text;
  EXPECT_EQ(resolved_text(again), text);
}

TEST(ResolvedText, WritesEveryDefault) {
  EXPECT_EQ(resolved_text(scene_of("dynamics: {duration: 1 s, step: 1}\n")),
            "muldi: 1\n"
            "units: {length: \"mm\", mass: \"g\", time: \"ms\", current: \"A\"}\n"
            "gravity: [0, 0, 0]\n"
            "initial: {from: scene}\n"
            "dynamics: {duration: 1000, step: 1, integrator: midpoint}\n"
            "record: {every: 1}\n"
            "solver: {tolerance: 1.0e-10, max_iterations: 30, linear: auto}\n");
}

TEST(ResolvedText, HoldsOverrides) {
  const Scene scene = scene_of("dynamics: {duration: 1 s, step: 1}\n", {"dynamics.step=2", "title=other"});
  EXPECT_EQ(read_scene_text(resolved_text(scene), "r"), scene);
}

TEST(Scenes, CompareByContentNotByPlace) {
  EXPECT_EQ(scene_of(arm), scene_of("\n\n# later\n" + arm));
  EXPECT_NE(scene_of(arm), scene_of(arm, {"bodies.arm.mass=2"}));
}

}  // namespace
}  // namespace muldi::scene
