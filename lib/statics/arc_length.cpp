#include "statics/arc_length.hpp"

#include <algorithm>
#include <cmath>

namespace muldi::statics {
namespace {

/// Tangents of successive points that enclose a larger angle than this (its cosine) miss what lies between.
constexpr double least_cosine = 0.5;
/// An increment beyond this leads elsewhere.
constexpr double longest_increment = 1.0;
constexpr double round_off_residual = 1e-11;
constexpr int most_trials = 60;
/// Accuracy of a critical load, of the swept range.
constexpr double critical_accuracy = 1e-9;
constexpr double branch_width = 1e-7;
constexpr double known_branch = 1e-4;

}  // namespace

ArcLength::ArcLength(EquilibriumSolver& solver, const std::vector<double>& u_fixed,
                     const std::vector<double>& direction, double range, const EquilibriumOptions& options)
    : solver_(solver), u_fixed_(u_fixed), direction_(direction), range_(range), options_(options), u_(u_fixed) {}

void ArcLength::linearise(const CurvePoint& at) {
  for (std::size_t c = 0; c < u_.size(); ++c) u_[c] = u_fixed_[c] + at.load * direction_[c];
  solver_.linearise(at.state, u_);
}

void ArcLength::find_tangent(double side_of_load, const CurvePoint* previous, CurvePoint& at) {
  solver_.motions(u_, direction_, newton_, response_);
  at.tangent = response_;
  const double length = std::sqrt(1.0 + range_ * range_ * solver_.product(response_, response_));
  double side = side_of_load;
  if (previous != nullptr) {
    side = range_ * solver_.product(previous->tangent, response_) + previous->load_tangent >= 0.0 ? 1.0 : -1.0;
  }
  for (Eigen::VectorXd* part : {&at.tangent.w, &at.tangent.multipliers, &at.tangent.q, &at.tangent.y}) {
    *part *= side * range_ / length;
  }
  at.load_tangent = side / length;
}

CurvePoint ArcLength::start(const StaticState& state, double load) {
  CurvePoint point{.state = state, .load = load};
  linearise(point);
  find_tangent(1.0, nullptr, point);
  point.report.stability = solver_.stability();
  return point;
}

bool ArcLength::correct(const Plane& plane, CurvePoint& at) {
  EquilibriumReport& report = at.report;
  report = {};
  double previous = 0.0;
  for (report.iterations = 1; report.iterations <= options_.max_iterations; ++report.iterations) {
    report.inadmissible = solver_.why_inadmissible(at.state);
    if (!report.inadmissible.empty()) return false;
    linearise(at);
    if (!solver_.is_regular()) {
      report.inadmissible = solver_.why_inadmissible_anywhere();
      return false;
    }
    solver_.motions(u_, direction_, newton_, response_);
    const StaticMotion moved = solver_.difference(plane.from.state, at.state);
    const double missing =
        plane.arc - solver_.product(plane.along, moved) - plane.along_load * (at.load - plane.from.load) / range_;
    const double slope = plane.along_load / range_ + solver_.product(plane.along, response_);
    const double dload = (missing - solver_.product(plane.along, newton_)) / slope;
    newton_.w += dload * response_.w;
    newton_.multipliers += dload * response_.multipliers;
    newton_.q += dload * response_.q;
    newton_.y += dload * response_.y;
    const double size = std::max(solver_.size_of(newton_), std::abs(dload / range_));
    if (!std::isfinite(size) || size > longest_increment) return false;
    const StaticState before = at.state;
    solver_.move(before, 1.0, newton_, at.state);
    at.load += dload;
    // Near a crossing of branches the increments are round-off over a singular matrix.
    const bool stagnates =
        report.iterations > 3 && size > 0.5 * previous && solver_.relative_residual() < round_off_residual;
    previous = size;
    if (size > options_.tolerance && !stagnates) continue;
    linearise(at);
    if (!solver_.is_regular()) return false;
    solver_.settle(at.state);
    report.converged = true;
    report.stability = solver_.stability();
    report.residual = solver_.relative_residual();
    return true;
  }
  return false;
}

bool ArcLength::advance(const CurvePoint& from, double arc, CurvePoint& to) {
  to.state = from.state;
  solver_.swing(from.state, arc, from.tangent, to.state);
  to.load = from.load + arc * range_ * from.load_tangent;
  if (!correct({from, from.tangent, from.load_tangent, arc}, to)) return false;
  find_tangent(1.0, &from, to);
  return solver_.product(from.tangent, to.tangent) + from.load_tangent * to.load_tangent >= least_cosine;
}

bool ArcLength::move_to(double load, CurvePoint& point) {
  const CurvePoint from = point;
  const double arc = (load - from.load) / range_;
  solver_.swing(from.state, arc / from.load_tangent, from.tangent, point.state);
  point.load = load;
  StaticMotion none = from.tangent;
  for (Eigen::VectorXd* part : {&none.w, &none.multipliers, &none.q, &none.y}) part->setZero();
  if (!correct({from, none, 1.0, arc}, point)) return false;
  find_tangent(1.0, &from, point);
  return true;
}

bool ArcLength::locate(const CurvePoint& a, const CurvePoint& b, double arc, CriticalPoint& found) {
  if (a.load_tangent * b.load_tangent < 0.0) return locate_limit(a, b, arc, found);
  const bool changes = (a.report.stability == Stability::stable) != (b.report.stability == Stability::stable);
  return changes && locate_branch(a, arc, found);
}

bool ArcLength::locate_limit(const CurvePoint& a, const CurvePoint& b, double arc, CriticalPoint& found) {
  // The load is stationary where its tangent vanishes: regula falsi (Illinois). Near that point the load is off by half
  // the tangent times the distance.
  double low = 0.0;
  double high = arc;
  double at_low = a.load_tangent;
  double at_high = b.load_tangent;
  CurvePoint trial;
  int side = 0;
  for (int k = 0; k < most_trials; ++k) {
    double s = (low * at_high - high * at_low) / (at_high - at_low);
    while (!advance(a, s, trial)) {
      // On a long step the corrector may fail where it succeeds closer by.
      s = 0.5 * (low + s);
      if (s - low < critical_accuracy) return false;
    }
    found = {.kind = CriticalPoint::Kind::limit, .load = trial.load};
    const double value = trial.load_tangent;
    if (std::abs(value) * (high - low) < critical_accuracy) return true;
    if (value * at_high > 0.0) {
      high = s;
      at_high = value;
      if (side == 1) at_low *= 0.5;
      side = 1;
    } else {
      low = s;
      at_low = value;
      if (side == -1) at_high *= 0.5;
      side = -1;
    }
  }
  return true;
}

bool ArcLength::locate_branch(const CurvePoint& a, double arc, CriticalPoint& found) {
  double low = 0.0;
  double high = arc;
  CurvePoint trial{.load = a.load};
  while (high - low > branch_width) {
    const double s = 0.5 * (low + high);
    // The matrix is singular where the branches cross: close by, round-off hides where the curve goes on.
    CurvePoint next;
    if (!advance(a, s, next)) break;
    trial = std::move(next);
    const bool as_before = (trial.report.stability == Stability::stable) == (a.report.stability == Stability::stable);
    (as_before ? low : high) = s;
  }
  found = {.kind = CriticalPoint::Kind::branch, .load = trial.load};
  return high - low < known_branch;
}

}  // namespace muldi::statics
