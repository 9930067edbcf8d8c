#pragma once
/// The contract of parts with many unknowns of their own: finite-element solids.
///
/// A substructure is an interval term with two slices of unknowns: positions q_s, which follow the directors in q and
/// have no constraints of the manifold, and stage unknowns y, which have no inertia (numerics, C2): potentials, element
/// pressures. Its equations are the rows of the momentum balance of its slice and as many stage rows h as it has stage
/// unknowns. Some of its positions are prescribed and some follow bodies through constant linear maps; both are rows
/// and columns of the identity to its solver. A solver eliminates the substructure: what is left are forces and a
/// stiffness on the bodies that it is tied to.
#include <memory>
#include <string>

#include "model/interval_term.hpp"

namespace muldi::model {

/// A contiguous range of unknowns.
struct Slice {
  Eigen::Index first = 0;
  Eigen::Index size = 0;

  Eigen::Index end() const { return first + size; }
};

/// Which equations a solver linearises.
enum class Linearisation {
  step,      ///< momentum balance of a step and its stage rows
  velocity,  ///< M v + constraint impulses = p at a node
  rest,      ///< equilibrium at the point's configuration
};

/// Controls that place what is not free: at the middle of the interval for potentials, at its end for positions.
struct Placement {
  std::span<const double> u;
  std::span<const double> u_end;
};

/// How large an increment is: 1 is the size of the part, of its potentials, of its pressures.
struct IncrementSize {
  double positions = 0.0;
  double stage = 0.0;

  /// NaN if one is.
  double largest() const { return !(positions <= stage) ? positions : stage; }
};

/// Factorised linearisation of one substructure. Vectors are those of the whole system; a solver reads and writes the
/// slices of its part and, where the part is tied to bodies, reads the entries of these. All but the two that add to
/// what parts share may run beside those of other parts.
class SubstructureSolver {
 public:
  virtual ~SubstructureSolver() = default;

  /// Linearises and factorises at the point; false if the matrix is singular to working precision.
  virtual bool factorise(const IntervalPoint& at) = 0;
  /// The reductions up to the next factorisation solve with the exact derivative at the point, to a relative accuracy
  /// of the increment, with the factor as preconditioner. Without this they solve with the factor alone, whose matrix
  /// may be older and lacks what is not symmetric.
  virtual void linearise(const IntervalPoint& at, double accuracy) {
    static_cast<void>(at), static_cast<void>(accuracy);
  }
  /// Negative pivots beyond those that the potentials must have: 0 at a stable equilibrium.
  virtual int unstable_directions() const = 0;
  /// Carries the factor along with the bodies that the part is tied to, to their directors in q (n_q): what follows
  /// then has a better matrix for the present configuration.
  virtual void turn(const Eigen::VectorXd& q) { static_cast<void>(q); }
  /// Solves for the slices with the bodies held: `bracket` (n_q) is the residual of the momentum balance, `h` (n_y)
  /// that of the stage rows.
  virtual void reduce(const Eigen::VectorXd& bracket, const Eigen::VectorXd& h) = 0;
  /// Adds what the last `reduce` answered to the rows of the bodies (n_q).
  virtual void add_response(Eigen::VectorXd& bracket) const = 0;
  /// Adds the stiffness of the eliminated part to the blocks of the bodies.
  virtual void add_condensed(math::BlockMatrix& K) const = 0;
  /// Completes dq and dy for the motion of the bodies that dq holds.
  virtual void expand(Eigen::VectorXd& dq, Eigen::VectorXd& dy) = 0;
  virtual std::string name() const = 0;
};

/// What a solver of a substructure takes, told without making it.
struct SolverSize {
  std::string solver = {};  ///< its name
  double matrix_bytes = 0.0;
  double factor_bytes = 0.0;
};

/// Part of IntervalForces that all parts share.
struct PartLimits {
  double margin = std::numeric_limits<double>::infinity();
  double violation = 0.0;

  /// The smaller margin, or one that is no number; the larger violation.
  void add_to(IntervalForces& out) const {
    if (!(margin >= out.margin)) out.margin = margin;
    if (!(violation <= out.violation)) out.violation = violation;
  }
};

class Substructure : public IntervalTerm {
 public:
  /// Adds dL/dq + f, dL/dv, what acts at the ends, and the stage rows, all in the slices of the part: it may run beside
  /// other parts.
  virtual PartLimits add_part_forces(const IntervalPoint& at, IntervalForces& out) const = 0;
  void add_forces(const IntervalPoint& at, IntervalForces& out) const final { add_part_forces(at, out).add_to(out); }

  const Slice& q_slice() const { return q_; }
  const Slice& y_slice() const { return y_; }
  /// Where the slices begin; once, while the model is built.
  void place_slices(Eigen::Index first_q, Eigen::Index first_y) {
    q_.first = first_q;
    y_.first = first_y;
  }

