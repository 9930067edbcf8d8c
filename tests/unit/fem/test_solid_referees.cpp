/// Solids in motion against equations that are solved otherwise, in other frames, and under loads that follow them.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>
#include <iostream>
#include <string>

#include "support/solid_cubes.hpp"
#include "variational/stepper.hpp"

namespace muldi::fem {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double mu = test::cube_mu;

/// Of the cubes here.
Material material_of(Formulation formulation) { return test::viscous_dielectric(formulation, 20.0, 0.05); }

/// A distorted cube on symmetry planes with 30 kV between its ends.
test::SolidSystem cube_on_symmetry_planes(Formulation formulation) {
  test::SolidSystem system = test::charged_cube(test::on_electrode_with_edge, 3e4);
  system.hold_lower_faces();
  system.fill(material_of(formulation), mu, formulation);
  return system;
}

/// Formulation III before its reduction (numerics 1.4): positions, potential, dilatation J~, pressure p with J = J~ and
/// multiplier lambda with J~ = 1, all at once, by Newton's method with a dense matrix of differences.
class FiveFields {
 public:
  FiveFields(const model::Model& model, double dt, const variational::State& start)
      : model_(model), solid_(test::solid_in(model)), dt_(dt), q0_(start.q), q1_(start.q), y_(start.y), p0_(start.p) {
    model.substructures.front()->place({.u = {}, .u_end = {}}, q1_, y_);
    forces_.force = forces_.momentum = forces_.begin = forces_.end = VectorXd::Zero(q1_.size());
    forces_.stage = VectorXd::Zero(y_.size());
    const auto& mask = solid_.unknowns().mask();
    for (std::size_t node = 0; node < mask.size(); ++node) {
      for (int i = 0; i < 4; ++i) {
        if ((mask[node] >> i & 1) != 0) continue;
        (i < 3 ? free_x_ : free_phi_).push_back(static_cast<Eigen::Index>(node) * (i < 3 ? 3 : 1) + i % 3 * (i < 3));
      }
    }
    const Eigen::Index n = solid_.n_pressures();
    dilatation_ = VectorXd::Ones(n);
    pressure_ = multiplier_ = VectorXd::Zero(n);
  }

  void step() {
    for (int iteration = 0; iteration < 6; ++iteration) {
      const VectorXd z = unknowns();
      const VectorXd r = rows(z);
      Eigen::MatrixXd A(z.size(), z.size());
      for (Eigen::Index k = 0; k < z.size(); ++k) {
        const double h = 1e-5;
        VectorXd moved = z;
        moved[k] += h;
        const VectorXd up = rows(moved);
        moved[k] -= 2.0 * h;
        A.col(k) = (up - rows(moved)) / (2.0 * h);
      }
      rows(z - A.partialPivLu().solve(r));
    }
    p0_ = forces_.momentum + 0.5 * dt_ * forces_.force;
    q0_ = q1_;
    first_ = false;
  }

  const VectorXd& q() const { return q1_; }
  const VectorXd& dilatation() const { return dilatation_; }
  const VectorXd& pressure() const { return pressure_; }
  const VectorXd& multiplier() const { return multiplier_; }

 private:
  static constexpr double volt = 1e4;

  VectorXd unknowns() const {
    const auto n_x = static_cast<Eigen::Index>(free_x_.size());
    const auto n_phi = static_cast<Eigen::Index>(free_phi_.size());
    VectorXd z(n_x + n_phi + 3 * dilatation_.size());
    for (Eigen::Index k = 0; k < n_x; ++k) z[k] = q1_[free_x_[static_cast<std::size_t>(k)]];
    for (Eigen::Index k = 0; k < n_phi; ++k) {
      z[n_x + k] = solid_.potentials(y_)[free_phi_[static_cast<std::size_t>(k)]] / volt;
    }
    z.tail(3 * dilatation_.size()) << dilatation_, pressure_, multiplier_;
    return z;
  }

