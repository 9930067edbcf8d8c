#include "fem/solid/face_overlap.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fem/solid/face_projection.hpp"

namespace muldi::fem {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Overlaps smaller than this part of a face are round-off, and so is what a face may lack of being covered.
constexpr double no_part = 1e-9;

double cross(const Vector2d& a, const Vector2d& b) { return a[0] * b[1] - a[1] * b[0]; }

double area(const std::vector<Vector2d>& polygon) {
  double twice = 0.0;
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    twice += cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
  }
  return 0.5 * twice;
}

/// Part of a convex polygon on the left of the line from a to b (Sutherland and Hodgman 1974).
std::vector<Vector2d> cut(const std::vector<Vector2d>& polygon, const Vector2d& a, const Vector2d& b) {
  std::vector<Vector2d> left;
  left.reserve(polygon.size() + 1);
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector2d& from = polygon[k];
    const Vector2d& to = polygon[(k + 1) % polygon.size()];
    const double height = cross(b - a, from - a);
    const double next = cross(b - a, to - a);
    if (height >= 0.0) left.push_back(from);
    if ((height > 0.0 && next < 0.0) || (height < 0.0 && next > 0.0)) {
      left.emplace_back(from + height / (height - next) * (to - from));
    }
  }
  return left;
}

bool is_convex(const std::vector<Vector2d>& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vector2d along = polygon[(k + 1) % n] - polygon[k];
    if (!(cross(along, polygon[(k + 2) % n] - polygon[(k + 1) % n]) > 0.0)) return false;
  }
  return true;
}

struct TrianglePoint {
  double weight;  // of the triangle's area
  std::array<double, 3> at;
};

/// Exact for polynomials of degree five (Radon 1948).
std::array<TrianglePoint, 7> triangle_points() {
  const double root = std::sqrt(15.0);
  const double a = (6.0 - root) / 21.0;
  const double b = (6.0 + root) / 21.0;
  const double of_a = (155.0 - root) / 1200.0;
  const double of_b = (155.0 + root) / 1200.0;
  const double third = 1.0 / 3.0;
  return {{{0.225, {third, third, third}},
           {of_a, {a, a, 1.0 - 2.0 * a}},
           {of_a, {a, 1.0 - 2.0 * a, a}},
           {of_a, {1.0 - 2.0 * a, a, a}},
           {of_b, {b, b, 1.0 - 2.0 * b}},
           {of_b, {b, 1.0 - 2.0 * b, b}},
           {of_b, {1.0 - 2.0 * b, b, b}}}};
}

/// Gauss's three points on [0, 1] with their weights.
std::array<std::pair<double, double>, 3> line_points() {
  const double half = 0.5 * std::sqrt(0.6);
  return {{{0.5 - half, 5.0 / 18.0}, {0.5, 8.0 / 18.0}, {0.5 + half, 5.0 / 18.0}}};
}

}  // namespace

struct FaceOverlap::Plane {
  Vector3d origin;
  Eigen::Matrix<double, 3, 2> axes;
  Vector3d normal;

  Vector2d in(const Vector3d& x) const { return axes.transpose() * (x - origin); }
  Vector3d out(const Vector2d& x) const { return origin + axes * x; }
  double height(const Vector3d& x) const { return normal.dot(x - origin); }
};

FaceOverlap::FaceOverlap(const Eigen::VectorXd& X, const std::vector<FaceNodes>& others, double tolerance)
    : X_(X), others_(others), tolerance_(tolerance) {}

FaceOverlap::Corners FaceOverlap::corners(const FaceNodes& face) const {
  Corners all;
  for (std::size_t a = 0; a < 4; ++a) all.col(static_cast<Eigen::Index>(a)) = at(face[a]);
  return all;
}

std::vector<int> FaceOverlap::near(const Corners& face) const {
  const auto ball = [](const Corners& x) {
    const Vector3d centre = x.rowwise().mean();
    return std::pair{centre, (x.colwise() - centre).colwise().norm().maxCoeff()};
  };
  const auto [centre, radius] = ball(face);
  std::vector<int> found;
  for (std::size_t k = 0; k < others_.size(); ++k) {
    const auto [of_other, reach] = ball(corners(others_[k]));
    if ((of_other - centre).norm() <= radius + reach + tolerance_) found.push_back(static_cast<int>(k));
  }
  return found;
}

std::optional<FaceOverlap::Plane> FaceOverlap::plane_of(const Corners& face) const {
  const Vector3d normal = (face.col(2) - face.col(0)).cross(face.col(3) - face.col(1));
  if (!(normal.norm() > 0.0)) return std::nullopt;
  Plane plane{.origin = face.rowwise().mean(), .axes = {}, .normal = normal.normalized()};
  plane.axes.col(0) = (face.col(2) - face.col(0)).normalized();
  plane.axes.col(1) = plane.normal.cross(plane.axes.col(0));
  return plane;
}

