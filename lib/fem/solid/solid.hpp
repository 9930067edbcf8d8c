#pragma once
/// A finite-element solid as a substructure of the model (numerics 1.4).
///
/// Stage unknowns: the potentials of all nodes if there is a field, then the element pressures p_e of every formulation
/// but `displacement`. With c = dt for the incompressible formulations (dt/2 in the first interval of a run, where the
/// node has half the weight) and dt/2 for mean dilatation, the impulse of a
/// pressure on node n is -c V_e p_e g_e(r_n), that on node n+1 the same with g_e(r_{n+1}) for mean dilatation and none
/// for the incompressible ones. Rows of the pressures, times minus one in the residual:
///     c V_e (J_e(r_{n+1}) - 1)            incompressible,
///     dt V_e (U'(J) - p_e) / U''(J),      mean dilatation, J = (J_e(r_n) + J_e(r_{n+1}))/2,
/// and at rest V_e (J_e - 1) and V_e (U'(J_e) - p_e) / U''(J_e).
#include <memory>

#include "fem/solid/bonds.hpp"
#include "fem/solid/potential_solver.hpp"
#include "fem/solid/pressure_filter.hpp"
#include "fem/solid/solid_loads.hpp"
#include "fem/solid/solid_unknowns.hpp"
#include "fem/solid/ties.hpp"
#include "fem/solid/volumes.hpp"
#include "model/substructure.hpp"

namespace muldi::fem {

/// Evaluations use work space of the solid: one at a time.
class Solid final : public model::Substructure {
 public:
  explicit Solid(SolidDescription data);

  const SolidDescription& data() const { return data_; }
  const ElementSet& elements() const { return elements_; }
  const SolidUnknowns& unknowns() const { return unknowns_; }
  const Ties& ties() const { return ties_; }
  const Bonds& bonds() const { return bonds_; }
  /// The solids that this one is made of, in the order of their nodes: itself, or several that are fixed to one
  /// another.
  const std::vector<Member>& members() const { return data_.members; }
  /// The member that a cell belongs to.
  const Member& member_of_cell(int cell) const;
  /// Name of a member's energy part, and of the folder of its results.
  std::string part(const Member& member) const { return data_.part.empty() ? "solids/" + member.name : data_.part; }
  bool has_pressures() const { return data_.formulation != Formulation::displacement; }
  bool is_incompressible() const {
    return data_.formulation == Formulation::incompressible || data_.formulation == Formulation::incompressible_direct;
  }
  Eigen::Index n_potentials() const { return unknowns_.has_field() ? elements_.n_nodes() : 0; }
  Eigen::Index n_pressures() const { return has_pressures() ? elements_.n_cells() : 0; }
  bool is_viscous() const;
  /// V_e (n_cells).
  const Eigen::VectorXd& cell_volumes() const { return V_; }
  /// Pressures that exert no force; none but in the incompressible formulations.
  const PressureFilter& filter() const { return filter_; }
  const SolidLoads& loads() const { return loads_; }
  /// The largest potential so far.
  double potential_scale() const { return potential_scale_; }
  /// What the user should know of the solid before it moves, or empty.
  std::string note() const;
  /// A cell as messages name it: its number and the middle of its reference.
  std::string place_of_cell(int cell) const;
  /// U of the mean dilatation, U' and U'' at J for a cell.
  struct Dilation {
    double U = 0.0;
    double pressure = 0.0;
    double stiffness = 0.0;
  };
  Dilation dilation(int cell, double J) const;
  /// c of the file's head: the weight of a pressure at the begin of an interval.
  double pressure_weight(const model::IntervalPoint& at) const;
  /// Natural sizes: diagonal of the reference, and shear modulus of the stiffest material.
  double size() const { return size_; }
  double shear_modulus() const { return shear_modulus_; }
  /// Total reference mass.
  double mass() const { return mass_; }
  /// Centre of mass of a member at a configuration of the whole system (n_q).
  Eigen::Vector3d centre_of_mass(const Member& member, const Eigen::VectorXd& q) const;

  /// Views of the slices in vectors of the whole system.
  Eigen::Ref<const Eigen::VectorXd> positions(const Eigen::VectorXd& q) const { return q.segment(q_.first, q_.size); }
  Eigen::Ref<Eigen::VectorXd> positions(Eigen::VectorXd& q) const { return q.segment(q_.first, q_.size); }
  Eigen::Ref<const Eigen::VectorXd> potentials(const Eigen::VectorXd& y) const {
    return y.segment(y_.first, n_potentials());
  }
  Eigen::Ref<Eigen::VectorXd> potentials(Eigen::VectorXd& y) const { return y.segment(y_.first, n_potentials()); }
  Eigen::Ref<const Eigen::VectorXd> pressures(const Eigen::VectorXd& y) const {
    return y.segment(y_.first + n_potentials(), n_pressures());
  }
  Eigen::Ref<Eigen::VectorXd> pressures(Eigen::VectorXd& y) const {
    return y.segment(y_.first + n_potentials(), n_pressures());
  }
  /// Fields of an evaluation in the middle of an interval, or at rest.
  ElementFields fields(const model::IntervalPoint& at) const;
  /// Mean dilatations at a configuration; the last two that were asked for are kept.
  const Volumes& volumes_at(const Eigen::Ref<const Eigen::VectorXd>& x) const;
  /// Potentials in equilibrium at a configuration under the controls; those of the last call are kept.
  const Eigen::VectorXd& potentials_at(const Eigen::Ref<const Eigen::VectorXd>& x, std::span<const double> u) const;
  /// Gradient of the enthalpy by the potentials at a configuration, gathered and accounted for by members: minus the
  /// charges that the supply has put there.
  Eigen::VectorXd charge_rows(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::VectorXd& phi) const;
  /// Charge that a unit of potential brings onto the conductor of these nodes at a configuration, where all other given
  /// potentials and charges stay as they are: with all of them given potentials, a diagonal entry of Maxwell's matrix.
  /// `floats`: its charge is given, not its potential. NaN if the potentials are not found.
  double capacitance(const Eigen::Ref<const Eigen::VectorXd>& x, const std::vector<int>& nodes, bool floats) const;

