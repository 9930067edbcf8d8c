#pragma once
/// The contract between physics and integrators: a Lagrangian and forces over one time interval.
///
/// Over the interval [t_n, t_n + dt] the discrete Lagrangian is L_d = dt L(q, v, u) with q = (q_0 + q_1)/2,
/// v = (q_1 - q_0)/dt and the control u at the middle of the interval (numerics, 1.5). A term adds its share of L and
/// of the non-conservative force f. Statics use the same terms with v = 0.
#include <Eigen/Core>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "math/block_matrix.hpp"
#include "model/expansion.hpp"

namespace muldi::model {

/// Where the integrator evaluates the terms; everything refers to buffers of the caller.
struct IntervalPoint {
  const Eigen::VectorXd& q0;        ///< configuration at the begin (n_q)
  const Eigen::VectorXd& q1;        ///< configuration at the end
  const Eigen::VectorXd& q;         ///< midpoint configuration
  const Eigen::VectorXd& v;         ///< mean velocity
  std::span<const double> u;        ///< controls at the middle of the interval, in their own units
  double dt = 0.0;                  ///< 0 in statics
  std::span<const double> x0 = {};  ///< coordinates of the manifold at the begin and the end: whole turns of angles
  std::span<const double> x1 = {};
  const Eigen::VectorXd* y = nullptr;  ///< stage unknowns of the substructures (n_y); null: none are there or wanted
  bool first = false;                  ///< the first interval of a run, whose begin has half the weight of a node
};

/// A node in time, for energies.
struct NodePoint {
  std::span<const double> x;  ///< coordinates of the manifold
  const Eigen::VectorXd& q;
  const Eigen::VectorXd& v;  ///< admissible velocity
  std::span<const double> u;
};

/// First derivatives, accumulated over the terms. `begin` and `end` are of length 0 where no term acts at the ends or
/// the point is at rest, `stage` in models without substructures, `on_rates` where the point gives no coordinates.
struct IntervalForces {
  Eigen::VectorXd force;          ///< dL/dq + f (n_q)
  Eigen::VectorXd momentum;       ///< dL/dv (n_q)
  Eigen::VectorXd begin = {};     ///< D1 L_d beyond dt/2 dL/dq - dL/dv: what depends on q0 itself (n_q)
  Eigen::VectorXd end = {};       ///< D2 L_d likewise: what depends on q1 itself (n_q)
  Eigen::VectorXd stage = {};     ///< residual of the stage rows (n_y)
  Eigen::VectorXd on_rates = {};  ///< force on the minimal rates beside T^T (dL/dq + f), dt/2 at either end (n_v)
  double margin = std::numeric_limits<double>::infinity();  ///< not positive, or NaN: the state is inadmissible
  double violation = 0.0;  ///< largest violation of constraints that terms keep themselves, dimensionless
};

/// Factors of the second derivatives that a term adds to the tangent:
/// K += vv L_vv + vq L_vq + qv (L_qv + f_v) + qq (L_qq + f_q).
/// The Newton matrix of a step is (1/dt, 1/2, -1/2, -dt/4), the mass matrix (1, 0, 0, 0), the static stiffness (0, 0,
/// 0, -1).
struct TangentWeights {
  double vv = 0.0;
  double vq = 0.0;
  double qv = 0.0;
  double qq = 0.0;

  static TangentWeights step(double dt) { return {1.0 / dt, 0.5, -0.5, -0.25 * dt}; }
  static TangentWeights mass() { return {1.0, 0.0, 0.0, 0.0}; }
  static TangentWeights stiffness() { return {0.0, 0.0, 0.0, -1.0}; }
};

/// Energies of one named component at a node in time.
struct Energy {
  double kinetic = 0.0;  ///< 1/2 v . L_vv v
  double elastic = 0.0;
  double electric = 0.0;  ///< electric enthalpy: -1/2 C U^2 (numerics, C16)
  double gravity = 0.0;

  Energy& operator+=(const Energy& other) {
    kinetic += other.kinetic;
    elastic += other.elastic;
    electric += other.electric;
    gravity += other.gravity;
    return *this;
  }
  double potential() const { return elastic + electric + gravity; }
};

/// Work over one interval that does not derive from the energies.
struct IntervalWork {
  double dissipated = 0.0;  ///< >= 0 for passive dampers
  double external = 0.0;    ///< work of loads and drives on the system

