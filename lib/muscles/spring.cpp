#include "muscles/spring.hpp"

#include <cmath>

namespace muldi::muscles {

std::string Spring::inadmissible(double z) const {
  if (!std::isfinite(z)) return "its length is not finite";
  const bool linear = rest_length == 0.0 && damping == 0.0;
  // Nearer than round-off of the ends' positions the direction is noise.
  if (linear || (z > 0.0 && z > 1e-12 * rest_length)) return {};
  return "its ends coincide, so that its force has no direction";
}

}  // namespace muldi::muscles
