/// What can be known before a solve, and checks of derivatives.
#include <algorithm>
#include <cmath>
#include <random>

#include "control/transcription.hpp"
#include "math/derivative_check.hpp"

namespace muldi::control {
namespace {

/// dL/dq + f in the scene pose at rest with one control at u, the others at 0, and the forces on the rates behind it.
Eigen::VectorXd forces_with(const model::Model& model, int control, double u) {
  const model::Manifold& manifold = *model.manifold;
  const Eigen::VectorXd x = manifold.reference();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.n_q());
  const Eigen::VectorXd zero = q;
  manifold.configuration(x, q);
  std::vector<double> all(model.controls.size(), 0.0);
  all[static_cast<std::size_t>(control)] = u;
  const std::span<const double> view(x.data(), static_cast<std::size_t>(x.size()));
  model::IntervalForces forces{.force = zero, .momentum = zero};
  forces.on_rates = Eigen::VectorXd::Zero(manifold.n_v());
  model.forces({.q0 = q, .q1 = q, .q = q, .v = zero, .u = all, .x0 = view, .x1 = view}, forces);
  Eigen::VectorXd out(zero.size() + forces.on_rates.size());
  out << forces.force, forces.on_rates;
  return out;
}

void find_control_faults(const Problem& problem, std::vector<Fault>& faults) {
  if (problem.controls.empty()) faults.push_back({"controls", "no control is sought: name at least one"});
  for (const ControlChoice& choice : problem.controls) {
    const std::string where = "controls." + problem.model.controls[static_cast<std::size_t>(choice.control)].name;
    if (!(choice.lower <= choice.upper)) faults.push_back({where, "the lower bound is above the upper one"});
    if (choice.kind == ControlKind::squared && choice.lower < 0.0) {
      faults.push_back({where, "only the square of this control acts: its bounds must not be negative"});
    }
    if (!(choice.reference > 0.0)) faults.push_back({where, "its reference must be positive"});
  }
  if (!problem.horizon.is_free()) return;
  for (std::size_t c = 0; c < problem.model.controls.size(); ++c) {
    const bool sought = std::any_of(problem.controls.begin(), problem.controls.end(), [&](const ControlChoice& choice) {
      return static_cast<std::size_t>(choice.control) == c;
    });
    if (sought || problem.model.controls[c].function.is_constant()) continue;
    faults.push_back({"controls", "'" + problem.model.controls[c].name +
                                      "' is a function of time and is not sought, but the duration is free: make it "
                                      "constant, seek it, or fix the duration"});
  }
}

Eigen::VectorXd random_vector(std::mt19937& random, Eigen::Index n) {
  std::uniform_real_distribution<double> entries(-1.0, 1.0);
  Eigen::VectorXd out(n);
  for (Eigen::Index i = 0; i < n; ++i) out[i] = entries(random);
  return out;
}

/// Central differences at two steps, extrapolated, against what is given: a line of the report.
DerivativeCheck compare(std::string what, const math::VectorFunction& f, const Eigen::VectorXd& x,
                        const Eigen::VectorXd& direction, const Eigen::VectorXd& given) {
  constexpr double h = 1e-3;
  const auto difference = [&](double step) {
    return Eigen::VectorXd((f(x + step * direction) - f(x - step * direction)) / (2.0 * step));
  };
  const Eigen::VectorXd expected = (4.0 * difference(0.5 * h) - difference(h)) / 3.0;
  const math::TaylorTest test = math::taylor_test(f, {given}, {.x = x, .direction = direction, .first_step = 1e-2});
  DerivativeCheck line{.what = std::move(what), .slope = test.slope, .expected = 2.0};
  const double size = std::max(expected.lpNorm<Eigen::Infinity>(), given.lpNorm<Eigen::Infinity>());
  line.error = size > 0.0 ? (expected - given).lpNorm<Eigen::Infinity>() / size : 0.0;
  line.passed = line.error < 1e-6 || line.slope > 1.9;
  return line;
}

/// Derivatives of the pieces along one direction, spread back to q.
class DirectionSink final : public model::ExpansionSink {
 public:
  DirectionSink(const PieceList& list, const Eigen::VectorXd& dq, const Eigen::VectorXd& dv, const Eigen::VectorXd& a,
                const Eigen::VectorXd& b)
      : list_(list), dq_(dq), dv_(dv), a_(a), b_(b) {
    forces = Eigen::VectorXd::Zero(2 * dq.size());
    adjoint = adjoint_slope = forces;
  }

  void add(const model::LocalForms&, const model::LocalExpansion& expansion) override {
    const Piece& piece = list_.pieces[at_++];
    if (piece.rate >= 0) return;
    const Eigen::Index m = piece.size;
    Eigen::VectorXd y(2 * m);
    Eigen::VectorXd weights(2 * m);
    piece.apply(dq_, y.head(m));
    piece.apply(dv_, y.tail(m));
    piece.apply(a_, weights.head(m));
    piece.apply(b_, weights.tail(m));
    spread(piece, expansion.tangent.leftCols(2 * m) * y, forces);
    spread(piece, expansion.tangent.leftCols(2 * m).transpose() * weights, adjoint);
    spread(piece, expansion.hessian->topLeftCorner(2 * m, 2 * m) * y, adjoint_slope);
  }

