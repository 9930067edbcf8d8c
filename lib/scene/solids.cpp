// What solids compute from themselves.
#include "scene/solids.hpp"

#include <algorithm>

namespace muldi::scene {

std::vector<MaterialName> SolidMaterial::names() const {
  if (parts.empty()) return {whole};
  std::vector<MaterialName> all;
  for (const Entry<MaterialName>& part : parts) all.push_back(part.value);
  return all;
}

bool has_field(const Solid& solid) {
  return !solid.electrodes.empty() ||
         std::any_of(solid.conditions.begin(), solid.conditions.end(),
                     [](const Condition& condition) { return condition.potential || condition.surface_charge; });
}

std::vector<std::string> face_names_of(const fem::MeshType& mesh) {
  return std::visit(
      [](const auto& of) -> std::vector<std::string> {
        if constexpr (requires { of.face_names(); }) return of.face_names();
        return {};
      },
      mesh);
}

std::vector<std::string> part_names_of(const fem::MeshType& mesh) {
  return std::visit(
      [](const auto& of) -> std::vector<std::string> {
        if constexpr (requires { of.part_names(); }) return of.part_names();
        return {};
      },
      mesh);
}

}  // namespace muldi::scene
