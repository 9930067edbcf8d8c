#include "build/build_controls.hpp"

#include "base/error.hpp"

namespace muldi::build {

ControlTable::ControlTable(const scene::Scene& scene) : n_named_(scene.controls.size()) {
  for (const auto& entry : scene.controls) {
    controls_.push_back({entry.name, scene::dimension_of(entry.value.quantity), entry.value.value});
  }
}

int ControlTable::index(const std::string& name) const {
  for (std::size_t i = 0; i < n_named_; ++i) {
    if (controls_[i].name == name) return static_cast<int>(i);
  }
  MULDI_EXPECT(false, "the reader has checked that the control exists");
  return -1;
}

ControlValue ControlTable::value_of(const scene::Drive& drive, base::Dimension unit, const std::string& owner) {
  if (!drive.control.name.empty()) return {.control = index(drive.control.name)};
  if (drive.value.is_constant()) return {.constant = drive.value.at(0.0)};
  controls_.push_back({owner, unit, drive.value});
  return {.control = static_cast<int>(controls_.size()) - 1};
}

std::string_view word_of(scene::ControlQuantity quantity) {
  for (const auto& word : scene::words(quantity)) {
    if (word.value == quantity) return word.word;
  }
  return {};
}

}  // namespace muldi::build
