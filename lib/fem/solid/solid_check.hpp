#pragma once
/// The derivatives of a solid, handed over for checks on a user's own scene.
#include <functional>
#include <string>
#include <vector>

#include "fem/solid/solid.hpp"

namespace muldi::fem {

/// Where a solid is looked at: a state of the whole system, controls with their names, and the length of a step.
struct SolidProbe {
  const Eigen::VectorXd& q;
  const Eigen::VectorXd& y;
  const std::vector<double>& u;
  const std::vector<std::string>& control_names;
  double dt = 0.0;
};

/// Takes what is differentiated, a function along a line s -> f(s) in steps up to 1, and its given derivative at s = 0.
using DerivativeSink = std::function<void(const std::string& of, const std::function<Eigen::VectorXd(double)>& f,
                                          const Eigen::VectorXd& given)>;

/// Stress and charge as derivatives of the energy, their own derivatives (viscous stress included) and the matrix that
/// is made of these, the equations of rest and of a step with pressures and loads, and how they change with the
/// controls; at a roughly distorted mesh, in directions that touch all unknowns.
void check_solid(const Solid& solid, const SolidProbe& probe, const DerivativeSink& sink);

}  // namespace muldi::fem
