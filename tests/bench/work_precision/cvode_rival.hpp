#pragma once
/// SUNDIALS CVODE on the joint-coordinate equations.
#include <string>

#include "bench/work_precision/integrators.hpp"

namespace muldi::bench {

enum class CvodeMethod { adams, bdf };

/// Integrates from rest, adaptively in step and order, and interpolates to the samples.
Samples integrate_with_cvode(const MinimalSystem& system, CvodeMethod method, double tolerance, const Grid& grid);

std::string cvode_version();
std::string name_of(CvodeMethod method);
std::string options_of(CvodeMethod method);

}  // namespace muldi::bench
