// Which formulation goes with which material.
#include "scene/formulation.hpp"

#include "base/text.hpp"

namespace muldi::scene {

Formulation formulation_of(const std::optional<Formulation>& said, const Material& material) {
  if (said) return *said;
  return material.elastic.incompressible() ? Formulation::incompressible : Formulation::mean_dilatation;
}

std::string why_unfit(Formulation formulation, const Elastic& elastic, const std::string& name) {
  const std::string shown_name = base::in_quotes(name);
  if (std::holds_alternative<BonetWood>(elastic.law) && formulation != Formulation::displacement) {
    return "material " + shown_name +
           " is bonet_wood, which goes with `formulation: displacement` only; the others take neo_hookean";
  }
  if (!elastic.incompressible()) return {};
  if (formulation == Formulation::displacement) {
    return "displacement needs a compressible material, but Poisson's ratio of " + shown_name +
           " is 0.5: take incompressible";
  }
  if (formulation == Formulation::mean_dilatation) {
    return "mean_dilatation needs a compressible material, but Poisson's ratio of " + shown_name +
           " is 0.5: take incompressible";
  }
  return {};
}

}  // namespace muldi::scene
