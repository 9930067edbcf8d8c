#pragma once
/// What a calibration fits to: curves over time, load or stretch, from a result file or a table.
#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/units.hpp"
#include "scene/study.hpp"

namespace muldi::pipeline {

/// What is compared, and what it is a function of.
enum class AxisKind { time, load, stretch };

/// One compared data set, in the scene's units.
struct ReferenceCurve {
  std::string name = {};  ///< as in the study
  AxisKind axis = AxisKind::time;
  std::string path = {};        ///< data set of the result, with dots; of a material its name
  long component = -1;          ///< -1: all
  Eigen::VectorXd at = {};      ///< times, loads or stretches (n)
  Eigen::MatrixXd values = {};  ///< (n, components)
  std::string unit = {};        ///< empty where unknown
  double weight = 1.0;
  double scale = 1.0;
  scene::Origin origin = {};
};

/// Reads all curves of a study. `units`: of the scene. InputError with all that is wrong, located in the study.
std::vector<ReferenceCurve> read_references(const scene::CalibrateStudy& study, const base::UnitSystem& units);

}  // namespace muldi::pipeline
