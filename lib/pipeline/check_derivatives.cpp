#include "pipeline/check_derivatives.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"
#include "build/solid_checks.hpp"
#include "control/solve.hpp"
#include "math/check_numbers.hpp"
#include "pipeline/checked_line.hpp"
#include "pipeline/initial_state.hpp"
#include "pipeline/optimal_guess.hpp"
#include "pipeline/optimal_problem.hpp"

namespace muldi::pipeline {
namespace {

constexpr double shift = 2e-4;  // of the size of the scene: small beside the ranges of stops and cables

scene::Named<scene::ControlBounds> bounds_of(const scene::Scene& scene) {
  return scene.optimal_control ? scene.optimal_control->controls : scene::Named<scene::ControlBounds>{};
}

/// A point near the start, in general position.
class ModelCheck {
 public:
  ModelCheck(const scene::Scene& scene, const build::BuiltModel& built)
      : model_(*built.model), manifold_(*built.manifold), built_(built), start_(starting_point(scene, built)) {
    dt_ = scene.dynamics          ? scene.dynamics->step
          : scene.optimal_control ? scene.optimal_control->duration.max / scene.optimal_control->n_steps()
                                  : 1e-3 / scene.units.si(base::dimension::time);
    const Eigen::VectorXd scale = manifold_.rate_scale();
    const auto near = [&](const Eigen::VectorXd& from, Eigen::VectorXd& x, Eigen::VectorXd& q) {
      x = from;
      manifold_.retract(from, 0.01 * numbers_.vector(manifold_.n_v()).cwiseProduct(scale), x);
      q = start_.q;
      manifold_.configuration(x, q);
    };
    near(start_.x, x0_, q0_);
    near(x0_, x1_, q1_);
    y_ = start_.y;
    u_.resize(model_.controls.size());
    model_.evaluate_controls(0.5 * dt_, u_);
    // A control at zero hides what is multiplied by it.
    for (const double u : u_) largest_control_ = std::max(largest_control_, std::abs(u));
    const scene::Named<scene::ControlBounds> sought = bounds_of(scene);
    for (const scene::Entry<scene::ControlBounds>& bounds : sought) {
      if (bounds.value.max) largest_control_ = std::max(largest_control_, std::abs(*bounds.value.max));
    }
    for (double& u : u_) u += 0.3 * largest_control_ * numbers_.next();
    q_ = 0.5 * (q0_ + q1_);
    v_ = (q1_ - q0_) / dt_;
    size_ = 1.0;
    for (const double length : scale) size_ = std::max(size_, length);
  }

  std::vector<CheckedDerivative> run() {
    for (const auto& term : model_.terms) check(*term);
    for (const auto& part : model_.substructures) check_energies(*part, name_of(*part));
    std::vector<std::string> names;
    names.reserve(u_.size());
    for (const model::Control& control : model_.controls) names.push_back(control.name);
    build::check_solids(built_, {.q = start_.q, .y = start_.y, .u = u_, .control_names = names, .dt = dt_},
                        [&](const std::string& of, const auto& f, const Eigen::VectorXd& given) {
                          found_.push_back(checked_line(of, f, given));
                        });
    return std::move(found_);
  }

 private:
  static std::string name_of(const model::IntervalTerm& term) {
    const std::vector<std::string> parts = term.parts();
    if (parts.empty()) return "loads";
    return parts.size() == 1 ? parts[0] : base::format("{} and {} more", parts[0], parts.size() - 1);
  }

  /// Forces of one term at the midpoint q with the mean velocity v.
  model::IntervalForces forces(const model::IntervalTerm& term, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                               const std::vector<double>& u) const {
    model::IntervalForces out{.force = Eigen::VectorXd::Zero(model_.n_q()),
                              .momentum = Eigen::VectorXd::Zero(model_.n_q()),
                              .begin = Eigen::VectorXd::Zero(model_.n_q()),
                              .end = Eigen::VectorXd::Zero(model_.n_q()),
                              .stage = Eigen::VectorXd::Zero(model_.n_y()),
                              .on_rates = Eigen::VectorXd::Zero(manifold_.n_v())};
    const Eigen::VectorXd q0 = q - 0.5 * dt_ * v;
    const Eigen::VectorXd q1 = q + 0.5 * dt_ * v;
    term.add_forces(point(q0, q1, q, v, u), out);
    return out;
  }
  model::IntervalPoint point(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, const Eigen::VectorXd& q,
                             const Eigen::VectorXd& v, std::span<const double> u) const {
    return {.q0 = q0,
            .q1 = q1,
            .q = q,
            .v = v,
            .u = u,
            .dt = dt_,
            .x0 = {x0_.data(), static_cast<std::size_t>(x0_.size())},
            .x1 = {x1_.data(), static_cast<std::size_t>(x1_.size())},
            .y = &y_};
  }

