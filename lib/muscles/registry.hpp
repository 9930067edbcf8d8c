#pragma once
/// The components of this folder: elements for the builder and the typed tests, described fields for the reader.
#include "base/describe.hpp"
#include "muscles/lumped_dea.hpp"
#include "muscles/section.hpp"
#include "muscles/spring.hpp"

namespace muldi::muscles {

/// Elements between two points; each type present in a model becomes one term.
using TwoPointTypes = base::TypeList<LumpedDea, Spring>;

}  // namespace muldi::muscles
