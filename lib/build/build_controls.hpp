#pragma once
/// Controls of the model: those of the scene by name, then one for every function of time that stands where it acts.
#include <string>
#include <string_view>
#include <vector>

#include "model/model.hpp"
#include "scene/scene.hpp"

namespace muldi::build {

/// Where a force takes its value from: control index (or -1) and the constant value if there is none.
struct ControlValue {
  int control = -1;
  double constant = 0.0;
};

/// The word of a quantity in scenes.
std::string_view word_of(scene::ControlQuantity quantity);

class ControlTable {
 public:
  explicit ControlTable(const scene::Scene& scene);

  /// Index of a named control.
  int index(const std::string& name) const;
  /// A named control, a constant, or a new control for a function of time.
  ControlValue value_of(const scene::Drive& drive, base::Dimension unit, const std::string& owner);

  std::vector<model::Control> take() { return std::move(controls_); }
  std::size_t n_named() const { return n_named_; }

 private:
  std::vector<model::Control> controls_;
  std::size_t n_named_ = 0;
};

}  // namespace muldi::build
