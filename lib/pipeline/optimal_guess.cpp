#include "pipeline/optimal_guess.hpp"

#include <algorithm>
#include <cstdint>
#include <random>

#include "base/error.hpp"
#include "control/solve.hpp"
#include "pipeline/optimal_problem.hpp"
#include "pipeline/recorded_motion.hpp"

namespace muldi::pipeline {
namespace {

using Controls = std::vector<std::vector<double>>;

void clamp(const control::Problem& problem, Controls& u) {
  for (std::vector<double>& row : u) {
    for (const control::ControlChoice& choice : problem.controls) {
      double& value = row[static_cast<std::size_t>(choice.control)];
      value = std::clamp(value, choice.lower, choice.upper);
    }
  }
}

/// A uniform number in [0, 1): the same on every machine.
double uniform(std::mt19937_64& engine) { return static_cast<double>(engine() >> 11U) * 0x1.0p-53; }

Controls random_controls(const control::Problem& problem, double step, std::uint64_t seed) {
  Controls u = scheduled_controls(problem, step);
  std::mt19937_64 engine(seed);
  for (std::vector<double>& row : u) {
    for (const control::ControlChoice& choice : problem.controls) {
      row[static_cast<std::size_t>(choice.control)] = choice.lower + uniform(engine) * (choice.upper - choice.lower);
    }
  }
  return u;
}

Controls simulated_controls(const scene::Scene& scene, const control::Problem& problem, double step) {
  Controls u = scheduled_controls(problem, step);
  for (std::size_t i = 0; i < u.size(); ++i) {
    for (const auto& entry : scene.optimal_control->guess.simulate) {
      const auto c = static_cast<std::size_t>(scene.controls.index(entry.name));
      u[i][c] = entry.value.value.at((static_cast<double>(i) + 0.5) * step);
    }
  }
  return u;
}

/// Moves the poses along straight lines in joint coordinates to those that are given for the end.
void straighten(const control::Problem& problem, std::vector<Eigen::VectorXd>& x) {
  const model::Manifold& manifold = *problem.model.manifold;
  Eigen::VectorXd way = Eigen::VectorXd::Zero(manifold.n_v());
  if (problem.final.x) {
    manifold.difference(x.front(), *problem.final.x, way);
  } else {
    Eigen::VectorXd from(manifold.n_v());
    manifold.difference(manifold.reference(), x.front(), from);
    for (const control::CoordinateTarget& target : problem.final.coordinates) {
      if (!target.cut) way[target.rate] = target.value - from[target.rate];
    }
  }
  const Eigen::VectorXd first = x.front();
  const auto n = static_cast<double>(x.size() - 1);
  for (std::size_t i = 1; i < x.size(); ++i) manifold.retract(first, static_cast<double>(i) / n * way, x[i]);
}

}  // namespace

int n_guesses(const scene::Scene& scene) {
  const scene::Guess& guess = scene.optimal_control->guess;
  return guess.kind == scene::Guess::Kind::random ? guess.random.starts : 1;
}

control::Trajectory make_guess(const scene::Scene& scene, const build::BuiltModel& built,
                               const control::Problem& problem, int start) {
  using Kind = scene::Guess::Kind;
  const scene::Guess& guess = scene.optimal_control->guess;
  const double step = 0.5 * (problem.horizon.shortest_step + problem.horizon.longest_step);
  Controls u;
  switch (guess.kind) {
    case Kind::zero: {
      control::Trajectory rest = control::resting_guess(problem, step);
      for (std::vector<double>& row : rest.u) {
        for (const control::ControlChoice& choice : problem.controls) {
          row[static_cast<std::size_t>(choice.control)] = 0.0;
        }
      }
      clamp(problem, rest.u);
      return rest;
    }
    case Kind::scene:
    case Kind::straight: {
      control::Trajectory rest = control::resting_guess(problem, step);
      rest.u = scheduled_controls(problem, step);
      clamp(problem, rest.u);
      if (guess.kind == Kind::straight) straighten(problem, rest.x);
      return rest;
    }
    case Kind::simulate:
      return control::simulate_guess(problem, step, simulated_controls(scene, problem, step));
    case Kind::random: {
      const auto seed = static_cast<std::uint64_t>(guess.random.seed) * 1000003U + static_cast<std::uint64_t>(start);
      return control::simulate_guess(problem, step, random_controls(problem, step, seed));
    }
    case Kind::record:
      break;
  }
  try {
    const std::string path = scene::path_of_file(scene, guess.file);
    control::Trajectory found = control::refined_guess(problem, recorded_motion(scene, built, problem, path));
    clamp(problem, found.u);
    return found;
  } catch (const base::InputError& error) {
    throw base::InputError({scene::error_at(guess.origin, error.diagnostics().front().message)});
  }
}

}  // namespace muldi::pipeline
