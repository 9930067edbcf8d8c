#pragma once
/// The points of a sweep.
#include <string>
#include <vector>

#include "scene/study.hpp"

namespace muldi::pipeline {

struct DesignPoint {
  std::vector<std::string> overrides = {};  ///< as of --set
  std::vector<std::string> texts = {};      ///< value of each key as written
  std::vector<double> numbers = {};         ///< in the scene's units; NaN where it is no number
};

/// What a sweep does, checked against the scene.
struct SweepPlan {
  std::vector<std::string> keys = {};   ///< as in the study
  std::vector<std::string> units = {};  ///< of the keys, where known
  std::vector<DesignPoint> points = {};
};

/// The points in their order, each read once as a scene: InputError with all that is wrong, located in the study.
SweepPlan plan_sweep(const scene::SweepStudy& study, const scene::SceneText& scene);

}  // namespace muldi::pipeline