  // Substructure
  model::PartLimits add_part_forces(const model::IntervalPoint& at, model::IntervalForces& out) const override;
  void start(Eigen::VectorXd& q, Eigen::VectorXd& y) const override;
  void place(const model::Placement& at, Eigen::VectorXd& q, Eigen::VectorXd& y) const override;
  void settle_stage(const model::IntervalPoint& at, Eigen::VectorXd& y) const override;
  std::unique_ptr<model::SubstructureSolver> make_solver(model::Linearisation kind,
                                                         const std::string& name) const override;
  /// InputError if the named solver cannot serve the solid.
  void check_solver(const std::string& name) const;
  model::SolverSize solver_size(model::Linearisation kind, const std::string& name) const override;
  model::IncrementSize size_of(const Eigen::VectorXd& dq, const Eigen::VectorXd& dy) const override;
  double deformation(const Eigen::VectorXd& q, const Eigen::VectorXd& dq) const override;
  void carry(const Eigen::VectorXd& before, const Eigen::VectorXd& motion, Eigen::VectorXd& q) const override {
    ties_.add_shared(q_.first, before, motion, 1.0, positions(q));
    bonds_.follow(3, positions(q));
  }
  double natural_length() const override { return size_; }
  void add_load_rate(const model::IntervalPoint& at, std::span<const double> du, Eigen::VectorXd& rows,
                     Eigen::VectorXd& h) const override;
  void keep_free(Eigen::VectorXd& rows) const override;
  void gather(Eigen::VectorXd& rows) const override {
    bonds_.gather(3, positions(rows));
    ties_.gather(q_.first, rows);
  }
  void follow(std::span<const double> du, Eigen::VectorXd& velocity) const override;
  double work_of_prescribed(const Eigen::VectorXd& force, const Eigen::VectorXd& motion) const override;
  bool moves() const override { return unknowns_.moves(); }
  void add_multiplier_impulse(const Eigen::VectorXd& q, const Eigen::VectorXd& impulse,
                              Eigen::VectorXd& rows) const override;
  bool add_velocity_rows(const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& h) const override;
  std::string unresolved(const Eigen::VectorXd& q) const override;
  Eigen::Index n_memory() const override;
  void store_memory(Eigen::Ref<Eigen::VectorXd> out) const override;
  void restore_memory(const Eigen::Ref<const Eigen::VectorXd>& memory) const override;

  // IntervalTerm
  void request(model::PatternRequest& pattern) const override;
  void bind(const math::BlockPattern&) override {}
  void add_tangent(const model::IntervalPoint&, const model::TangentWeights&, math::BlockMatrix&) const override {}
  void add_control_force(const model::IntervalPoint& at, int control, Eigen::VectorXd& out) const override;
  model::IntervalWork work(const model::IntervalPoint& at) const override;
  std::vector<std::string> parts() const override;
  void energies(const model::NodePoint& at, std::span<model::Energy> out) const override;
  std::string inadmissible(const Eigen::VectorXd& q) const override;
  /// Steps check the Gauss points in their middle; this looks at the nodes in time.
  std::string advice(const model::NodePoint& at) const override { return inadmissible(at.q); }

 private:
  void add_volume_step(const model::IntervalPoint& at, model::IntervalForces& out, model::PartLimits& limits) const;
  void add_volume_rest(const model::IntervalPoint& at, model::IntervalForces& out, model::PartLimits& limits) const;

  SolidDescription data_;
  ElementSet elements_;
  SolidUnknowns unknowns_;
  Ties ties_;
  Bonds bonds_;
  SolidLoads loads_;
  const Eigen::VectorXd& V_;  // of elements_
  double size_ = 0.0;
  double shear_modulus_ = 0.0;
  double mass_ = 0.0;
  std::unique_ptr<PotentialSolver> potential_solver_;
  PressureFilter filter_;

  mutable Eigen::VectorXd force_;
  mutable Eigen::VectorXd momentum_;
  mutable Eigen::VectorXd charge_;
  mutable Eigen::VectorXd weight_;  // one a cell
  mutable Volumes volumes_[2];
  mutable int last_volumes_ = 0;
  mutable Eigen::VectorXd phi_;
  mutable std::vector<ElementEnergies> energies_;  // of the materials
  mutable double potential_scale_ = 0.0;           // the largest potential so far
};

}  // namespace muldi::fem
