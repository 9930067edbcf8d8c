/// Two-point elements feel neither where nor how the frame stands, and keep the momenta.
#include "derivatives/muscles/battery.hpp"

namespace muldi {
namespace {

using muscles::PointForces;

template <class Element>
class ElementSymmetry : public testing::Test {};
TYPED_TEST_SUITE(ElementSymmetry, test::TypesOf<muscles::TwoPointTypes>::type);

TYPED_TEST(ElementSymmetry, ForcesTurnWithARigidMotion) {
  std::mt19937 random(31);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    for (int k = 0; k < 10; ++k) {
      const auto x = test::random_state<TypeParam::n_controls>(random);
      const Eigen::Matrix3d R = test::random_rotation(random);
      const Eigen::Vector3d shift = test::random_vector(random, 100.0);
      auto moved = x;
      moved.a1 = R * x.a1 + shift;
      moved.a2 = R * x.a2 + shift;
      moved.v1 = R * x.v1;
      moved.v2 = R * x.v2;
      PointForces here;
      PointForces there;
      muscles::point_forces(element, x, here);
      muscles::point_forces(element, moved, there);
      for (const int first : {0, 3}) {
        const double size = 1.0 + here.force.norm() + here.momentum.norm();
        EXPECT_LE((there.force.segment<3>(first) - R * here.force.segment<3>(first)).norm(), 1e-12 * size);
        EXPECT_LE((there.momentum.segment<3>(first) - R * here.momentum.segment<3>(first)).norm(), 1e-12 * size);
      }
      const auto energy = muscles::as_energy(element);
      EXPECT_NEAR(energy.kinetic(moved), energy.kinetic(x), 1e-12 * (1.0 + energy.kinetic(x)));
      // Near rest large parts of the energy cancel: its round-off is that of a state far from there.
      auto doubled = x;
      doubled.a1 = x.a2 + 2.0 * (x.a1 - x.a2);
      EXPECT_NEAR(energy.elastic(moved), energy.elastic(x),
                  1e-12 * (1.0 + energy.elastic(x) + energy.elastic(doubled)));
    }
  }
}

TYPED_TEST(ElementSymmetry, ForcesKeepLinearAndAngularMomentum) {
  std::mt19937 random(32);
  for (const TypeParam& element : test::examples<TypeParam>()) {
    const auto x = test::random_state<TypeParam::n_controls>(random);
    PointForces out;
    muscles::point_forces(element, x, out);
    const Eigen::Vector3d f1 = out.force.template head<3>();
    const Eigen::Vector3d f2 = out.force.template tail<3>();
    EXPECT_EQ((f1 + f2).norm(), 0.0);
    // Invariance of L under a rotation: sum a x (dL/da + f) + v x dL/dv = 0, since f acts along the line.
    const Eigen::Vector3d p1 = out.momentum.template head<3>();
    const Eigen::Vector3d p2 = out.momentum.template tail<3>();
    const Eigen::Vector3d moment = x.a1.cross(f1) + x.a2.cross(f2) + x.v1.cross(p1) + x.v2.cross(p2);
    EXPECT_LE(moment.norm(), 1e-12 * (f1.norm() * (x.a1.norm() + x.a2.norm()) + p1.norm() * x.v1.norm() + 1.0));
  }
}

}  // namespace
}  // namespace muldi