  IntervalWork& operator+=(const IntervalWork& other) {
    dissipated += other.dissipated;
    external += other.external;
    return *this;
  }
};

/// Collects the blocks that the terms of a model write.
class PatternRequest {
 public:
  void add_pair(int row_node, int column_node) { pairs_.emplace_back(row_node, column_node); }
  /// Every pair among `nodes`.
  void add_clique(std::span<const int> nodes) {
    for (const int i : nodes)
      for (const int j : nodes) add_pair(i, j);
  }
  const std::vector<std::pair<int, int>>& pairs() const { return pairs_; }

 private:
  std::vector<std::pair<int, int>> pairs_;
};

/// One virtual call for all components of a kind (one term holds many springs, all bodies, ...).
/// After `bind` a term is immutable; evaluations allocate nothing.
class IntervalTerm {
 public:
  virtual ~IntervalTerm() = default;

  /// States the blocks that add_tangent writes.
  virtual void request(PatternRequest& pattern) const = 0;
  /// Finds the slots of those blocks, once.
  virtual void bind(const math::BlockPattern& pattern) = 0;

  /// True if the term writes IntervalForces::begin and end over intervals dt > 0.
  virtual bool acts_at_ends() const { return false; }

  /// Adds dL/dq + f and dL/dv at the point.
  virtual void add_forces(const IntervalPoint& at, IntervalForces& out) const = 0;
  /// Adds the weighted second derivatives at the point.
  virtual void add_tangent(const IntervalPoint& at, const TangentWeights& weights, math::BlockMatrix& K) const = 0;
  /// Adds d(dL/dq + f)/du_c for control c (n_q); used by continuation and optimal control.
  virtual void add_control_force(const IntervalPoint& at, int control, Eigen::VectorXd& out) const = 0;

  /// Adds the weighted derivatives of IntervalForces::on_rates by the coordinates x (qq) and their rates (qv); force j
  /// depends on coordinate j alone, so that they are the diagonal of a matrix (n_v).
  virtual void add_rate_tangent(const IntervalPoint& at, const TangentWeights& weights,
                                Eigen::VectorXd& diagonal) const {
    static_cast<void>(at);
    static_cast<void>(weights);
    static_cast<void>(diagonal);
  }
  /// Adds d(on_rates)/du_c for control c (n_v).
  virtual void add_control_force_on_rates(const IntervalPoint& at, int control, Eigen::VectorXd& out) const {
    static_cast<void>(at);
    static_cast<void>(control);
    static_cast<void>(out);
  }

  /// Adds the parts of the kinetic energy that do not depend on the state; `expand` leaves them out.
  virtual void add_constant_mass(std::vector<MassEntry>& mass) const { static_cast<void>(mass); }
  /// Hands over the pieces of the term with their derivatives at the point; forces that do not depend on the state or
  /// on controls are no pieces. False where the term has no such derivatives: it cannot be optimised.
  virtual bool expand(const IntervalPoint& at, const ExpansionRequest& request, ExpansionSink& sink) const {
    static_cast<void>(at), static_cast<void>(request), static_cast<void>(sink);
    return false;
  }
  /// Adds the muscles whose fields and stiffness can be limited.
  virtual void list_limited(std::vector<LimitedMuscle>& muscles) const { static_cast<void>(muscles); }

  /// Work of the non-conservative forces over the interval.
  virtual IntervalWork work(const IntervalPoint& at) const = 0;

  /// Names of the components whose energies are recorded, as `<folder>/<name>`, e.g. "muscles/upper".
  virtual std::vector<std::string> parts() const = 0;
  /// Adds the energies at a node, one entry for each of parts().
  virtual void energies(const NodePoint& at, std::span<Energy> out) const = 0;

  /// What a user should know about a state that can be computed but is beyond the model (a muscle compressed beyond its
  /// buckling load); empty if there is nothing to say.
  virtual std::string advice(const NodePoint& at) const {
    static_cast<void>(at);
    return {};
  }

  /// Empty if the term can be evaluated at configuration q; otherwise why not, e.g. "muscle 'upper': stretch 0.12 below
  /// 0.2".
  virtual std::string inadmissible(const Eigen::VectorXd& q) const {
    static_cast<void>(q);
    return {};
  }
};

}  // namespace muldi::model
