#include "scene/orientation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace muldi::scene {
namespace {

Mat3 matrix(const OrientationForm& form) {
  Mat3 result{};
  EXPECT_EQ(to_matrix(form, result), "");
  return result;
}

void expect_near(const Mat3& a, const Mat3& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(a[i][j], b[i][j], 4e-16) << i << j;  // two roundings near one
  }
}

const double pi = std::acos(-1.0);
const double half = std::sqrt(0.5);
const Mat3 quarter_about_z{{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};

TEST(Orientation, RightAnglesAreExact) {
  EXPECT_EQ(matrix({.axis = Vec3{0, 0, 3}, .angle = pi / 2}), quarter_about_z);
  EXPECT_EQ(matrix({.axis = Vec3{0, 1, 0}, .angle = -pi}), (Mat3{{{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}}));
  EXPECT_EQ(matrix({.axis = Vec3{0, 1, 0}, .angle = pi / 2}), (Mat3{{{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}}));
  EXPECT_EQ(matrix({.axis = Vec3{1, 2, 3}, .angle = 0.0}), identity);
}

TEST(Orientation, TurnsAboutAnyAxis) {
  // A third of a turn about the diagonal permutes the axes.
  expect_near(matrix({.axis = Vec3{1, 1, 1}, .angle = 2 * pi / 3}), {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}});
}

TEST(Orientation, EulerTurnsAboutFixedXThenYThenZ) {
  // x to y about z after x to -z about y: the body's x axis points along -z, its z axis along y.
  expect_near(matrix({.euler = Vec3{0, pi / 2, pi / 2}}), {{{0, -1, 0}, {0, 0, 1}, {-1, 0, 0}}});
  expect_near(matrix({.euler = Vec3{pi / 2, 0, 0}}), {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}});
}

TEST(Orientation, QuaternionIsScalarFirst) {
  expect_near(matrix({.quaternion = std::array{half, 0.0, 0.0, half}}), quarter_about_z);
}

TEST(Orientation, MatrixIsKeptOrMadeOrthonormal) {
  EXPECT_EQ(matrix({.matrix = quarter_about_z}), quarter_about_z);
  const double c = 0.7071068;  // seven digits
  expect_near(matrix({.matrix = Mat3{{{c, -c, 0}, {c, c, 0}, {0, 0, 1}}}}),
              {{{half, -half, 0}, {half, half, 0}, {0, 0, 1}}});
}

TEST(Orientation, RefusesWhatIsNoRotation) {
  Mat3 m{};
  EXPECT_EQ(to_matrix({}, m), "needs one of {axis, angle}, {euler}, {quaternion}, {matrix}");
  EXPECT_EQ(to_matrix({.angle = 1.0}, m), "needs both axis and angle");
  EXPECT_EQ(to_matrix({.axis = Vec3{0, 0, 0}, .angle = 1.0}, m), "the axis is zero");
  EXPECT_EQ(to_matrix({.quaternion = std::array{1.0, 1.0, 0.0, 0.0}}, m),
            "the quaternion needs norm 1, it has 1.41421");
}

}  // namespace
}  // namespace muldi::scene
