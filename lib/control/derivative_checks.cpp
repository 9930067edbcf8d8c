/// Checks of derivatives that users can run on their own scenes.
#include <algorithm>
#include <cmath>
#include <random>

#include "control/transcription.hpp"
#include "math/derivative_check.hpp"

namespace muldi::control {
namespace {

Eigen::VectorXd random_vector(std::mt19937& random, Eigen::Index n) {
  std::uniform_real_distribution<double> entries(-1.0, 1.0);
  Eigen::VectorXd out(n);
  for (Eigen::Index i = 0; i < n; ++i) out[i] = entries(random);
  return out;
}

/// Where a check looks.
struct Line {
  const Eigen::VectorXd& x;
  const Eigen::VectorXd& direction;
};

/// Central differences at two steps, extrapolated, against what is given: a line of the report.
DerivativeCheck compare(std::string what, const math::VectorFunction& f, const Line& at, const Eigen::VectorXd& given) {
  constexpr double h = 1e-3;
  const auto difference = [&](double step) {
    return Eigen::VectorXd((f(at.x + step * at.direction) - f(at.x - step * at.direction)) / (2.0 * step));
  };
  const Eigen::VectorXd expected = (4.0 * difference(0.5 * h) - difference(h)) / 3.0;
  const math::TaylorTest test =
      math::taylor_test(f, {given}, {.x = at.x, .direction = at.direction, .first_step = 1e-2});
  DerivativeCheck line{.what = std::move(what), .slope = test.slope, .expected = 2.0};
  const double size = std::max(expected.lpNorm<Eigen::Infinity>(), given.lpNorm<Eigen::Infinity>());
  line.error = size > 0.0 ? (expected - given).lpNorm<Eigen::Infinity>() / size : 0.0;
  line.passed = line.error < 1e-6 || line.slope > 1.9;
  return line;
}

model::IntervalPoint point_at(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& x,
                              const std::vector<double>& u) {
  const std::span<const double> coordinates(x.data(), static_cast<std::size_t>(x.size()));
  return {.q0 = q, .q1 = q, .q = q, .v = v, .u = u, .dt = 1.0, .x0 = coordinates, .x1 = coordinates};
}

/// Derivatives of the pieces along one direction, spread back to q.
class DirectionSink final : public model::ExpansionSink {
 public:
  /// `dy`: of (q, v).
  DirectionSink(const PieceList& list, const Eigen::VectorXd& dy, const Eigen::VectorXd& a, const Eigen::VectorXd& b)
      : list_(list), dq_(dy.head(a.size())), dv_(dy.tail(a.size())), a_(a), b_(b) {
    forces = Eigen::VectorXd::Zero(dy.size());
    adjoint = adjoint_slope = forces;
  }

  void add(const model::LocalForms&, const model::LocalExpansion& expansion) override {
    const Piece& piece = list_.pieces[at_++];
    if (!piece.is_linear()) return;
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
  Eigen::VectorXd dq_;
  Eigen::VectorXd dv_;
  const Eigen::VectorXd& a_;
  const Eigen::VectorXd& b_;
  std::size_t at_ = 0;
};

/// The Lagrangian of a problem at perturbed unknowns.
struct NlpProbe {
  Transcription& nlp;
  Eigen::VectorXd mu;
  std::vector<double> values = std::vector<double>(nlp.jacobian_pattern().size());

  Eigen::VectorXd objective(const Eigen::VectorXd& at) {
    nlp.move_to(at);
    return Eigen::VectorXd::Constant(1, nlp.objective());
  }
  Eigen::VectorXd constraints(const Eigen::VectorXd& at) {
    nlp.move_to(at);
    Eigen::VectorXd c;
    nlp.constraints(c);
    return c;
  }
  Eigen::VectorXd gradient(const Eigen::VectorXd& at) {
    nlp.move_to(at);
    Eigen::VectorXd g;
    nlp.gradient(g);
    return g;
  }
  /// J d at the place where the problem is.
  Eigen::VectorXd jacobian_times(const Eigen::VectorXd& d) {
    nlp.jacobian(values.data());
    Eigen::VectorXd out = Eigen::VectorXd::Zero(nlp.n_constraints());
    for (std::size_t i = 0; i < values.size(); ++i) {
      out[nlp.jacobian_pattern().rows[i]] += values[i] * d[nlp.jacobian_pattern().columns[i]];
    }
    return out;
  }
  /// Gradient of f + mu . c.
  Eigen::VectorXd lagrangian(const Eigen::VectorXd& at) {
    Eigen::VectorXd g = gradient(at);
    nlp.jacobian(values.data());
    for (std::size_t i = 0; i < values.size(); ++i) {
      g[nlp.jacobian_pattern().columns[i]] += values[i] * mu[nlp.jacobian_pattern().rows[i]];
    }
    return g;
  }
  Eigen::VectorXd hessian_times(const Eigen::VectorXd& d) {
    std::vector<double> second(nlp.hessian_pattern().size());
    nlp.hessian(1.0, mu, second.data());
    Eigen::VectorXd out = Eigen::VectorXd::Zero(d.size());
    for (std::size_t i = 0; i < second.size(); ++i) {
      const int row = nlp.hessian_pattern().rows[i];
      const int column = nlp.hessian_pattern().columns[i];
      out[row] += second[i] * d[column];
      if (row != column) out[column] += second[i] * d[row];
    }
    return out;
  }
};

/// One term near the scene pose, as a function of (q, v).
struct TermProbe {
  const model::Model& model;
  const model::IntervalTerm& term;
  const PieceList list;
  const std::vector<model::MassEntry> mass;
  const Eigen::VectorXd& x;
  const std::vector<double>& u;
  const std::vector<double>& plain;
  const Eigen::VectorXd& a;
  const Eigen::VectorXd& b;

