#pragma once
/// Volumes kept exactly by many responses at once: conjugate gradients on the volume rows, a recurrence for each column
/// and one solve with the factor for all.
#include <Eigen/Core>

#include "fem/solid/solid_linear.hpp"
#include "fem/solid/volumes.hpp"

namespace muldi::fem {

/// What the factor of an augmented matrix let through, c V_e and D_e of its volume rows.
struct VolumeRows {
  const ElementSet& elements;
  const Volumes& volumes;
  const Eigen::VectorXd& coupling;
  const Eigen::VectorXd& compliance;
  /// Part of the compliance that stays, which bounds pressures with hardly any force.
  double proximal = 0.0;
  /// Of the rows, and the iterations after which they are given up.
  double relative_accuracy = 0.0;
  int most_iterations = 0;
};

class ExactResponses {
 public:
  /// W: solutions of the augmented equations, in blocks of the factor; takes the motion out of them that changes
  /// volumes, and writes the pressures P which do that. False if the volume rows are not positive definite, as beyond a
  /// loss of stability, or not done in time; W and P are then useless.
  bool keep_volumes(const VolumeRows& rows, SolidLinear& linear, Eigen::MatrixXd& W, Eigen::MatrixXd& P);

 private:
  /// out = c B x, and x = A^-1 B^T c p.
  static void project(const VolumeRows& rows, int block, const Eigen::MatrixXd& x, Eigen::MatrixXd& out);
  static void respond(const VolumeRows& rows, SolidLinear& linear, const Eigen::MatrixXd& p, Eigen::MatrixXd& x);

  Eigen::MatrixXd x_, r_, z_, d_, product_;
};

}  // namespace muldi::fem
