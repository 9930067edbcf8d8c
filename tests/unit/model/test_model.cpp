/// The model as a sum of terms: pattern, controls, energies in order, momentum maps.
#include <gtest/gtest.h>

#include <array>

#include "model/model.hpp"

namespace muldi::model {
namespace {

/// A linear spring to ground on unknown `node` (one unknown a node), with its own mass, damper and drive.
class Oscillator final : public IntervalTerm {
 public:
  Oscillator(int node, double mass, std::vector<std::string> parts)
      : node_(node), mass_(mass), parts_(std::move(parts)) {}

  void request(PatternRequest& pattern) const override { pattern.add_pair(node_, 0); }
  void bind(const math::BlockPattern& pattern) override { slot_ = pattern.slot(node_, node_); }
  void add_forces(const IntervalPoint& at, IntervalForces& out) const override {
    out.force[node_] += -3.0 * at.q[node_] - 0.5 * at.v[node_] + at.u[0];
    out.momentum[node_] += mass_ * at.v[node_];
  }
  void add_tangent(const IntervalPoint&, const TangentWeights& w, math::BlockMatrix& K) const override {
    *K.data(slot_) += w.vv * mass_ - w.qq * 3.0 - w.qv * 0.5;
  }
  void add_control_force(const IntervalPoint&, int, Eigen::VectorXd& out) const override { out[node_] += 1.0; }
  IntervalWork work(const IntervalPoint& at) const override {
    return {.dissipated = 0.5 * at.dt * at.v[node_] * at.v[node_], .external = at.dt * at.u[0] * at.v[node_]};
  }
  std::vector<std::string> parts() const override { return parts_; }
  void energies(const NodePoint& at, std::span<Energy> out) const override {
    for (Energy& part : out) part += {.elastic = 1.5 * at.q[node_] * at.q[node_]};
  }
  std::string inadmissible(const Eigen::VectorXd& q) const override {
    return q[node_] > 10.0 ? "oscillator " + std::to_string(node_) : std::string();
  }