  void check(const model::IntervalTerm& term) {
    const std::string name = name_of(term);
    if (term.acts_at_ends()) {
      check_step(term, name);
    } else {
      check_tangents(term, name);
    }
    check_controls(term, name);
    check_rates(term, name);
    check_energies(term, name);
  }

  void check_tangents(const model::IntervalTerm& term, const std::string& name) {
    struct Case {
      const char* what;
      model::TangentWeights weights;
      bool of_force, by_velocity;
    };
    const Case cases[] = {{"momentum by velocity", {.vv = 1.0}, false, true},
                          {"momentum by configuration", {.vq = 1.0}, false, false},
                          {"force by velocity", {.qv = 1.0}, true, true},
                          {"force by configuration", {.qq = 1.0}, true, false}};
    const Eigen::VectorXd direction = numbers_.vector(model_.n_q());
    for (const Case& one : cases) {
      math::BlockMatrix K(*model_.pattern);
      K.set_zero();
      term.add_tangent(point(q0_, q1_, q_, v_, u_), one.weights, K);
      const double step = one.by_velocity ? shift * size_ / dt_ : shift * size_;
      const Eigen::VectorXd d = step * direction;
      Eigen::VectorXd given = Eigen::VectorXd::Zero(model_.n_q());
      K.multiply(d, given);
      const auto f = [&](double s) -> Eigen::VectorXd {
        const Eigen::VectorXd moved = (one.by_velocity ? v_ : q_) + s * d;
        const model::IntervalForces at = one.by_velocity ? forces(term, q_, moved, u_) : forces(term, moved, v_, u_);
        return one.of_force ? at.force : at.momentum;
      };
      found_.push_back(checked_line(name + ": " + one.what, f, given));
    }
  }

  /// The Newton matrix of a step, for terms that act at its ends.
  void check_step(const model::IntervalTerm& term, const std::string& name) {
    const Eigen::VectorXd d = shift * size_ * numbers_.vector(model_.n_q());
    math::BlockMatrix K(*model_.pattern);
    K.set_zero();
    term.add_tangent(point(q0_, q1_, q_, v_, u_), model::TangentWeights::step(dt_), K);
    Eigen::VectorXd given = Eigen::VectorXd::Zero(model_.n_q());
    K.multiply(d, given);
    const auto f = [&](double s) -> Eigen::VectorXd {
      const Eigen::VectorXd q1 = q1_ + s * d;
      const model::IntervalForces at = forces(term, 0.5 * (q0_ + q1), (q1 - q0_) / dt_, u_);
      return at.momentum - 0.5 * dt_ * at.force - at.begin;
    };
    found_.push_back(checked_line(name + ": balance of a step by its end", f, given));
  }

  void check_controls(const model::IntervalTerm& term, const std::string& name) {
    for (std::size_t c = 0; c < u_.size(); ++c) {
      const double step = 0.1 * largest_control_;
      Eigen::VectorXd given = Eigen::VectorXd::Zero(model_.n_q());
      Eigen::VectorXd on_rates = Eigen::VectorXd::Zero(manifold_.n_v());
      term.add_control_force(point(q0_, q1_, q_, v_, u_), static_cast<int>(c), given);
      term.add_control_force_on_rates(point(q0_, q1_, q_, v_, u_), static_cast<int>(c), on_rates);
      Eigen::VectorXd both(given.size() + on_rates.size());
      both << step * given, step * on_rates;
      const auto f = [&](double s) -> Eigen::VectorXd {
        std::vector<double> u = u_;
        u[c] += s * step;
        const model::IntervalForces at = forces(term, q_, v_, u);
        Eigen::VectorXd all(at.force.size() + at.on_rates.size());
        all << at.force, at.on_rates;
        return all;
      };
      if (both.isZero(0.0) && (f(1.0) - f(0.0)).isZero(0.0)) continue;
      found_.push_back(checked_line(base::format("{}: force by control {}", name, model_.controls[c].name), f, both));
    }
  }

