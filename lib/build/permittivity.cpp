#include "build/permittivity.hpp"

namespace muldi::build {

muscles::ElectricLaw electric_law(const scene::Material& material, double eps0) {
  if (!material.electric) return {};
  return std::visit(
      [eps0](const auto& law) {
        if constexpr (requires { law.relative_permittivity; }) {
          return muscles::ElectricLaw::ideal(law.relative_permittivity, eps0);
        } else if constexpr (requires { law.c3; }) {
          return muscles::ElectricLaw::invariants(law.c1, law.c2, law.c3, eps0);
        } else {
          return muscles::ElectricLaw::vu(law.c1, law.c2, eps0);
        }
      },
      material.electric->law);
}

double force_permittivity(const scene::Scene& scene, const scene::Material& material, double stretch) {
  const double eps0 = scene.units.eps0();
  return muscles::force_permittivity(electric_law(material, eps0), stretch, eps0);
}

double capacity_permittivity(const scene::Scene& scene, const scene::Material& material, double stretch) {
  const double eps0 = scene.units.eps0();
  return muscles::capacity_permittivity(electric_law(material, eps0), stretch, eps0);
}

}  // namespace muldi::build