 private:
  int node_;
  double mass_;
  std::vector<std::string> parts_;
  math::BlockSlot slot_;
};

Model two_oscillators() {
  Model model;
  model.node_sizes = {1, 1};
  model.terms.push_back(std::make_unique<Oscillator>(0, 2.0, std::vector<std::string>{"a"}));
  model.terms.push_back(std::make_unique<Oscillator>(1, 5.0, std::vector<std::string>{"b", "c"}));
  model.controls.push_back({"u", base::dimension::force, 4.0});
  model.bind();
  return model;
}

const Eigen::VectorXd q{{1.0, 2.0}};
const Eigen::VectorXd v{{0.5, -1.0}};

TEST(Model, BindsThePatternOfAllTerms) {
  const Model model = two_oscillators();
  EXPECT_TRUE(model.pattern->contains(1, 0));
  EXPECT_EQ(model.pattern->n_rows(), 2);
}

TEST(Model, SumsForcesTangentsAndWorkOfItsTerms) {
  const Model model = two_oscillators();
  const std::array<double, 1> u{4.0};
  const IntervalPoint at{.q0 = q, .q1 = q, .q = q, .v = v, .u = u, .dt = 0.1};
  IntervalForces out{Eigen::VectorXd::Constant(2, 9.0), Eigen::VectorXd::Constant(2, 9.0)};  // overwritten
  model.forces(at, out);
  EXPECT_EQ(out.force, Eigen::Vector2d(-3.0 - 0.25 + 4.0, -6.0 + 0.5 + 4.0));
  EXPECT_EQ(out.momentum, Eigen::Vector2d(1.0, -5.0));
  math::BlockMatrix K(*model.pattern);
  model.tangent(at, TangentWeights::step(0.1), K);
  // M/dt + dt/4 k + d/2, numerics 1.4.
  EXPECT_NEAR(K.dense()(0, 0), 20.0 + 0.025 * 3.0 + 0.25, 1e-14);
  EXPECT_NEAR(K.dense()(1, 1), 50.0 + 0.025 * 3.0 + 0.25, 1e-14);
  EXPECT_EQ(K.dense()(0, 1), 0.0);
  EXPECT_NEAR(model.work(at).dissipated, 0.5 * 0.1 * 1.25, 1e-16);
  EXPECT_NEAR(model.work(at).external, 4.0 * 0.1 * -0.5, 1e-16);
}

TEST(Model, WeightsOfMassAndStiffnessPickOneDerivativeEach) {
  const Model model = two_oscillators();
  const std::array<double, 1> u{0.0};
  const IntervalPoint at{.q0 = q, .q1 = q, .q = q, .v = v, .u = u, .dt = 0.1};
  math::BlockMatrix K(*model.pattern);
  model.tangent(at, TangentWeights::mass(), K);
  EXPECT_EQ(K.dense(), (Eigen::Matrix2d() << 2.0, 0.0, 0.0, 5.0).finished());
  model.tangent(at, TangentWeights::stiffness(), K);
  EXPECT_EQ(K.dense(), (Eigen::Matrix2d() << 3.0, 0.0, 0.0, 3.0).finished());
}

TEST(Model, GivesEachTermItsOwnEnergyRows) {
  const Model model = two_oscillators();
  EXPECT_EQ(model.parts(), (std::vector<std::string>{"a", "b", "c"}));
  std::array<Energy, 3> energy{{{.elastic = 7.0}, {}, {}}};  // overwritten
  model.energies({.x = {}, .q = q, .v = v, .u = {}}, energy);
  EXPECT_EQ(energy[0].elastic, 1.5);
  EXPECT_EQ(energy[1].elastic, 6.0);
  EXPECT_EQ(energy[2].elastic, 6.0);
  EXPECT_EQ(energy[2].potential(), 6.0);
}

TEST(Model, TellsTheFirstReasonWhyAConfigurationIsInadmissible) {
  const Model model = two_oscillators();
  EXPECT_EQ(model.inadmissible(q), "");
  EXPECT_EQ(model.inadmissible(Eigen::Vector2d(0.0, 11.0)), "oscillator 1");
  EXPECT_EQ(model.inadmissible(Eigen::Vector2d(12.0, 11.0)), "oscillator 0");
}

TEST(Model, EvaluatesItsControlsAtATime) {
  Model model = two_oscillators();
  model.controls.push_back({"ramp", base::dimension::none,
                            base::TimeFunction(base::Ramp{.from = 0.0, .to = 2.0, .start = 1.0, .over = 4.0})});
  std::vector<double> u(2);
  model.evaluate_controls(2.0, u);
  EXPECT_EQ(u, (std::vector<double>{4.0, 0.5}));
}

TEST(Model, MomentumMapsAreThoseOfTheRigidBody) {
  // One node of twelve: position, then three directors; one single unknown that carries neither map.
  Model model;
  model.node_sizes = {12, 1};
  model.bind();
  Eigen::VectorXd at = Eigen::VectorXd::Zero(13);
  at.head<3>() << 1.0, 2.0, 3.0;
  at.segment<3>(3) << 1.0, 0.0, 0.0;
  at[12] = 5.0;
  Eigen::VectorXd p = Eigen::VectorXd::Zero(13);
  p.head<3>() << 0.0, 4.0, 0.0;
  p.segment<3>(3) << 0.0, 2.0, 0.0;
  p[12] = 100.0;
  Eigen::Vector3d linear;
  Eigen::Vector3d angular;
  model.momentum_maps(at, p, linear, angular);
  EXPECT_EQ(linear, Eigen::Vector3d(0.0, 4.0, 0.0));
  EXPECT_EQ(angular, Eigen::Vector3d(-12.0, 0.0, 4.0 + 2.0));
}

}  // namespace
}  // namespace muldi::model
