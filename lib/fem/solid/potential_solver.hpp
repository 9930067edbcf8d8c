#pragma once
/// Potentials in electrostatic equilibrium at a given configuration: R_phi(x, phi) = 0.
///
/// Newton with conjugate gradients on the exact operator; the preconditioner is a factor that is kept as long as it
/// serves, so that repeated solves near one configuration cost a few back substitutions. On large meshes the residual
/// alone is exact: the operator is a kept matrix, and multigrid the preconditioner.
#include <Eigen/Core>
#include <memory>
#include <optional>

#include "fem/solid/element_set.hpp"
#include "fem/solid/solid_factor.hpp"
#include "fem/solid/solid_unknowns.hpp"
#include "math/aggregation_multigrid.hpp"

namespace muldi::fem {

class PotentialSolver {
 public:
  /// All must outlive the solver. For solids with free potentials.
  PotentialSolver(const ElementSet& elements, const SolidUnknowns& unknowns, const SolidDescription& data,
                  const Bonds& bonds);

  /// Moves the free entries of phi (n_nodes) to equilibrium at x; `surface_charge` (n_nodes) is the charge put on the
  /// nodes. False if it does not converge.
  bool solve(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::VectorXd& surface_charge,
             Eigen::Ref<Eigen::VectorXd> phi);

  /// Where the factor was made: with it a restart makes the same one.
  Eigen::Index n_memory() const { return 1 + factor_x_.size() + factor_phi_.size(); }
  void store_memory(Eigen::Ref<Eigen::VectorXd> out) const;
  void restore_memory(const Eigen::Ref<const Eigen::VectorXd>& memory);

 private:
  void factorise(const Eigen::Ref<const Eigen::VectorXd>& x, const Eigen::Ref<const Eigen::VectorXd>& phi);
  void multiply(const ElementFields& at, const Eigen::VectorXd& d, Eigen::VectorXd& out) const;
  void precondition(const Eigen::VectorXd& r, Eigen::VectorXd& z);
  int conjugate_gradients(const ElementFields& at);
  void condense(Eigen::VectorXd& rows) const;

  const ElementSet& elements_;
  const SolidUnknowns& unknowns_;
  const SolidDescription& data_;
  const Bonds& bonds_;
  /// Of a small mesh.
  struct Factor {
    math::SymmetricBlockPattern pattern;
    std::vector<std::int32_t> slots;
    BondFold fold;
    SolidFactor factor;

    explicit Factor(const PotentialSolver& of);
  };
  math::SymmetricBlockPattern pattern() const;
  /// Of a large mesh: the kept operator, without fixed and floating potentials, times `sign`.
  struct Multigrid {
    math::DoubleCsr matrix;
    math::AggregationMultigrid cycle;
    double sign;
    Eigen::VectorXf r, z;
  };
  bool is_large() const { return factor_ == nullptr; }
  void make_multigrid(const ElementFields& at);

  std::unique_ptr<Factor> factor_;
  std::optional<Multigrid> multigrid_;
  bool factorised_ = false;
  Eigen::VectorXd factor_x_;  // where it was made
  Eigen::VectorXd factor_phi_;
  Eigen::VectorXd r_;
  Eigen::VectorXd z_;
  Eigen::VectorXd d_;
  Eigen::VectorXd Ad_;
  Eigen::VectorXd step_;
  Eigen::VectorXd full_;
};

}  // namespace muldi::fem