std::optional<FaceOverlap::Polygon> FaceOverlap::outline(const Plane& plane, const Corners& face) const {
  Polygon polygon;
  polygon.reserve(4);
  for (int a = 0; a < 4; ++a) {
    if (std::abs(plane.height(face.col(a))) > tolerance_) return std::nullopt;
    polygon.push_back(plane.in(face.col(a)));
  }
  if (area(polygon) < 0.0) std::reverse(polygon.begin(), polygon.end());
  if (!is_convex(polygon)) return std::nullopt;
  return polygon;
}

bool FaceOverlap::one_holds(const FaceNodes& face) const {
  const Corners x = corners(face);
  const std::vector<int> candidates = near(x);
  return std::any_of(candidates.begin(), candidates.end(), [&](int k) {
    const Corners other = corners(others_[static_cast<std::size_t>(k)]);
    for (int a = 0; a < 4; ++a) {
      if (project_on_face(x.col(a), other).distance > tolerance_) return false;
    }
    return true;
  });
}

void FaceOverlap::add_points(const Polygon& polygon, const Plane& plane, const Corners& face, int other,
                             std::vector<OverlapPoint>& points) const {
  static const std::array<TrianglePoint, 7> of_triangle = triangle_points();
  const Corners others = corners(others_[static_cast<std::size_t>(other)]);
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const double size = 0.5 * cross(polygon[k - 1] - polygon[0], polygon[k] - polygon[0]);
    for (const TrianglePoint& point : of_triangle) {
      const Vector3d x = plane.out(point.at[0] * polygon[0] + point.at[1] * polygon[k - 1] + point.at[2] * polygon[k]);
      points.push_back({.weight = size * point.weight,
                        .own = project_on_face(x, face).weights,
                        .other = other,
                        .others = project_on_face(x, others).weights});
    }
  }
}

std::optional<std::vector<OverlapPoint>> FaceOverlap::on_face(const FaceNodes& face) const {
  const Corners x = corners(face);
  const std::optional<Plane> plane = plane_of(x);
  if (!plane) return std::nullopt;
  const std::optional<Polygon> whole = outline(*plane, x);
  if (!whole) return std::nullopt;
  std::vector<OverlapPoint> points;
  double covered = 0.0;
  for (const int k : near(x)) {
    const std::optional<Polygon> other = outline(*plane, corners(others_[static_cast<std::size_t>(k)]));
    if (!other) continue;
    Polygon part = *whole;
    for (std::size_t a = 0; a < 4; ++a) part = cut(part, (*other)[a], (*other)[(a + 1) % 4]);
    const double size = part.size() < 3 ? 0.0 : area(part);
    if (size <= no_part * area(*whole)) continue;
    covered += size;
    add_points(part, *plane, x, k, points);
  }
  // Gaps of the tolerance between faces, and slivers left out, do not count.
  const double slack = 8.0 * (no_part + tolerance_ / std::sqrt(area(*whole))) * area(*whole);
  if (std::abs(covered - area(*whole)) > slack) return std::nullopt;
  return points;
}

std::optional<std::vector<OverlapPoint>> FaceOverlap::on_edge(int a, int b, const FaceNodes& face) const {
  const Corners x = corners(face);
  const std::optional<Plane> plane = plane_of(x);
  if (!plane) return std::nullopt;
  const std::vector<int> candidates = near(x);
  const Vector2d from = plane->in(at(a));
  const Vector2d along = plane->in(at(b)) - from;
  std::vector<double> breaks = {0.0, 1.0};
  for (const int k : candidates) {
    const std::optional<Polygon> other = outline(*plane, corners(others_[static_cast<std::size_t>(k)]));
    if (!other) continue;
    for (std::size_t c = 0; c < 4; ++c) {
      const Vector2d side = (*other)[(c + 1) % 4] - (*other)[c];
      const double sine = cross(along, side);
      if (std::abs(sine) <= no_part * along.norm() * side.norm()) continue;
      const double t = cross((*other)[c] - from, side) / sine;
      if (t > 0.0 && t < 1.0) breaks.push_back(t);
    }
  }
  std::sort(breaks.begin(), breaks.end());
  std::vector<OverlapPoint> points;
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    const double length = breaks[i] - breaks[i - 1];
    if (length <= no_part) continue;
    const Vector3d middle = at(a) + 0.5 * (breaks[i] + breaks[i - 1]) * (at(b) - at(a));
    const auto holder = std::find_if(candidates.begin(), candidates.end(), [&](int k) {
      return project_on_face(middle, corners(others_[static_cast<std::size_t>(k)])).distance <= tolerance_;
    });
    if (holder == candidates.end()) return std::nullopt;
    const Corners other = corners(others_[static_cast<std::size_t>(*holder)]);
    for (const auto& [place, weight] : line_points()) {
      const double t = breaks[i - 1] + place * length;
      points.push_back({.weight = weight * length * along.norm(),
                        .own = {1.0 - t, t, 0.0, 0.0},
                        .other = *holder,
                        .others = project_on_face(at(a) + t * (at(b) - at(a)), other).weights});
    }
  }
  return points;
}

}  // namespace muldi::fem
