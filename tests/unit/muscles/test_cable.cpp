/// The cable: slack, transition, taut, and its damper.
#include "muscles/cable.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "muscles/two_point_term.hpp"

namespace muldi::muscles {
namespace {

constexpr Cable cable{.stiffness = 2.0, .rest_length = 100.0, .damping = 0.5, .transition = 4.0};

double tension(double z, double zd = 0.0, const Cable& of = cable) { return pull(of, AxialState<0>{.z = z, .zd = zd}); }

TEST(Cable, HasNoForceWhereItIsSlack) {
  for (const double z : {0.0, 50.0, 99.999, 100.0}) {
    for (const double zd : {-3.0, 0.0, 3.0}) EXPECT_EQ(tension(z, zd), 0.0);
    EXPECT_EQ(cable.elastic(z), 0.0);
  }
}

TEST(Cable, IsALinearSpringWhereItIsTaut) {
  EXPECT_DOUBLE_EQ(tension(104.0), 2.0 * (4.0 - 2.0));  // half the transition is lost
  EXPECT_DOUBLE_EQ(tension(120.0), 2.0 * (20.0 - 2.0));
  EXPECT_DOUBLE_EQ(tension(120.0, 0.4), 2.0 * (20.0 - 2.0) + 0.5 * 0.4);
  EXPECT_EQ(axial_derivatives(cable, 120.0, 0.0, Controls<double, 0>{}).l_zz, -2.0);
}

TEST(Cable, TightensWithASmoothStiffness) {
  EXPECT_DOUBLE_EQ(tension(102.0), 2.0 * 4.0 * (0.125 - 0.03125));  // w (s^3 - s^4/2) at s = 1/2
  for (const double knot : {100.0, 104.0}) {
    const auto below = axial_derivatives(cable, knot - 1e-7, 0.0, Controls<double, 0>{});
    const auto above = axial_derivatives(cable, knot + 1e-7, 0.0, Controls<double, 0>{});
    // The stiffness has a bend of 6 k/w^2 and no step.
    EXPECT_NEAR(below.l_z, above.l_z, 1e-6);
    EXPECT_NEAR(below.l_zz, above.l_zz, 1e-12);
    EXPECT_NEAR(cable.elastic(knot - 1e-7), cable.elastic(knot + 1e-7), 1e-6);
  }
}

TEST(Cable, NeverPushesHoweverFastItShortens) {
  for (const double z : {100.001, 100.5, 103.0, 104.0, 110.0}) {
    double last = tension(z);
    for (const double zd : {-0.01, -1.0, -10.0, -100.0, -1e4}) {
      const double now = tension(z, zd);
      EXPECT_GE(now, 0.0);
      EXPECT_LE(now, last);
      last = now;
    }
  }
  // Slowly, the damper is linear: (1 + (D/N)^4)^(-1/4) of D = 0.05, N = 36.
  EXPECT_NEAR(tension(120.0, -0.1), 36.0 - 0.05, 1e-12);
}

TEST(Cable, MayHaveNoTransition) {
  const Cable sharp{.stiffness = 2.0, .rest_length = 100.0};
  EXPECT_EQ(tension(100.0, 0.0, sharp), 0.0);
  EXPECT_EQ(tension(101.0, 0.0, sharp), 2.0);
  EXPECT_EQ(sharp.elastic(101.0), 1.0);
}

TEST(Cable, MayBeSlackWhereItsEndsCoincide) {
  model::LinearPoint particle;
  particle.add(0, 0, 1.0);
  const TwoPointTerm<Cable> term({{"c", cable, particle, model::LinearPoint::constant(Eigen::Vector3d::Zero())}},
                                 Eigen::Vector3d::Zero());
  const Eigen::VectorXd origin = Eigen::VectorXd::Zero(3);
  const Eigen::VectorXd v{{0.1, 0.2, 0.3}};
  EXPECT_EQ(term.inadmissible(origin), "");
  model::IntervalForces out;
  out.force = Eigen::VectorXd::Zero(3);
  out.momentum = Eigen::VectorXd::Zero(3);
  term.add_forces({origin, origin, origin, v, {}, 1.0}, out);
  EXPECT_EQ(out.force.norm(), 0.0);
  EXPECT_EQ(out.momentum.norm(), 0.0);
  EXPECT_EQ(term.inadmissible(Eigen::VectorXd{{std::nan(""), 0.0, 0.0}}), "spring 'c': its length is not finite");
}

TEST(CableSpring, TakesItsDefaultsFromThePose) {
  const CableSpring said{.stiffness = 3.0};
  const Cable element = said.element(50.0);
  EXPECT_EQ(element.rest_length, 50.0);
  EXPECT_EQ(element.transition, 0.5);
  const CableSpring all{.stiffness = 3.0, .rest_length = 20.0, .damping = 1.0, .transition = 2.0};
  EXPECT_EQ(all.element(50.0).rest_length, 20.0);
  EXPECT_EQ(all.element(50.0).transition, 2.0);
  EXPECT_TRUE(all.element(50.0).dissipates());
}

}  // namespace
}  // namespace muldi::muscles
