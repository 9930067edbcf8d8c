#pragma once
/// Numbers for the directions of derivative checks.
#include <Eigen/Core>
#include <cstdint>

namespace muldi::math {

/// The same numbers in [-1, 1) on every machine.
class CheckNumbers {
 public:
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11U) * 0x1.0p-52 - 1.0;
  }
  Eigen::VectorXd vector(Eigen::Index n) {
    Eigen::VectorXd values(n);
    for (double& value : values) value = next();
    return values;
  }

 private:
  std::uint64_t state_ = 1;
};

}  // namespace muldi::math
