#pragma once
/// Keys of a scene as numbers that can be moved, and the derivative by them of what a scene says.
///
/// Everything that depends on a parameter at a frozen motion (residuals of the discrete equations, recorded quantities)
/// is a smooth closed form of it, mostly a polynomial: permittivity, stiffness, viscosity and density enter linearly, a
/// diameter to the fourth power, a rest length as a Laurent polynomial. Its derivative is taken by the central stencil
/// of order 8 at theta (1 + j/128): exact for polynomials to degree 8, and wrong by 1e-13 of the value for powers -4 to
/// 8; round-off of the same size. Nothing that is solved for is ever differenced.
#include <span>
#include <string>
#include <vector>

#include "build/built_model.hpp"
#include "scene/study.hpp"

namespace muldi::pipeline {

/// A scene with one parameter moved.
struct Variant {
  double offset = 0.0;  ///< of the parameter
  double weight = 0.0;  ///< of this variant's value in the derivative
  scene::Scene scene = {};
  build::BuiltModel built = {};
};

class Parameters {
 public:
  /// Reads bounds and starts in the scene's units. InputError with all that is wrong, located in the study.
  Parameters(const scene::CalibrateStudy& study, const scene::SceneText& scene);

  std::size_t size() const { return names_.size(); }
  const std::vector<std::string>& names() const { return names_; }  ///< keys as in the study
  const std::vector<std::string>& units() const { return units_; }  ///< empty where unknown
  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }
  const Eigen::VectorXd& start() const { return start_; }

  /// The values as of --set.
  std::vector<std::string> overrides(const Eigen::VectorXd& theta) const;
  scene::Scene scene_at(const Eigen::VectorXd& theta) const { return text_.read(overrides(theta)); }
  /// The variants whose weighted sum is the derivative by parameter k. InputError if the scene takes no value on either
  /// side.
  std::vector<Variant> variants(const Eigen::VectorXd& theta, std::size_t k) const;

 private:
  const scene::SceneText& text_;
  std::vector<std::string> names_;
  std::vector<std::string> units_;
  std::vector<std::vector<std::string>> targets_;
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  Eigen::VectorXd start_;
};

/// sum over variants of weight * value(variant, i).
template <class Value>
auto derivative(std::span<const Variant> variants, const Value& value) {
  auto sum = (variants[0].weight * value(variants[0], 0)).eval();
  for (std::size_t i = 1; i < variants.size(); ++i) sum += variants[i].weight * value(variants[i], i);
  return sum;
}

}  // namespace muldi::pipeline