  VectorXd rows(const VectorXd& z) {
    const auto n_x = static_cast<Eigen::Index>(free_x_.size());
    const auto n_phi = static_cast<Eigen::Index>(free_phi_.size());
    const Eigen::Index n = dilatation_.size();
    for (Eigen::Index k = 0; k < n_x; ++k) q1_[free_x_[static_cast<std::size_t>(k)]] = z[k];
    for (Eigen::Index k = 0; k < n_phi; ++k) {
      solid_.potentials(y_)[free_phi_[static_cast<std::size_t>(k)]] = volt * z[n_x + k];
    }
    dilatation_ = z.segment(n_x + n_phi, n);
    pressure_ = z.segment(n_x + n_phi + n, n);
    multiplier_ = z.tail(n);
    // All but the volumes by the model, with its own pressures at zero.
    solid_.pressures(y_).setZero();
    q_ = 0.5 * (q0_ + q1_);
    v_ = (q1_ - q0_) / dt_;
    model_.forces({.q0 = q0_, .q1 = q1_, .q = q_, .v = v_, .u = {}, .dt = dt_, .y = &y_, .first = first_}, forces_);
    VectorXd balance = p0_ + 0.5 * dt_ * forces_.force - forces_.momentum;
    const VectorXd weight = -(first_ ? 0.5 : 1.0) * dt_ * solid_.cell_volumes().cwiseProduct(pressure_);
    VectorXd of_pressures = VectorXd::Zero(q1_.size());
    const Volumes begin = solid_.volumes_at(q0_);
    begin.add_gradients(solid_.elements(), weight, of_pressures);
    balance += of_pressures;
    VectorXd all(z.size());
    for (Eigen::Index k = 0; k < n_x; ++k) all[k] = balance[free_x_[static_cast<std::size_t>(k)]];
    for (Eigen::Index k = 0; k < n_phi; ++k) {
      all[n_x + k] = volt * solid_.potentials(forces_.stage)[free_phi_[static_cast<std::size_t>(k)]];
    }
    const Volumes end = solid_.volumes_at(q1_);
    all.tail(3 * n) << pressure_ - multiplier_, end.J - dilatation_, dilatation_ - VectorXd::Ones(n);
    return all;
  }

  const model::Model& model_;
  const Solid& solid_;
  double dt_;
  VectorXd q0_, q1_, q_, v_, y_, p0_;
  VectorXd dilatation_, pressure_, multiplier_;
  model::IntervalForces forces_;
  std::vector<Eigen::Index> free_x_, free_phi_;
  bool first_ = true;
};

TEST(SolidReferees, TheReducedIncompressibleFormulationIsThatOfFiveFields) {
  const double dt = 5e-3;
  for (const Formulation formulation : {Formulation::incompressible, Formulation::incompressible_direct}) {
    const auto model = test::make_model(cube_on_symmetry_planes(formulation));
    const Solid& solid = test::solid_in(*model);
    variational::State state = test::moving_state(*model, dt);
    FiveFields referee(*model, dt, state);
    const VectorXd start = state.q;
    variational::Stepper stepper(*model, dt, {.tolerance = 1e-13});
    for (int step = 0; step < 5; ++step) {
      const variational::StepReport report = stepper.advance(state, {});
      ASSERT_EQ(report.status, variational::Status::running) << report.sentence;
      referee.step();
      EXPECT_LT((referee.q() - state.q).lpNorm<Eigen::Infinity>(), 1e-11) << step;
      const VectorXd pressures = solid.pressures(state.y);
      const double size = pressures.lpNorm<Eigen::Infinity>();
      EXPECT_GT(size, 1e-3);
      // Over dt^2 times the accuracy of the positions.
      EXPECT_LT((referee.pressure() - pressures).lpNorm<Eigen::Infinity>(), 1e-6 * size) << step;
      EXPECT_LT((referee.pressure() - referee.multiplier()).lpNorm<Eigen::Infinity>(), 1e-12 * size);
      EXPECT_LT((referee.dilatation().array() - 1.0).abs().maxCoeff(), 1e-13);
    }
    EXPECT_GT((state.q - start).lpNorm<Eigen::Infinity>(), 1e-3);
  }
}

/// A free, charged, spinning cube of distorted cells, turned and shifted, with a boost.
VectorXd free_motion(Formulation formulation, const Matrix3d& R, const Vector3d& shift, const Vector3d& boost) {
  test::SolidSystem system = test::charged_cube(test::on_electrode_with_edge, 3e4);
  VectorXd v = test::spin(system, {0.3, -0.2, 0.5});
  for (Eigen::Index k = 0; k < v.size(); k += 3) {
    system.solid.X.segment<3>(k) = R * system.solid.X.segment<3>(k) + shift;
    v.segment<3>(k) = R * v.segment<3>(k) + boost;
  }
  system.fill(material_of(formulation), mu, formulation);
  const auto model = test::make_model(system);
  const double dt = 2e-2;
  variational::State state = test::moving_state(*model, dt, v);
  variational::Stepper stepper(*model, dt, {.tolerance = 1e-12});
  while (state.step < 20) {
    const variational::StepReport report = stepper.advance(state, {});
    EXPECT_EQ(report.status, variational::Status::running) << report.sentence;
    if (report.status != variational::Status::running) break;
  }
  return state.q;
}

TEST(SolidReferees, AMovedFrameGivesTheMovedMotion) {
  const Matrix3d R = (Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized())).toRotationMatrix();
  const Vector3d shift(3.0, -5.0, 2.0), boost(0.4, 0.1, -0.3);
  for (const Formulation formulation : test::formulations) {
    const VectorXd at_home = free_motion(formulation, Matrix3d::Identity(), Vector3d::Zero(), Vector3d::Zero());
    const VectorXd moved = free_motion(formulation, R, shift, boost);
    double largest = 0.0;
    for (Eigen::Index k = 0; k < moved.size(); k += 3) {
      const Vector3d expected = R * at_home.segment<3>(k) + shift + 0.4 * boost;
      largest = std::max(largest, (moved.segment<3>(k) - expected).norm());
    }
    EXPECT_LT(largest, 1e-9) << static_cast<int>(formulation);
  }
}

