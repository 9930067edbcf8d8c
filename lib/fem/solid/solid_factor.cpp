#include "fem/solid/solid_factor.hpp"

#include <algorithm>

#include "base/memory.hpp"
#include "base/text.hpp"
#include "fem/solid/solid_package.hpp"

namespace muldi::fem {
namespace {

/// Refuses a factor that the machine cannot hold, before anything of it is allocated.
const math::LdltAnalysis& affordable(const math::LdltAnalysis& analysis) {
  const math::LdltSize& size = analysis.size();
  base::require_memory(static_cast<double>(size.factor_bytes + size.work_bytes),
                       base::format("the factorised matrix of a solid with {} unknowns", size.n_unknowns),
                       "take fewer cells");
  return analysis;
}

}  // namespace

SolidFactor::SolidFactor(const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
                         std::vector<std::vector<int>> electrodes, math::FactorStorage storage, int expected_negative)
    : SolidLinear(pattern, mask, std::move(electrodes)),
      analysis_(pattern, mask),
      factor_(affordable(analysis_), storage),
      expected_negative_(expected_negative) {}

std::string factor_name(math::Ordering ordering) { return "ldlt (" + std::string(name_of(ordering)) + ")"; }

std::string SolidFactor::name() const { return factor_name(size().ordering); }

int SolidFactor::factorise_free() {
  pivoted_ = false;
  const math::LdltOutcome outcome = factor_.factorise(matrix_);
  const bool whole = outcome.ok && outcome.smallest_ratio >= singular_pivot;
  if (whole && outcome.largest_ratio <= grown_pivot) return outcome.n_negative;
  if (analysis_.size().n_unknowns > most_pivoted) return whole ? outcome.n_negative : -1;
  return factorise_pivoted(whole ? outcome.n_negative : expected_negative_);
}

/// Of a balanced copy: the border is made of the matrix as it is.
int SolidFactor::factorise_pivoted(int expected) {
  if (!lu_) {
    lu_.emplace();
    balanced_.emplace(matrix_.pattern());
    full_ = math::full_matrix(*balanced_);
  }
  std::copy(matrix_.values().begin(), matrix_.values().end(), balanced_->values().begin());
  scale_ = balance_potentials(*balanced_, mask_);
  balanced_->constrain(mask_, 1.0);
  math::refill(full_, *balanced_);
  const int n_negative = factorise_with_pivoting(full_, expected, *lu_);
  pivoted_ = n_negative >= 0;
  return n_negative;
}

void SolidFactor::solve_free(Eigen::VectorXd& x) {
  if (!pivoted_) return factor_.solve(x);
  if (scale_ != 1.0) scale_potentials(scale_, x);
  rhs_ = x;
  lu_->solve(rhs_, x);
  if (scale_ != 1.0) scale_potentials(scale_, x);
}

void SolidFactor::solve_free_columns(Eigen::MatrixXd& x) {
  if (!pivoted_) return factor_.solve_columns(x);
  SolidLinear::solve_free_columns(x);
}

}  // namespace muldi::fem
