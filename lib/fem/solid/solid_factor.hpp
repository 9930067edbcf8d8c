#pragma once
/// The factorised matrix of a solid: our own factor without pivoting, and where it fails UMFPACK's with pivoting.
#include <Eigen/SparseCore>
#include <optional>
#include <string>
#include <vector>

#include "fem/solid/solid_linear.hpp"
#include "math/sparse_ldlt.hpp"
#include "math/sparse_lu.hpp"

namespace muldi::fem {

class SolidFactor final : public SolidLinear {
 public:
  /// Arguments of SolidLinear; `expected_negative`: negative pivots that the potentials must have. EnvironmentError if
  /// the machine cannot hold the factor.
  SolidFactor(const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
              std::vector<std::vector<int>> electrodes,
              math::FactorStorage storage = math::FactorStorage::double_precision, int expected_negative = 0);

  double accuracy() const override { return 0.0; }
  std::string name() const override;
  const math::LdltSize& size() const { return analysis_.size(); }
  /// True if the present factor is UMFPACK's.
  bool is_pivoted() const { return pivoted_; }

 private:
  int factorise_free() override;
  int factorise_pivoted(int expected);
  void solve_free(Eigen::VectorXd& x) override;
  void solve_free_columns(Eigen::MatrixXd& x) override;

  math::LdltAnalysis analysis_;
  math::SparseLdlt factor_;
  int expected_negative_;
  bool pivoted_ = false;
  // Of the fallback, made when it is needed.
  std::optional<math::SparseLu> lu_;
  std::optional<math::SymmetricBlockMatrix> balanced_;
  Eigen::SparseMatrix<double> full_;
  Eigen::VectorXd rhs_;
  double scale_ = 1.0;
};

/// "ldlt (ordering)".
std::string factor_name(math::Ordering ordering);

/// Smallest pivot, relative to the diagonal entry of the matrix, below which a matrix counts as singular.
inline constexpr double singular_pivot = 1e-14;
/// Largest pivot, relative to the same, above which growth has cost a factor its digits.
inline constexpr double grown_pivot = 1e9;
/// Unknowns up to which a factor with pivoting is tried in its place: beyond, it takes minutes.
inline constexpr int most_pivoted = 30000;

}  // namespace muldi::fem
