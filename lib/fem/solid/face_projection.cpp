#include "fem/solid/face_projection.hpp"

#include <algorithm>
#include <cmath>

namespace muldi::fem {
namespace {

using Eigen::Vector2d;
using Eigen::Vector4d;

constexpr int most_iterations = 30;
constexpr int sweeps = 30;
constexpr double finest_change = 1e-15;

Vector4d shapes(const Vector2d& at) {
  const double xi = at[0];
  const double eta = at[1];
  return 0.25 * Vector4d((1 - xi) * (1 - eta), (1 + xi) * (1 - eta), (1 + xi) * (1 + eta), (1 - xi) * (1 + eta));
}

/// Of the shape functions along one coordinate.
Vector4d slopes(const Vector2d& at, int along) {
  if (along == 0) return 0.25 * Vector4d(-(1 - at[1]), 1 - at[1], 1 + at[1], -(1 + at[1]));
  return 0.25 * Vector4d(-(1 - at[0]), -(1 + at[0]), 1 + at[0], 1 - at[0]);
}

}  // namespace

FaceProjection project_on_face(const Eigen::Vector3d& point, const Eigen::Matrix<double, 3, 4>& corners) {
  Vector2d at = Vector2d::Zero();
  const auto clamp = [](double value) { return std::clamp(value, -1.0, 1.0); };
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    Eigen::Matrix<double, 3, 2> J;
    for (int i = 0; i < 2; ++i) J.col(i) = corners * slopes(at, i);
    const Eigen::Matrix2d gram = J.transpose() * J;
    const double determinant = gram.determinant();
    if (!(std::abs(determinant) > 0.0)) break;
    const Vector2d step = gram.inverse() * (J.transpose() * (point - corners * shapes(at)));
    const Vector2d next = (at + step).unaryExpr(clamp);
    const double change = (next - at).lpNorm<Eigen::Infinity>();
    at = next;
    if (change <= finest_change) break;
  }
  // On the rim the other coordinate alone counts, and the face is straight along it.
  for (int sweep = 0; sweep < sweeps && at.lpNorm<Eigen::Infinity>() == 1.0; ++sweep) {
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector3d tangent = corners * slopes(at, i);
      if (!(tangent.squaredNorm() > 0.0)) continue;
      at[i] = clamp(at[i] + tangent.dot(point - corners * shapes(at)) / tangent.squaredNorm());
    }
  }
  FaceProjection found;
  const Vector4d N = shapes(at);
  std::copy(N.data(), N.data() + 4, found.weights.begin());
  found.distance = (point - corners * N).norm();
  return found;
}

}  // namespace muldi::fem
