#pragma once
/// Energy and constraints over a long run, node by node (numerics 5 no. 4, 6).
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "support/rigid_system.hpp"
#include "support/trajectory.hpp"

namespace muldi::test {

class EnergyHistory {
 public:
  EnergyHistory(const model::Model& model, long steps) : manifold_(*model.manifold), steps_(steps) {}

  void add(const variational::NodeRecord& node) {
    const double deviation = node.values.total.kinetic + node.values.total.potential() - node.ledger.initial_total;
    band_.add(deviation, node.step, steps_);
    first_.add(deviation, 10.0 * static_cast<double>(node.step) / static_cast<double>(steps_));
    last_.add(deviation, 10.0 * static_cast<double>(node.step) / static_cast<double>(steps_) - 9.0);
    lowest_ = std::min(lowest_, node.values.total.potential());
    highest_ = std::max(highest_, node.values.total.potential());
    const double gap = manifold_.violation(node.state.q);
    violation_ = std::max(violation_, gap);
    const double size = node.state.q.lpNorm<Eigen::Infinity>();
    if (node.step == 0) size_ = size;
    gaps_.add(gap / std::max(1.0, size / size_), node.step, steps_);
  }

  /// |H - H_0|.
  const Band& band() const { return band_; }
  /// Characteristic energy: the swing of the potential.
  double swing() const { return highest_ - lowest_; }
  /// Hann-windowed mean of H over the last tenth minus that over the first.
  double drift() const { return last_.mean() - first_.mean(); }
  /// Largest violation of a constraint, redundant ones included.
  double violation() const { return violation_; }
  /// That of the last tenth over that of the first, where bodies that fly away are granted the wider spacing of numbers
  /// far from the origin; both no smaller than that at 1.
  double violation_growth() const {
    constexpr double round_off = std::numeric_limits<double>::epsilon();
    return std::max(gaps_.last_tenth, round_off) / std::max(gaps_.first_tenth, round_off);
  }

 private:
  struct HannMean {
    double sum = 0.0;
    double weights = 0.0;
    void add(double value, double place) {
      if (place < 0.0 || place > 1.0) return;
      const double root = std::sin(std::numbers::pi * place);
      sum += root * root * value;
      weights += root * root;
    }
    double mean() const { return sum / weights; }
  };

  const model::Manifold& manifold_;
  long steps_;
  Band band_;
  HannMean first_;
  HannMean last_;
  double lowest_ = std::numeric_limits<double>::infinity();
  double highest_ = -std::numeric_limits<double>::infinity();
  double violation_ = 0.0;
  double size_ = 1.0;  ///< largest entry of q at the start
  Band gaps_;          ///< violations of constraints
};

/// Ten times the steps: round-off that adds up at random grows by this factor, a drift by 10 (numerics 5 no. 6).
inline const double root_of_ten = std::sqrt(10.0);

/// The history of a run; one that fails throws. The last Newton increment is below 1e-10, so what it leaves is its
/// square: round-off.
inline EnergyHistory energy_history(const model::Model& model, const variational::State& start, double dt, long steps) {
  EnergyHistory history(model, steps);
  const Run done =
      run(model, start, {.dt = dt, .steps = steps}, [&](const variational::NodeRecord& node) { history.add(node); });
  if (done.result.status != variational::Status::completed) throw std::runtime_error(done.result.sentence);
  return history;
}

/// The system without the viscosity of its muscles.
inline RigidSystem undamped(RigidSystem system) {
  for (auto& muscle : system.muscles) muscle.element.viscosity = 0.0;
  return system;
}

}  // namespace muldi::test