  /// Forces on minimal rates, by the coordinates and their rates.
  void check_rates(const model::IntervalTerm& term, const std::string& name) {
    if (forces(term, q_, v_, u_).on_rates.isZero(0.0)) return;
    const Eigen::VectorXd direction = 0.002 * numbers_.vector(manifold_.n_v()).cwiseProduct(manifold_.rate_scale());
    for (const bool by_velocity : {false, true}) {
      Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(manifold_.n_v());
      term.add_rate_tangent(point(q0_, q1_, q_, v_, u_),
                            by_velocity ? model::TangentWeights{.qv = 1.0} : model::TangentWeights{.qq = 1.0},
                            diagonal);
      Eigen::VectorXd given = diagonal.cwiseProduct(direction);
      if (by_velocity) given *= 2.0 / dt_;
      const Eigen::VectorXd x0 = x0_, x1 = x1_;
      const auto f = [&](double s) -> Eigen::VectorXd {
        manifold_.retract(x0, (by_velocity ? -s : s) * direction, x0_);
        manifold_.retract(x1, s * direction, x1_);
        return forces(term, q_, v_, u_).on_rates;
      };
      found_.push_back(
          checked_line(name + (by_velocity ? ": joint force by rate" : ": joint force by coordinate"), f, given));
      x0_ = x0;
      x1_ = x1;
    }
  }

  /// The momentum is the derivative of the kinetic energy, which is quadratic in the velocity.
  void check_energies(const model::IntervalTerm& term, const std::string& name) {
    const std::size_t n_parts = term.parts().size();
    if (n_parts == 0) return;
    const Eigen::VectorXd d = 0.01 * size_ / dt_ * numbers_.vector(model_.n_q());
    const Eigen::VectorXd given = Eigen::VectorXd::Constant(1, forces(term, q_, v_, u_).momentum.dot(d));
    const auto f = [&](double s) -> Eigen::VectorXd {
      const Eigen::VectorXd v = v_ + s * d;
      std::vector<model::Energy> parts(n_parts);
      term.energies({.x = {x0_.data(), static_cast<std::size_t>(x0_.size())}, .q = q_, .v = v, .u = u_}, parts);
      double sum = 0.0;
      for (const model::Energy& part : parts) sum += part.kinetic;
      return Eigen::VectorXd::Constant(1, sum);
    };
    found_.push_back(checked_line(name + ": kinetic energy by velocity", f, given));
  }

  const model::Model& model_;
  const model::Manifold& manifold_;
  const build::BuiltModel& built_;
  const statics::StaticState start_;
  math::CheckNumbers numbers_;
  double dt_ = 0.0;
  double size_ = 1.0;
  double largest_control_ = 1.0;
  Eigen::VectorXd x0_, x1_, q0_, q1_, q_, v_, y_;
  std::vector<double> u_;
  std::vector<CheckedDerivative> found_;
};

void add_optimal_control(const scene::Scene& scene, const build::BuiltModel& built,
                         std::vector<CheckedDerivative>& found) {
  variational::State start;
  if (!initial_state(scene, built, {}, start).completed()) return;
  const OptimalProblem problem = build_optimal_problem(scene, built, start.x);
  const control::Trajectory guess = make_guess(scene, built, problem.problem, 0);
  refuse_faults(scene, control::find_faults(problem.problem, guess));
  for (std::size_t i = 0; i < problem.stages.size(); ++i) {
    for (const control::DerivativeCheck& one : control::check_derivatives(problem.problem, problem.stages[i], guess)) {
      found.push_back({.of = base::format("optimal control, stage {}: {}", i + 1, one.what),
                       .error = one.error,
                       .slope = one.slope,
                       .expected = one.expected,
                       .passed = one.passed});
    }
  }
}

}  // namespace

std::vector<CheckedDerivative> check_derivatives(const scene::Scene& scene, const build::BuiltModel& built) {
  std::vector<CheckedDerivative> found = ModelCheck(scene, built).run();
  if (scene.optimal_control) add_optimal_control(scene, built, found);
  return found;
}

}  // namespace muldi::pipeline
