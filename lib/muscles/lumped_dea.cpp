#include "muscles/lumped_dea.hpp"

#include "base/text.hpp"

namespace muldi::muscles {

std::string LumpedDea::inadmissible(double z) const {
  const double stretch = z / length;
  if (stretch > least_stretch) return {};
  return base::format("stretch {} below {}", base::number_text(stretch, 4), base::number_text(least_stretch));
}

}  // namespace muldi::muscles