enum class Load { follows, dead };

/// A bar pressed on its upper side: by a pressure that follows it, or by its forces at the start.
test::SolidSystem pressed_bar(Formulation formulation, Load load) {
  constexpr double pressure = 0.005;
  test::SolidSystem system = test::solid_box({4, 1, 1}, {0, 0, 0}, {4, 1, 1});
  for (int i = 0; i < 3; ++i) system.hold(test::plane(0, 0.0), i);
  DeadLoad dead{.nodes = system.nodes(test::plane(2, 1.0)), .unit = {}, .value = {.constant = pressure}};
  EXPECT_EQ(dead.nodes.size(), 10U);
  for (const int node : dead.nodes) {
    const double x = system.node(node)[0];
    dead.unit.push_back({0, 0, x < 1e-9 || x > 4 - 1e-9 ? -0.25 : -0.5});
  }
  if (load == Load::follows) {
    system.solid.pressures.push_back({.faces = test::faces_in(system, 2, 1.0), .value = {.constant = pressure}});
  } else {
    system.solid.dead_loads.push_back(dead);
  }
  system.fill(test::rubber(mu, 10.0, formulation), mu, formulation);
  return system;
}

struct Pressed {
  VectorXd q;
  int iterations = 0;  ///< of all steps
};

Pressed pressed(Formulation formulation, Load load, const std::string& solver) {
  const double dt = 0.05;
  const auto model = test::make_model(pressed_bar(formulation, load));
  variational::State state = test::moving_state(*model, dt);
  variational::Stepper stepper(*model, dt, {.tolerance = 1e-11, .substructures = solver});
  Pressed found;
  while (state.step < 40) {
    const variational::StepReport report = stepper.advance(state, {});
    EXPECT_EQ(report.status, variational::Status::running) << report.sentence;
    if (report.status != variational::Status::running) break;
    found.iterations += report.iterations;
  }
  found.q = state.q;
  return found;
}

TEST(SolidReferees, StepsUnderAPressureThatFollowsConvergeAsThoseUnderADeadLoad) {
  // The factor of a step lacks the stiffness of the load: dt^2/4 times it is small beside the mass.
  for (const Formulation formulation : {Formulation::displacement, Formulation::incompressible}) {
    const Pressed direct = pressed(formulation, Load::follows, "direct");
    const Pressed other = pressed(formulation, Load::follows, "gmres");
    EXPECT_LT((direct.q - other.q).lpNorm<Eigen::Infinity>(), 1e-8);
    const Pressed dead = pressed(formulation, Load::dead, "direct");
    std::cout << direct.iterations << " iterations, " << dead.iterations << " under a dead load, ends "
              << direct.q[3 * 4 + 2] << " and " << dead.q[3 * 4 + 2] << '\n';
    EXPECT_LE(direct.iterations, 1.2 * dead.iterations);
    EXPECT_GT((direct.q - dead.q).lpNorm<Eigen::Infinity>(), 1e-4);
  }
}

}  // namespace
}  // namespace muldi::fem
