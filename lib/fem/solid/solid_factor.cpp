#include "fem/solid/solid_factor.hpp"

#include "base/memory.hpp"
#include "base/text.hpp"

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
                         std::vector<std::vector<int>> electrodes, math::FactorStorage storage)
    : SolidLinear(pattern, mask, std::move(electrodes)),
      analysis_(pattern, mask),
      factor_(affordable(analysis_), storage) {}

std::string factor_name(math::Ordering ordering) { return "ldlt (" + std::string(name_of(ordering)) + ")"; }

std::string SolidFactor::name() const { return factor_name(size().ordering); }

int SolidFactor::factorise_free() {
  const math::LdltOutcome outcome = factor_.factorise(matrix_);
  return outcome.ok && outcome.smallest_ratio >= singular_pivot ? outcome.n_negative : -1;
}

}  // namespace muldi::fem