  /// The configuration of the scene pose, but of what follows the bodies in q, and stage values to start from.
  virtual void start(Eigen::VectorXd& q, Eigen::VectorXd& y) const = 0;
  /// Writes the positions and potentials that are not free; the entries of the bodies in q are read.
  virtual void place(const Placement& at, Eigen::VectorXd& q, Eigen::VectorXd& y) const = 0;
  /// Moves the stage unknowns without inertia to their equilibrium at the midpoint: a consistent start after a sudden
  /// change of the controls.
  virtual void settle_stage(const IntervalPoint& at, Eigen::VectorXd& y) const = 0;

  /// A solver for one kind of equations; `name`: auto | direct | iterative | a named solver.
  virtual std::unique_ptr<SubstructureSolver> make_solver(Linearisation kind, const std::string& name) const = 0;
  virtual SolverSize solver_size(Linearisation kind, const std::string& name) const = 0;
  /// Largest entries of an increment relative to the natural sizes of the part.
  virtual IncrementSize size_of(const Eigen::VectorXd& dq, const Eigen::VectorXd& dy) const = 0;
  /// Largest displacement relative to the natural size that is no motion along with the bodies which the part is tied
  /// to; q (n_q) is the configuration that dq starts from.
  virtual double deformation(const Eigen::VectorXd& q, const Eigen::VectorXd& dq) const = 0;
  /// Adds to the slice of q what it shares of a motion of the bodies that the part is tied to: `motion` (n_q) holds the
  /// changes of phi, d1, d2, d3, and `before` the configuration in which nodes go with them as if fixed there.
  virtual void carry(const Eigen::VectorXd& before, const Eigen::VectorXd& motion, Eigen::VectorXd& q) const = 0;
  /// Length that its displacements are measured by.
  virtual double natural_length() const = 0;
  /// At rest, after the point's forces: adds to `rows` (n_q) and `h` (n_y) the derivatives of the balance and of the
  /// stage rows when the controls move along `du`, by the loads and by all that the controls prescribe.
  virtual void add_load_rate(const IntervalPoint& at, std::span<const double> du, Eigen::VectorXd& rows,
                             Eigen::VectorXd& h) const = 0;
  /// True if positions are prescribed by controls, so that the values at the end of an interval matter.
  virtual bool moves() const = 0;
  /// Zeroes the rows of the balance that are not the part's to solve: prescribed positions, and those that follow
  /// bodies.
  virtual void keep_free(Eigen::VectorXd& rows) const = 0;
  /// Adds to the rows of bodies A^T times the rows of the positions that follow them, x = A q. These keep their values,
  /// which in the rows of constraint forces are the forces of the ties on the part; so call it once, before a
  /// projection, and keep_free after it.
  virtual void gather(Eigen::VectorXd& rows) const = 0;
  /// Writes into a velocity (n_q) what is not free: where positions are prescribed theirs under controls that change at
  /// the rates `du` (n_controls; empty: held), where they follow bodies A times the entries of these.
  virtual void follow(std::span<const double> du, Eigen::VectorXd& velocity) const = 0;
  /// Work of `force` (n_q) at the positions that are prescribed along `motion` (n_q).
  virtual double work_of_prescribed(const Eigen::VectorXd& force, const Eigen::VectorXd& motion) const = 0;
  /// rows += the impulse on the slice that the multipliers of the velocity equations need: with `impulse` (n_y) as
  /// their solver gives it, M v + this = p but for what holds prescribed positions.
  virtual void add_multiplier_impulse(const Eigen::VectorXd& q, const Eigen::VectorXd& impulse,
                                      Eigen::VectorXd& rows) const {
    static_cast<void>(q), static_cast<void>(impulse), static_cast<void>(rows);
  }

  /// True if the part has constraints on velocities; adds minus these to the stage rows: -dg/dq v with the weights of
  /// the velocity equations, h (n_y).
  virtual bool add_velocity_rows(const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& h) const {
    static_cast<void>(q), static_cast<void>(v), static_cast<void>(h);
    return false;
  }

  /// Empty, or where a configuration q (n_q) that can be computed has a shape that the discretisation does not resolve.
  virtual std::string unresolved(const Eigen::VectorXd& q) const {
    static_cast<void>(q);
    return {};
  }

  /// What iterative evaluations start from, and which thus decides their last bits: a restart needs it.
  virtual Eigen::Index n_memory() const = 0;
  virtual void store_memory(Eigen::Ref<Eigen::VectorXd> out) const = 0;
  virtual void restore_memory(const Eigen::Ref<const Eigen::VectorXd>& memory) const = 0;

 protected:
  Slice q_;
  Slice y_;
};

}  // namespace muldi::model