  Eigen::VectorXd forces;         ///< of (F, pi)
  Eigen::VectorXd adjoint;        ///< gradient of Psi by (q, v)
  Eigen::VectorXd adjoint_slope;  ///< its derivative along the direction

 private:
  static void spread(const Piece& piece, const Eigen::VectorXd& local, Eigen::VectorXd& out) {
    const Eigen::Index n = out.size() / 2;
    Eigen::VectorXd part = Eigen::VectorXd::Zero(n);
    piece.add_transposed(local.head(piece.size), part);
    out.head(n) += part;
    part.setZero();
    piece.add_transposed(local.tail(piece.size), part);
    out.tail(n) += part;
  }

  const PieceList& list_;
  const Eigen::VectorXd& dq_;
  const Eigen::VectorXd& dv_;
  const Eigen::VectorXd& a_;
  const Eigen::VectorXd& b_;
  std::size_t at_ = 0;
};

}  // namespace

ControlKind kind_of_control(const model::Model& model, int control) {
  constexpr double unit = 1e4;  // of a field in V/mm a natural value; linear and quadratic forces have no scale
  const Eigen::VectorXd none = forces_with(model, control, 0.0);
  const Eigen::VectorXd single = forces_with(model, control, unit) - none;
  const Eigen::VectorXd twice = forces_with(model, control, 2.0 * unit) - none;
  const double size = twice.norm();
  const bool quadratic = size > 0.0 && (twice - 4.0 * single).norm() < 1e-9 * size;
  return quadratic ? ControlKind::squared : ControlKind::plain;
}

std::vector<Fault> find_faults(const Problem& problem, const Trajectory& guess) {
  std::vector<Fault> faults;
  if (problem.horizon.n_steps < 1) faults.push_back({"duration", "the horizon has no step"});
  if (!(problem.horizon.shortest_step > 0.0) || problem.horizon.shortest_step > problem.horizon.longest_step) {
    faults.push_back({"duration", "the shortest step must be positive and not above the longest"});
  }
  if (!problem.model.substructures.empty()) {
    faults.push_back({"",
                      "finite elements cannot be optimised: give the muscles `model: lumped` and replay the controls "
                      "on finite elements"});
  }
  for (const CoordinateLimit& limit : problem.limits.coordinates) {
    if (limit.lower > limit.upper) faults.push_back({"limits." + limit.name, "the lower bound is above the upper one"});
  }
  for (const PointLimit& limit : problem.limits.points) {
    if ((limit.lower.array() > limit.upper.array()).any()) {
      faults.push_back({"limits." + limit.name, "a lower bound is above the upper one"});
    }
  }
  find_control_faults(problem, faults);
  if (!faults.empty()) return faults;
  const Transcription transcription(problem, {}, refined_guess(problem, guess));
  return transcription.faults();
}

std::vector<DerivativeCheck> check_derivatives(const Problem& problem, std::span<const WeightedObjective> objectives,
                                               const Trajectory& guess) {
  std::vector<DerivativeCheck> lines;
  Transcription nlp(problem, objectives, refined_guess(problem, guess));
  if (!nlp.faults().empty()) return lines;
  std::mt19937 random(1);
  const Eigen::Index n = nlp.n_variables();
  Eigen::VectorXd x = nlp.unknowns_of(refined_guess(problem, guess));
  // Off the bounds of squares, where their controls have no derivative, and off symmetric poses.
  for (Eigen::Index i = 0; i < n; ++i) x[i] += 0.01 + 0.01 * std::sin(1.0 + 3.0 * static_cast<double>(i));
  const Eigen::VectorXd direction = 0.1 * random_vector(random, n);
  const Eigen::VectorXd mu = random_vector(random, nlp.n_constraints());
  const auto gradient = [&](const Eigen::VectorXd& at) {
    nlp.move_to(at);
    Eigen::VectorXd g;
    nlp.gradient(g);
    return g;
  };
  std::vector<double> values(nlp.jacobian_pattern().size());
  const auto lagrangian = [&](const Eigen::VectorXd& at) {
    Eigen::VectorXd g = gradient(at);
    nlp.jacobian(values.data());
    for (std::size_t i = 0; i < values.size(); ++i) {
      g[nlp.jacobian_pattern().columns[i]] += values[i] * mu[nlp.jacobian_pattern().rows[i]];
    }
    return g;
  };
  const Eigen::VectorXd slope = Eigen::VectorXd::Constant(1, gradient(x).dot(direction));
  lines.push_back(compare(
      "objective: gradient",
      [&](const Eigen::VectorXd& at) {
        nlp.move_to(at);
        return Eigen::VectorXd(Eigen::VectorXd::Constant(1, nlp.objective()));
      },
      x, direction, slope));
  nlp.move_to(x);
  nlp.jacobian(values.data());
  Eigen::VectorXd J_d = Eigen::VectorXd::Zero(nlp.n_constraints());
  for (std::size_t i = 0; i < values.size(); ++i) {
    J_d[nlp.jacobian_pattern().rows[i]] += values[i] * direction[nlp.jacobian_pattern().columns[i]];
  }
  lines.push_back(compare(
      "constraints: Jacobian",
      [&](const Eigen::VectorXd& at) {
        nlp.move_to(at);
        Eigen::VectorXd c;
        nlp.constraints(c);
        return c;
      },
      x, direction, J_d));
  nlp.move_to(x);
  std::vector<double> second(nlp.hessian_pattern().size());
  nlp.hessian(1.0, mu, second.data());
  Eigen::VectorXd H_d = Eigen::VectorXd::Zero(n);
  for (std::size_t i = 0; i < second.size(); ++i) {
    const int row = nlp.hessian_pattern().rows[i];
    const int column = nlp.hessian_pattern().columns[i];
    H_d[row] += second[i] * direction[column];
    if (row != column) H_d[column] += second[i] * direction[row];
  }
  lines.push_back(compare("Lagrangian: Hessian", lagrangian, x, direction, H_d));
  return lines;
}

