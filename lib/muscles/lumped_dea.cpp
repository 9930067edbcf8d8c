#include "muscles/lumped_dea.hpp"

#include "base/text.hpp"

namespace muldi::muscles {

std::string LumpedDea::inadmissible(double z) const {
  const double stretch = z / length;
  if (stretch > least_stretch) return {};
  return base::format("stretch {} below {}", base::number_text(stretch, 8), base::number_text(least_stretch));
}

std::string LumpedDea::advice(double z, double zd, const Controls<double, 1>& field) const {
  const double push = -pull(z, zd, field[0]);
  const double limit = buckling_load(z, field[0]);
  if (push <= limit) return {};
  return base::format(
      "compressed with {} beyond its buckling load {} as a slender pinned rod; a lumped muscle stays straight: where "
      "that matters take `model: fe`, a shorter or thicker muscle, or less compression",
      base::number_text(push, 4), base::number_text(limit, 4));
}

}  // namespace muldi::muscles
