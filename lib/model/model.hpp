#pragma once
/// What solvers see: unknowns, terms, the constraint manifold, controls and observables. Immutable after building.
#include <memory>
#include <string>
#include <vector>

#include "base/describe.hpp"
#include "base/time_function.hpp"
#include "model/interval_term.hpp"
#include "model/manifold.hpp"
#include "model/observable.hpp"

namespace muldi::model {

/// A control: a named function of time in the unit of its quantity.
struct Control {
  std::string name;
  base::Dimension unit;
  base::TimeFunction function;
};

struct Model {
  std::vector<int> node_sizes;                  ///< unknowns a node (slice) of q
  std::unique_ptr<math::BlockPattern> pattern;  ///< blocks that the terms write
  std::vector<std::unique_ptr<IntervalTerm>> terms;
  std::unique_ptr<Manifold> manifold;
  std::vector<Control> controls;
  std::vector<Observable> observables;

  /// Requests the pattern of all terms and binds them; call once, after the last term.
  void bind();

  /// Controls at time t (n_controls).
  void evaluate_controls(double t, std::vector<double>& u) const;

  void forces(const IntervalPoint& at, IntervalForces& out) const;
  void tangent(const IntervalPoint& at, const TangentWeights& weights, math::BlockMatrix& K) const;
  IntervalWork work(const IntervalPoint& at) const;
  std::string inadmissible(const Eigen::VectorXd& q) const;
  /// The first advice of a term, or empty.
  std::string advice(const NodePoint& at) const;

  /// Components whose energies are recorded, over all terms in order.
  std::vector<std::string> parts() const;
  /// Energies at a node, one entry for each of parts(); overwrites `out`.
  void energies(const NodePoint& at, std::span<Energy> out) const;
  /// Momentum dL/dv at a node: linear part, and angular part about the origin. The first triple of a node is a
  /// position, further triples are directions; single unknowns carry neither.
  void momentum_maps(const Eigen::VectorXd& q, const Eigen::VectorXd& p, Eigen::Vector3d& linear,
                     Eigen::Vector3d& angular) const;

 private:
  std::vector<std::size_t> part_counts_;
};

}  // namespace muldi::model
