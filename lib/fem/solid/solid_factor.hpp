#pragma once
/// The factorised matrix of a solid.
#include <string>
#include <vector>

#include "fem/solid/solid_linear.hpp"
#include "math/sparse_ldlt.hpp"

namespace muldi::fem {

class SolidFactor final : public SolidLinear {
 public:
  /// Arguments of SolidLinear. EnvironmentError if the machine cannot hold the factor.
  SolidFactor(const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
              std::vector<std::vector<int>> electrodes,
              math::FactorStorage storage = math::FactorStorage::double_precision);

  double accuracy() const override { return 0.0; }
  std::string name() const override;
  const math::LdltSize& size() const { return analysis_.size(); }

 private:
  int factorise_free() override;
  void solve_free(Eigen::VectorXd& x) override { factor_.solve(x); }
  void solve_free_columns(Eigen::MatrixXd& x) override { factor_.solve_columns(x); }

  math::LdltAnalysis analysis_;
  math::SparseLdlt factor_;
};

/// "ldlt (ordering)".
std::string factor_name(math::Ordering ordering);

/// Smallest pivot, relative to the diagonal entry of the matrix, below which a matrix counts as singular.
inline constexpr double singular_pivot = 1e-14;

}  // namespace muldi::fem
