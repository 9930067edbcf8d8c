#include <gtest/gtest.h>

#include "reading.hpp"

namespace muldi::scene {
namespace {

const std::string cart =
    "bodies: {cart: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 0], points: {nose: [1, 0, 0]}}}\n"
    "joints: {rail: {type: prismatic, axis: [1, 0, 0], from: {body: ground, at: [0, 0, 0]}, to: {body: cart, at: [0, "
    "0, "
    "0]}, force: {control: push}}}\n"
    "controls: {push: {force: 0}}\n";

/// The cart with these fields of the section beside those that it needs.
Scene moved_cart(const std::string& fields, const std::vector<std::string>& overrides = {}) {
  return scene_of(cart +
                      "optimal_control:\n  duration: 100\n  step: 10\n  controls: {push: {min: -1, max: 1 N}}\n"
                      "  initial: {pose: scene, momentum: rest}\n  stages: [{minimise: {effort: 1}}]\n" +
                      fields,
                  overrides);
}

TEST(OptimalControl, ReadsWhatItNeeds) {
  const Scene scene = moved_cart("");
  const OptimalControl& said = *scene.optimal_control;
  EXPECT_EQ(said.n_steps(), 10);
  EXPECT_FALSE(said.duration.is_free());
  EXPECT_EQ(said.controls[0].value.max, 1.0);
  EXPECT_EQ(said.initial.whole, WholePose::scene);
  EXPECT_EQ(said.initial.momentum->kind, EndMomentum::Kind::rest);
  EXPECT_FALSE(said.final.end.momentum);
  EXPECT_EQ(said.guess.kind, Guess::Kind::scene);
  EXPECT_EQ(said.stages[0].max_iterations, 1000);
  EXPECT_FALSE(said.replay);
}

TEST(OptimalControl, ReadsObjectivesAsWeightsAndAsMaps) {
  const Scene scene =
      moved_cart("", {"optimal_control.stages=[{minimise: {feasibility: 2, effort: {scale: 1e-3, weight: 5}}}]"});
  const Objectives& sum = scene.optimal_control->stages[0].minimise;
  EXPECT_EQ(sum.get<FeasibilityObjective>()->weight, 2.0);
  EXPECT_EQ(sum.get<EffortObjective>()->weight, 5.0);
  EXPECT_EQ(sum.get<EffortObjective>()->options.scale, 1e-3);
  EXPECT_FALSE(sum.get<RateObjective>());
}

TEST(OptimalControl, ReadsPartialPointsAndTheirBoxes) {
  const Scene scene = moved_cart(
      "  final: {points: {cart.nose: [5 mm, ~, ~]}, momentum: free}\n"
      "  limits: {joints: {rail: [~, 9]}, points: {cart.nose: [[0, ~, ~], [1 cm, ~, ~]]}}\n");
  const OptimalControl& said = *scene.optimal_control;
  const auto& nose = said.final.end.pose.points.items[0];
  EXPECT_EQ(nose.point.body.name, "cart");
  EXPECT_EQ(nose.point.point.position, (Vec3{1, 0, 0}));
  EXPECT_EQ(nose.value, (PartialPoint{5.0, {}, {}}));
  EXPECT_EQ(said.limits.joints[0].value.values[0], (Bounds{{{}, 9.0}}));
  EXPECT_EQ(said.limits.points.items[0].value[1][0], 10.0);
}

TEST(OptimalControl, ReadsGuesses) {
  const auto guess = [](const std::string& text) {
    return moved_cart("  guess: " + text + "\n").optimal_control->guess;
  };
  EXPECT_EQ(guess("zero").kind, Guess::Kind::zero);
  EXPECT_EQ(guess("{from: old.h5}").file, "old.h5");
  EXPECT_EQ(guess("{simulate: {push: 0.5}}").simulate[0].value.value.at(3.0), 0.5);
  EXPECT_EQ(guess("{random: {starts: 8, seed: 3}}").random, (RandomGuesses{.starts = 8, .seed = 3}));
}

TEST(OptimalControl, TakesANumberOfStepsWhereTheDurationIsFree) {
  const Scene scene = scene_of(cart +
                               "optimal_control: {duration: {min: 50, max: 0.1 s}, steps: 40, controls: {push: {max: "
                               "1}}, initial: {pose: scene, momentum: rest}, stages: [{minimise: {final_time: 1}}]}\n");
  EXPECT_TRUE(scene.optimal_control->duration.is_free());
  EXPECT_EQ(scene.optimal_control->duration.max, 100.0);
  EXPECT_EQ(scene.optimal_control->n_steps(), 40);
}

}  // namespace
}  // namespace muldi::scene