  /// (F, pi) without the constant mass.
  Eigen::VectorXd forces(const Eigen::VectorXd& y) const {
    const Eigen::Index n = a.size();
    const Eigen::VectorXd q = y.head(n);
    const Eigen::VectorXd v = y.tail(n);
    model::IntervalForces out{.force = Eigen::VectorXd::Zero(n), .momentum = Eigen::VectorXd::Zero(n)};
    out.on_rates = Eigen::VectorXd::Zero(model.manifold->n_v());
    term.add_forces(point_at(q, v, x, u), out);
    for (const model::MassEntry& entry : mass) entry.x.add_transposed(-entry.mass * entry.y.rate(v), out.momentum);
    Eigen::VectorXd both(2 * n);
    both << out.force, out.momentum;
    return both;
  }
  DirectionSink along(const Eigen::VectorXd& y, const Eigen::VectorXd& dy) const {
    const Eigen::Index n = a.size();
    const Eigen::VectorXd q = y.head(n);
    const Eigen::VectorXd v = y.tail(n);
    DirectionSink sink(list, dy, a, b);
    term.expand(point_at(q, v, x, u), {.squared = plain, .a = &a, .b = &b}, sink);
    return sink;
  }
};

/// A place near the scene pose and a direction, of (q, v) in natural sizes.
void choose_place(const model::Model& model, std::mt19937& random, Eigen::VectorXd& at, Eigen::VectorXd& direction) {
  const model::Manifold& manifold = *model.manifold;
  const Eigen::Index n = model.n_q();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(n);
  manifold.configuration(manifold.reference(), q);
  const double length = manifold.n_v() > 0 ? manifold.rate_scale().maxCoeff() : 1.0;
  // Directors are of size 1.
  const Eigen::VectorXd size = (q.array().abs() > 2.0).select(Eigen::VectorXd::Constant(n, length), 1.0);
  at.resize(2 * n);
  direction.resize(2 * n);
  at << q + 0.01 * size.cwiseProduct(random_vector(random, n)), 1e-3 * size.cwiseProduct(random_vector(random, n));
  direction << 0.1 * size.cwiseProduct(random_vector(random, n)), 1e-3 * size.cwiseProduct(random_vector(random, n));
}

}  // namespace

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
  const Eigen::VectorXd d = 0.1 * random_vector(random, n);
  NlpProbe probe{.nlp = nlp, .mu = random_vector(random, nlp.n_constraints())};
  const Line line{x, d};
  const Eigen::VectorXd slope = Eigen::VectorXd::Constant(1, probe.gradient(x).dot(d));
  lines.push_back(compare(
      "objective: gradient", [&](const Eigen::VectorXd& at) { return probe.objective(at); }, line, slope));
  nlp.move_to(x);
  const Eigen::VectorXd J_d = probe.jacobian_times(d);
  lines.push_back(compare(
      "constraints: Jacobian", [&](const Eigen::VectorXd& at) { return probe.constraints(at); }, line, J_d));
  nlp.move_to(x);
  const Eigen::VectorXd H_d = probe.hessian_times(d);
  lines.push_back(compare(
      "Lagrangian: Hessian", [&](const Eigen::VectorXd& at) { return probe.lagrangian(at); }, line, H_d));
  return lines;
}

std::vector<DerivativeCheck> check_terms(const model::Model& model) {
  std::vector<DerivativeCheck> lines;
  std::mt19937 random(2);
  Eigen::VectorXd at;
  Eigen::VectorXd direction;
  choose_place(model, random, at, direction);
  const Eigen::Index n = model.n_q();
  const Eigen::VectorXd a = random_vector(random, n);
  const Eigen::VectorXd b = random_vector(random, n);
  const Eigen::VectorXd x = model.manifold->reference();
  std::vector<double> u;
  model.evaluate_controls(0.0, u);
  const std::vector<double> plain(u.size(), 0.0);
  const auto chart = model.manifold->make_chart();
  const Eigen::VectorXd q = at.head(n);
  const Eigen::VectorXd v = at.tail(n);
  for (const auto& term : model.terms) {
    // What acts at the ends is no function of the midpoint: the checks of the problem hold it.
    if (term->acts_at_ends()) continue;
    PieceList list = list_pieces_of(*term, *chart, point_at(q, v, x, u), plain);
    if (!list.refused.empty()) continue;
    std::vector<model::MassEntry> mass;
    term->add_constant_mass(mass);
    const TermProbe probe{model, *term, std::move(list), std::move(mass), x, u, plain, a, b};
    const DirectionSink sink = probe.along(at, direction);
    const std::string name = name_of_term(*term);
    lines.push_back(compare(
        name + ": forces", [&](const Eigen::VectorXd& y) { return probe.forces(y); }, {at, direction}, sink.forces));
    lines.push_back(compare(
        name + ": adjoint Hessian", [&](const Eigen::VectorXd& y) { return probe.along(y, direction).adjoint; },
        {at, direction}, sink.adjoint_slope));
  }
  return lines;
}

}  // namespace muldi::control
