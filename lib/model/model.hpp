#pragma once
/// What solvers see: unknowns, terms, the constraint manifold, controls and observables. Immutable after building.
#include <memory>
#include <string>
#include <vector>

#include "base/describe.hpp"
#include "base/parallel.hpp"
#include "base/time_function.hpp"
#include "model/interval_term.hpp"
#include "model/manifold.hpp"
#include "model/observable.hpp"
#include "model/substructure.hpp"
#include "model/terminal.hpp"

namespace muldi::model {

/// A control: a named function of time in the unit of its quantity.
struct Control {
  std::string name;
  base::Dimension unit;
  base::TimeFunction function;
};

struct Model {
  std::vector<int> node_sizes;                  ///< unknowns a node (slice) of q
  std::vector<std::string> body_names;          ///< the bodies are the first nodes; for messages, may be empty
  std::unique_ptr<math::BlockPattern> pattern;  ///< blocks that the terms write
  std::vector<std::unique_ptr<IntervalTerm>> terms;
  std::vector<std::unique_ptr<Substructure>> substructures;  ///< their slices of q follow those of the manifold
  std::unique_ptr<Manifold> manifold;
  std::vector<Control> controls;
  std::vector<Observable> observables;
  std::vector<FieldHistory> histories;
  std::vector<Guard> guards = {};        ///< looked at in every node that a run accepts; status `breakdown`
  std::vector<Terminal> terminals = {};  ///< of the sources, where a scene records their energies
  bool books_supply = false;             ///< runs keep accounts of what the terminals are supplied with

  /// Requests the pattern of all terms and binds them, places the slices of the substructures; call once, after the
  /// last of them.
  void bind();

  /// Calls use(part, i) for all substructures, on several threads where these are better used so than inside of them;
  /// `use` must touch nothing that parts share.
  template <class Use>
  void each_part(const Use& use) const {
    const auto n = static_cast<int>(substructures.size());
    if (parts_side_by_side()) {
      base::parallel_for(n,
                         [&](int i) { use(*substructures[static_cast<std::size_t>(i)], static_cast<std::size_t>(i)); });
    } else {
      for (std::size_t i = 0; i < substructures.size(); ++i) use(*substructures[i], i);
    }
  }

  Eigen::Index n_q() const { return n_q_; }  ///< configuration: the manifold's and the substructures' slices
  Eigen::Index n_y() const { return n_y_; }  ///< stage unknowns

  /// Controls at time t (n_controls).
  void evaluate_controls(double t, std::vector<double>& u) const;

  /// True if IntervalForces::begin and end are needed over intervals dt > 0.
  bool acts_at_ends() const;
  void forces(const IntervalPoint& at, IntervalForces& out) const;
  void tangent(const IntervalPoint& at, const TangentWeights& weights, math::BlockMatrix& K) const;
  /// Derivatives of the forces on the minimal rates, see IntervalTerm::add_rate_tangent; overwrites `diagonal` (n_v).
  void rate_tangent(const IntervalPoint& at, const TangentWeights& weights, Eigen::VectorXd& diagonal) const;
  IntervalWork work(const IntervalPoint& at) const;
  /// Why the terms cannot be evaluated at q, or empty; substructures report by the margin of their forces.
  std::string inadmissible(const Eigen::VectorXd& q) const;
  /// The same with the substructures, which costs as much as their forces.
  std::string inadmissible_anywhere(const Eigen::VectorXd& q) const;
  /// What the first substructure says whose shape at q its discretisation does not resolve, or empty.
  std::string unresolved(const Eigen::VectorXd& q) const;
  /// How messages call the body that is this node: by its name, if the model knows it.
  std::string body_at(int node) const;
  /// What the first guard says that is not silent, or empty.
  std::string breach(const NodeView& at) const;
  /// The first advice of a term, or empty.
  std::string advice(const NodePoint& at) const;

  /// Components whose energies are recorded, over all terms and substructures in order.
  std::vector<std::string> parts() const;
  /// Energies at a node, one entry for each of parts(); overwrites `out`.
  void energies(const NodePoint& at, std::span<Energy> out) const;
  /// Momentum dL/dv at a node: linear part, and angular part about the origin. The first triple of a node is a
  /// position, further triples are directions; single unknowns carry neither.
  void momentum_maps(const Eigen::VectorXd& q, const Eigen::VectorXd& p, Eigen::Vector3d& linear,
                     Eigen::Vector3d& angular) const;

 private:
  /// Calls use(term) for all terms, then for all substructures.
  template <class Use>
  void each(const Use& use) const {
    for (const auto& term : terms) use(*term);
    for (const auto& part : substructures) use(*part);
  }

  /// True if the largest part does not leave most threads idle.
  bool parts_side_by_side() const;

  mutable std::vector<PartLimits> limits_;
  mutable std::vector<IntervalWork> works_;
  std::vector<std::size_t> part_counts_;
  Eigen::Index n_q_ = 0;
  Eigen::Index n_y_ = 0;
};

}  // namespace muldi::model
