/// The interval terms of muscles and springs: names, weight, energies, work, what they refuse, and one run.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "muscles/free_actuator_term.hpp"
#include "muscles/lumped_dea.hpp"
#include "muscles/spring.hpp"
#include "muscles/two_point_term.hpp"

namespace muldi::muscles {
namespace {

using model::IntervalPoint;
using model::LinearPoint;

constexpr double eps0 = 8.8542e-12;

LumpedDea silicone(double length) {
  return {.shear_modulus = 0.7 / 3.0,
          .viscosity = 0.01,
          .density = 1e-3,
          .length = length,
          .area = 400.0,
          .electric_law = ElectricLaw::ideal(3.7, eps0)};
}

/// One particle at q[0 .. 3) and ground at the origin.
LinearPoint particle() {
  LinearPoint point;
  point.add(0, 0, 1.0);
  return point;
}
LinearPoint origin() { return LinearPoint::constant(Eigen::Vector3d::Zero()); }

TEST(TwoPointTerm, NamesItsPartsByFolderAndName) {
  const TwoPointTerm<LumpedDea> muscles({{"upper", silicone(1.0), particle(), origin()}}, Eigen::Vector3d::Zero());
  EXPECT_EQ(muscles.parts(), std::vector<std::string>{"muscles/upper"});
  const TwoPointTerm<Spring> springs({{"s1", Spring{}, particle(), origin()}}, Eigen::Vector3d::Zero());
  EXPECT_EQ(springs.parts(), std::vector<std::string>{"springs/s1"});
}

TEST(TwoPointTerm, HangsHalfOfItsWeightOnEachEnd) {
  const Eigen::Vector3d gravity(0.0, -9.81e-3, 0.0);
  LumpedDea muscle = silicone(2.0);
  const TwoPointTerm<LumpedDea> term({{"m", muscle, particle(), origin()}}, gravity);
  const Eigen::VectorXd q{{2.0, 0.0, 0.0}};
  const Eigen::VectorXd v = Eigen::VectorXd::Zero(3);
  model::IntervalForces out;
  out.force = Eigen::VectorXd::Zero(3);
  out.momentum = Eigen::VectorXd::Zero(3);
  term.add_forces({q, q, q, v, {}, 1.0}, out);
  // At rest length and without field nothing but the weight acts: m = 0.8 g.
  EXPECT_NEAR((out.force - Eigen::Vector3d(0.0, -0.4 * 9.81e-3, 0.0)).norm(), 0.0, 1e-15);
  const Eigen::VectorXd high{{0.0, 2.0, 0.0}};
  std::array<model::Energy, 1> energy{};
  term.energies({{}, high, v, {}}, energy);
  EXPECT_NEAR(energy[0].gravity, 0.8 * 9.81e-3 * 1.0, 1e-16);  // m g times the height of the middle
}

TEST(TwoPointTerm, AddsToTheEnergiesItIsGiven) {
  const TwoPointTerm<Spring> term({{"s", Spring{.stiffness = 2.0, .rest_length = 1.0}, particle(), origin()}},
                                  Eigen::Vector3d::Zero());
  const Eigen::VectorXd q{{0.0, 4.0, 0.0}};
  const Eigen::VectorXd v = Eigen::VectorXd::Zero(3);
  std::array<model::Energy, 1> energy{{{.elastic = 0.5}}};
  term.energies({{}, q, v, {}}, energy);
  EXPECT_DOUBLE_EQ(energy[0].elastic, 0.5 + 9.0);  // k/2 (4 - 1)^2
}

TEST(TwoPointTerm, WorkOfADamperIsDissipation) {
  const TwoPointTerm<Spring> term(
      {{"s", Spring{.stiffness = 2.0, .rest_length = 1.0, .damping = 0.3}, particle(), origin()}},
      Eigen::Vector3d::Zero());
  const Eigen::VectorXd q{{3.0, 4.0, 0.0}};
  const Eigen::VectorXd v{{0.5, 0.0, 0.7}};  // rate of the length 0.6 * 0.5
  const model::IntervalWork work = term.work({q, q, q, v, {}, 0.1});
  EXPECT_NEAR(work.dissipated, 0.1 * 0.3 * 0.09, 1e-16);
  EXPECT_EQ(work.external, 0.0);
}

TEST(TwoPointTerm, ReadsControlsInTheirOwnUnit) {
  // A layer voltage of 300 V on layers of 10 um is a field of 30 kV/mm.
  TwoPointComponent<LumpedDea> muscle{"m", silicone(1.0), particle(), origin()};
  muscle.controls[0] = {.control = 1, .factor = field_per_layer_voltage(0.01)};
  const Eigen::VectorXd q{{1.0, 0.0, 0.0}};
  const Eigen::VectorXd v = Eigen::VectorXd::Zero(3);
  const std::array<double, 2> u{5.0, 300.0};
  EXPECT_DOUBLE_EQ(muscle.state(q, v, u).e[0], 3e4);
  muscle.controls[0] = {.constant = 2e4};
  EXPECT_DOUBLE_EQ(muscle.state(q, v, u).e[0], 2e4);
}

TEST(TwoPointTerm, SaysWhichElementIsInadmissible) {
  const TwoPointTerm<LumpedDea> muscles({{"lower", silicone(1.0), particle(), LinearPoint::constant({0.0, 5.0, 0.0})},
                                         {"upper", silicone(10.0), particle(), origin()}},
                                        Eigen::Vector3d::Zero());
  EXPECT_EQ(muscles.inadmissible(Eigen::VectorXd{{3.0, 0.0, 0.0}}), "");
  EXPECT_EQ(muscles.inadmissible(Eigen::VectorXd{{1.2, 0.0, 0.0}}), "muscle 'upper': stretch 0.12 below 0.2");
  const TwoPointTerm<Spring> springs({{"s1", Spring{.stiffness = 1.0, .rest_length = 3.0}, particle(), origin()},
                                      {"s2", Spring{.stiffness = 1.0}, particle(), origin()}},
                                     Eigen::Vector3d::Zero());
  EXPECT_EQ(springs.inadmissible(Eigen::VectorXd{{1e-3, 0.0, 0.0}}), "");
  EXPECT_EQ(springs.inadmissible(Eigen::VectorXd::Zero(3)),
            "spring 's1': its ends coincide, so that its force has no direction");
}

TEST(TwoPointTerm, TakesASpringWithoutRestLengthThroughItsOtherEnd) {
  const TwoPointTerm<Spring> springs({{"s2", Spring{.stiffness = 1.0}, particle(), origin()}}, Eigen::Vector3d::Zero());
  EXPECT_EQ(springs.inadmissible(Eigen::VectorXd::Zero(3)), "");
}

/// Length of the membrane after `duration` by the variational midpoint rule from rest at 30 kV/mm.
double membrane_after(double duration, double dt) {
  FreeActuatorTerm<LumpedDea> term({{"m", silicone(1.0), 0, 0, {ControlInput{.constant = 3e4}}}});
  model::PatternRequest request;
  term.request(request);
  const math::BlockPattern pattern({1}, request.pairs());
  term.bind(pattern);
  math::BlockMatrix K(pattern);
  model::IntervalForces out;
  out.force = Eigen::VectorXd::Zero(1);
  out.momentum = Eigen::VectorXd::Zero(1);
  Eigen::VectorXd q0 = Eigen::VectorXd::Ones(1);
  double p = 0.0;
  const int n_steps = static_cast<int>(std::lround(duration / dt));
  for (int n = 0; n < n_steps; ++n) {
    Eigen::VectorXd q1 = q0;
    for (int k = 0; k < 20; ++k) {
      const Eigen::VectorXd q = 0.5 * (q0 + q1);
      const Eigen::VectorXd v = (q1 - q0) / dt;
      const IntervalPoint at{q0, q1, q, v, {}, dt};
      out.force.setZero();
      out.momentum.setZero();
      term.add_forces(at, out);
      K.set_zero();
      term.add_tangent(at, model::TangentWeights::step(dt), K);
      const double step = (p - out.momentum[0] + 0.5 * dt * out.force[0]) / K.block(0, 0)(0, 0);
      q1[0] += step;
      if (std::abs(step) < 1e-13) break;
    }
    p = out.momentum[0] + 0.5 * dt * out.force[0];
    q0 = q1;
  }
  return q0[0];
}

TEST(FreeActuatorTerm, MovesLikeTheMembraneOfTheThesis) {
  // reference-results A: dt 0.01 ms and the limit dt -> 0 of an independent program.
  const double coarse = membrane_after(5.0, 0.01);
  EXPECT_NEAR(coarse, 0.950388186297, 1e-11);
  const double limit = 0.950429037483;
  const double ratio = (coarse - limit) / (membrane_after(5.0, 0.005) - limit);
  EXPECT_NEAR(ratio, 4.0, 0.2);  // second order
}

TEST(FreeActuatorTerm, NamesItsPartsAndWhatItRefuses) {
  const FreeActuatorTerm<LumpedDea> term({{"membrane", silicone(1.0), 0, 0, {}}});
  EXPECT_EQ(term.parts(), std::vector<std::string>{"muscles/membrane"});
  EXPECT_EQ(term.inadmissible(Eigen::VectorXd{{0.9}}), "");
  EXPECT_EQ(term.inadmissible(Eigen::VectorXd{{0.15}}), "muscle 'membrane': stretch 0.15 below 0.2");
}

}  // namespace
}  // namespace muldi::muscles