std::vector<DerivativeCheck> check_terms(const model::Model& model) {
  std::vector<DerivativeCheck> lines;
  const model::Manifold& manifold = *model.manifold;
  const Eigen::VectorXd x = manifold.reference();
  const std::span<const double> view(x.data(), static_cast<std::size_t>(x.size()));
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.n_q());
  manifold.configuration(x, q);
  std::mt19937 random(2);
  const Eigen::Index n = model.n_q();
  const double length = manifold.n_v() > 0 ? manifold.rate_scale().maxCoeff() : 1.0;
  Eigen::VectorXd size = Eigen::VectorXd::Constant(n, 1.0);
  for (Eigen::Index i = 0; i < n; ++i) size[i] = std::abs(q[i]) > 2.0 ? length : 1.0;
  q += 0.01 * size.cwiseProduct(random_vector(random, n));
  Eigen::VectorXd at(2 * n);
  at << q, 1e-3 * size.cwiseProduct(random_vector(random, n));
  Eigen::VectorXd direction(2 * n);
  direction << 0.1 * size.cwiseProduct(random_vector(random, n)), 1e-3 * size.cwiseProduct(random_vector(random, n));
  const Eigen::VectorXd a = random_vector(random, n);
  const Eigen::VectorXd b = random_vector(random, n);
  std::vector<double> u;
  model.evaluate_controls(0.0, u);
  const std::vector<double> plain(u.size(), 0.0);
  const auto chart = manifold.make_chart();
  for (const auto& term : model.terms) {
    const Eigen::VectorXd q_at = at.head(n);
    const Eigen::VectorXd v_at = at.tail(n);
    const auto point_at = [&](const Eigen::VectorXd& q_of, const Eigen::VectorXd& v_of) {
      return model::IntervalPoint{
          .q0 = q_of, .q1 = q_of, .q = q_of, .v = v_of, .u = u, .dt = 1.0, .x0 = view, .x1 = view};
    };
    const PieceList list = list_pieces_of(*term, *chart, point_at(q_at, v_at), plain);
    if (!list.refused.empty()) continue;
    std::vector<model::MassEntry> constant;
    term->add_constant_mass(constant);
    const auto forces = [&](const Eigen::VectorXd& y) {
      const Eigen::VectorXd q_of = y.head(n);
      const Eigen::VectorXd v_of = y.tail(n);
      model::IntervalForces out{.force = Eigen::VectorXd::Zero(n), .momentum = Eigen::VectorXd::Zero(n)};
      out.on_rates = Eigen::VectorXd::Zero(manifold.n_v());
      term->add_forces(point_at(q_of, v_of), out);
      for (const model::MassEntry& entry : constant)
        entry.x.add_transposed(-entry.mass * entry.y.rate(v_of), out.momentum);
      Eigen::VectorXd both(2 * n);
      both << out.force, out.momentum;
      return both;
    };
    const auto sink_at = [&](const Eigen::VectorXd& y, const Eigen::VectorXd& dy) {
      const Eigen::VectorXd q_of = y.head(n);
      const Eigen::VectorXd v_of = y.tail(n);
      const Eigen::VectorXd dq = dy.head(n);
      const Eigen::VectorXd dv = dy.tail(n);
      DirectionSink sink(list, dq, dv, a, b);
      term->expand(point_at(q_of, v_of), {.squared = plain, .a = &a, .b = &b}, sink);
      return sink;
    };
    const DirectionSink sink = sink_at(at, direction);
    const std::string name = name_of_term(*term);
    lines.push_back(compare(name + ": forces", forces, at, direction, sink.forces));
    lines.push_back(compare(
        name + ": adjoint Hessian", [&](const Eigen::VectorXd& y) { return sink_at(y, direction).adjoint; }, at,
        direction, sink.adjoint_slope));
  }
  return lines;
}

}  // namespace muldi::control
