#include "scene/read_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reading.hpp"

namespace muldi::scene {
namespace {

// The example of the scene format.
const std::string example =
    "title: Revolute joint with two antagonistic muscles\n"
    "materials:\n"
    "  silicone:\n"
    "    density: 1 g/cm^3\n"
    "    elastic:  {model: neo_hookean, young: 0.7 MPa, poisson: 0.5}\n"
    "    electric: {model: ideal_dielectric, relative_permittivity: 3.1}\n"
    "    viscous:  {model: kelvin_voigt, viscosity: 10 g/(ms*mm)}\n"
    "bodies:\n"
    "  pendulum:\n"
    "    mass: 40 g\n"
    "    inertia: [1.0e+5, 3.17e+5, 3.17e+5]\n"
    "    position: [46, 0, 0]\n"
    "    orientation: {axis: [0, 0, 1], angle: 0 deg}\n"
    "    points: {pivot: [-46, 0, 0], upper: [44, 15, 0], lower: [44, -15, 0]}\n"
    "joints:\n"
    "  hinge: {type: revolute, from: {body: ground, at: [0, 0, 0]}, to: {body: pendulum, at: pivot}, axis: [0, 0, 1]}\n"
    "controls: {agonist: {field: 30 kV/mm}, antagonist: {field: 0}}\n"
    "muscles:\n"
    "  upper: &muscle\n"
    "    model: lumped\n"
    "    from: {body: ground, at: [-10, 15, 0]}\n"
    "    to:   {body: pendulum, at: upper}\n"
    "    section: {shape: round, diameter: 11}\n"
    "    material: silicone\n"
    "    control: agonist\n"
    "    lumped: {inertia: consistent}\n"
    "  lower: {<<: *muscle, from: {body: ground, at: [-10, -15, 0]}, to: {body: pendulum, at: lower}, control: "
    "antagonist}\n"
    "statics:  {control: agonist, from: 0, to: 50 kV/mm, steps: 25, continuation: natural}\n"
    "dynamics: {duration: 1 s, step: 1 ms}\n";

TEST(ReadScene, ReadsTheExampleOfTheFormat) {
  const Scene scene = scene_of(example);
  EXPECT_EQ(scene.title, "Revolute joint with two antagonistic muscles");
  EXPECT_EQ(scene.materials[0].value.density, 1e-3);
  EXPECT_EQ(scene.bodies[0].value.mass, 40.0);
  EXPECT_EQ(scene.controls.find("agonist")->value.value.at(0.0), 3e4);
  EXPECT_EQ(scene.statics->to, 5e4);
  EXPECT_EQ(scene.statics->steps, 25);
  EXPECT_EQ(scene.dynamics->n_steps(), 1000);
  EXPECT_EQ(scene.solver, Solver{});
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(ReadScene, MergedMusclesDifferInWhatTheySay) {
  const Scene scene = scene_of(example);
  const Muscle& upper = scene.muscles.find("upper")->value;
  const Muscle& lower = scene.muscles.find("lower")->value;
  EXPECT_EQ(lower.section, upper.section);
  EXPECT_EQ(lower.control->name, "antagonist");
  EXPECT_EQ(lower.from->at.position, (Vec3{-10, -15, 0}));
  EXPECT_EQ(lower.to->at.position, (Vec3{44, -15, 0}));
  EXPECT_EQ(upper.to->at.position, (Vec3{44, 15, 0}));
}

TEST(ReadScene, SectionsComeInAnyOrder) {
  const std::string late_bodies =
      "joints: {j: {type: free, from: {body: ground, at: [0, 0, 0]}, to: {body: arm, at: tip}}}\n" + arm;
  EXPECT_EQ(scene_of(late_bodies).joints[0].value.to.at.position, (Vec3{1, 0, 0}));
  EXPECT_EQ(scene_of("gravity: [0, -9.81 m/s^2, 0]\nunits: {length: m, mass: kg, time: s}\n").gravity[1], -9.81);
}

TEST(ReadScene, NumbersAreInTheScenesUnits) {
  const Scene si = scene_of(example + "units: {length: m, mass: kg, time: s, current: A}\n");
  EXPECT_EQ(si.materials[0].value.density, 1000.0);
  EXPECT_EQ(si.dynamics->duration, 1.0);
  EXPECT_EQ(si.units.unit_name(base::dimension::voltage), "V");
}

TEST(ReadScene, EmptySectionsAreAllowed) { EXPECT_TRUE(scene_of("bodies:\njoints: {}\n").bodies.empty()); }

TEST(ReadScene, WarnsOfControlsWithoutUse) {
  const Scene scene = scene_of("controls: {push: {force: 1}}\n");
  EXPECT_EQ(to_string(scene.warnings), "test.yaml:2:12: warning: controls.push: nothing uses this control");
}

TEST(ReadScene, DurationsMayBeRoundedMultiples) {
  EXPECT_EQ(scene_of("dynamics: {duration: 1, step: 0.1}\n").dynamics->n_steps(), 10);
  EXPECT_EQ(scene_of("dynamics: {duration: 0.3, step: 0.1}\n").dynamics->n_steps(), 3);
  EXPECT_EQ(scene_of("dynamics: {duration: 1000 s, step: 1 us}\n").dynamics->n_steps(), 1'000'000'000);
}

TEST(ReadScene, IsolatedActuatorsHaveAnAxisAndALength) {
  const Scene scene = scene_of(
      "materials: {m: {density: 1, elastic: {model: neo_hookean, mu: 1, poisson: 0.5}}}\n"
      "muscles: {a: {model: lumped, ends: free, axis: [0, 0, 1], length: 1, section: {shape: square, edge: 20}, "
      "material: m}}\n");
  const Muscle& actuator = scene.muscles[0].value;
  EXPECT_EQ(actuator.ends, MuscleEnds::free);
  EXPECT_EQ(*actuator.axis, (Vec3{0, 0, 1}));
  EXPECT_EQ(actuator.length, 1.0);
  EXPECT_FALSE(actuator.from.has_value());
}

TEST(ReadScene, FilesAreFoundFromTheScenesFolder) {
  EXPECT_EQ(path_of_file(scene_of(""), "old/run.h5"), "old/run.h5");
  EXPECT_EQ(path_of_file(read_scene_text("muldi: 1", "a/b/test.yaml"), "old/run.h5"), "a/b/old/run.h5");
  EXPECT_EQ(path_of_file(read_scene_text("muldi: 1", "a/b/test.yaml"), "/run.h5"), "/run.h5");
}

TEST(ReadScene, BadScenesNeverCrashTheReader) {
  // Cutting a good file anywhere leaves a scene or a refusal, nothing else.
  const std::string text = "muldi: 1\n" + example;
  int n_read = 0;
  for (std::size_t length = 0; length < text.size(); length += 3) {
    try {
      read_scene_text(text.substr(0, length), "cut.yaml");
      ++n_read;
    } catch (const base::InputError& error) {
      EXPECT_FALSE(error.diagnostics().empty());
    }
  }
  EXPECT_GT(n_read, 0);
}

}  // namespace
}  // namespace muldi::scene
