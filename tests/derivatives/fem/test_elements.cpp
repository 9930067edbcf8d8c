/// Derivatives of the element kernels: energies, forces, tangents and actions against each other.
#include <gtest/gtest.h>

#include <map>

#include "math/derivative_check.hpp"
#include "support/fem_patch.hpp"

namespace muldi {
namespace {

using test::FemState;
using test::FemSystem;

/// Brings derivatives by x and by phi to one size.
Eigen::VectorXd unknown_sizes(int n_nodes) {
  Eigen::VectorXd size = Eigen::VectorXd::Ones(4 * n_nodes);
  for (int k = 0; k < n_nodes; ++k) size[4 * k + 3] = 2e4;
  return size;
}

class ElementDerivatives : public testing::TestWithParam<fem::Isa> {
 protected:
  FemSystem system_{test::seven_elements(), test::full_material(), GetParam()};
  std::mt19937 random_{1};
  FemState state_ = test::random_state(system_.patch(), random_);
  int n_ = system_.patch().n_nodes();
};
INSTANTIATE_TEST_SUITE_P(AllSets, ElementDerivatives, testing::ValuesIn(test::isas()), [](const auto& at) {
  return "v" + std::to_string(at.param == fem::Isa::v1 ? 1 : at.param == fem::Isa::v3 ? 3 : 4);
});

TEST_P(ElementDerivatives, ForcesAreTheGradientOfTheEnergy) {
  FemState state = state_;
  state.v.resize(0);
  state.pressure.resize(0);
  const Eigen::VectorXd size = unknown_sizes(n_);
  const auto energy = [&](const Eigen::VectorXd& scaled) {
    FemState at = state;
    for (int k = 0; k < n_; ++k) {
      at.x.segment<3>(3 * k) = scaled.segment<3>(4 * k);
      at.phi[k] = 2e4 * scaled[4 * k + 3];
    }
    const fem::ElementEnergies sum = system_.energies(at);
    return Eigen::VectorXd::Constant(1, sum.elastic + sum.electric);
  };
  const Eigen::VectorXd at = test::joined(state.x, state.phi).cwiseQuotient(size);
  const Eigen::MatrixXd differences = math::difference_jacobian(energy, at, Eigen::VectorXd::Constant(4 * n_, 2e-3));
  const test::FemForces forces = system_.forces(state);
  const Eigen::VectorXd hand = test::joined(forces.force, forces.charge).cwiseProduct(size);
  EXPECT_LE(math::derivative_error(hand.transpose(), differences).relative, 1e-9);
}

TEST_P(ElementDerivatives, ActionIsTheDerivativeOfTheForces) {
  const FemState along{.x = test::random_values(random_, 3 * n_, 1.0),
                       .v = test::random_values(random_, 3 * n_, 1.0),
                       .phi = test::random_values(random_, n_, 2e4),
                       .pressure = test::random_values(random_, 7, 1.0)};
  const auto forces = [&](const Eigen::VectorXd& s) {
    FemState at = state_;
    at.x += s[0] * along.x;
    at.v += s[0] * along.v;
    at.phi += s[0] * along.phi;
    at.pressure += s[0] * along.pressure;
    const test::FemForces out = system_.forces(at);
    Eigen::VectorXd all(7 * n_);
    all << out.force, 2e4 * out.charge, 1e3 * out.momentum;
    return all;
  };
  const Eigen::MatrixXd differences =
      math::difference_jacobian(forces, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, 2e-3));
  const test::FemForces action = system_.action(state_, along);
  Eigen::VectorXd all(7 * n_);
  all << action.force, 2e4 * action.charge, 1e3 * action.momentum;
  EXPECT_LE(math::derivative_error(all, differences).relative, 1e-9);
}

TEST_P(ElementDerivatives, TangentTimesAVectorIsTheAction) {
  const FemState still{.x = state_.x, .v = {}, .phi = state_.phi, .pressure = {}};
  const Eigen::MatrixXd K = system_.tangent(still, {});
  const Eigen::VectorXd size = unknown_sizes(n_);
  for (int k = 0; k < 5; ++k) {
    const FemState along{.x = test::random_values(random_, 3 * n_, 1.0),
                         .v = {},
                         .phi = test::random_values(random_, n_, 2e4),
                         .pressure = {}};
    const test::FemForces action = system_.action(still, along);
    const Eigen::VectorXd expected = test::joined(action.force, action.charge).cwiseProduct(size);
    const Eigen::VectorXd given = (K * test::joined(along.x, along.phi)).cwiseProduct(size);
    EXPECT_LE(math::derivative_error(given, expected).relative, 1e-12);
  }
  EXPECT_LE(math::derivative_error(K.transpose(), K).relative, 1e-15);
}

TEST_P(ElementDerivatives, WeightsScaleTheirParts) {
  const FemState along{.x = test::random_values(random_, 3 * n_, 1.0),
                       .v = test::random_values(random_, 3 * n_, 1.0),
                       .phi = test::random_values(random_, n_, 2e4),
                       .pressure = {}};
  const FemState along_x{.x = along.x, .v = {}, .phi = {}, .pressure = {}};
  const FemState along_v{.x = {}, .v = along.x, .phi = {}, .pressure = {}};
  const FemState along_phi{.x = {}, .v = {}, .phi = along.phi, .pressure = {}};
  FemState still = state_;
  still.v.resize(0);
  still.pressure.resize(0);
  const test::FemForces by_x = system_.action(still, along_x);
  const test::FemForces by_v = system_.action(state_, along_v);
  const test::FemForces by_phi = system_.action(still, along_phi);
  const fem::ElementTangentWeights weights{.mass = 2.0, .stiffness = 0.3, .rate = 0.5, .x_phi = 0.7, .phi_phi = 1.1};
  const Eigen::VectorXd given = system_.tangent(state_, weights) * test::joined(along.x, along.phi);
  const Eigen::VectorXd expected =
      test::joined(2.0 * by_v.momentum + 0.3 * by_x.force + 0.5 * by_v.force + 0.7 * by_phi.force,
                   0.7 * by_x.charge + 1.1 * by_phi.charge);
  const Eigen::VectorXd size = unknown_sizes(n_);
  EXPECT_LE(math::derivative_error(given.cwiseProduct(size), expected.cwiseProduct(size)).relative, 1e-12);
}

TEST_P(ElementDerivatives, FullTangentOfDampedMotionTimesAVectorIsTheAction) {
  const double dt = 0.5;
  FemState at = state_;
  at.pressure.resize(0);
  // Along the end of an interval both the midpoint and the mean velocity change.
  const Eigen::VectorXd dx = test::random_values(random_, 3 * n_, 1.0);
  const FemState along{.x = 0.5 * dx, .v = dx / dt, .phi = {}, .pressure = {}};
  const test::FemForces action = system_.action(at, along);
  const Eigen::MatrixXd K =
      system_.tangent(at, {.stiffness = 0.5, .rate = 1.0 / dt, .x_phi = 0.5}) + 0.5 * system_.viscous_by_position(at);
  const Eigen::VectorXd given = K * test::joined(dx, Eigen::VectorXd::Zero(n_));
  const Eigen::VectorXd size = unknown_sizes(n_);
  EXPECT_LE(
      math::derivative_error(given.cwiseProduct(size), test::joined(action.force, action.charge).cwiseProduct(size))
          .relative,
      1e-12);
}

/// Volumes of all elements as one vector a kind.
struct Volumes {
  Eigen::VectorXd reference, J, gradient, dJ, dgradient;

  Volumes(const FemSystem& system, const Eigen::VectorXd& x, const Eigen::VectorXd& dx) {
    const int n = system.patch().n_elements();
    reference = J = dJ = Eigen::VectorXd::Zero(n);
    gradient = dgradient = Eigen::VectorXd::Zero(24 * n);
    const fem::VolumeTargets to{.reference = reference.data(),
                                .J = J.data(),
                                .gradient = gradient.data(),
                                .dJ = dJ.data(),
                                .dgradient = dgradient.data()};
    const fem::VolumeFields fields{.X = system.patch().X.data(), .x = x.data(), .dx = dx.data()};
    system.each([&](const auto& range) { system.kernels().volumes(range, fields, to); });
  }
};

/// Entries of a nodal vector at the corners of the elements, [element][8][3].
Eigen::VectorXd at_corners(const test::FemPatch& patch, const Eigen::VectorXd& nodal) {
  Eigen::VectorXd all(24 * patch.n_elements());
  Eigen::Index row = 0;
  for (const auto& nodes : patch.elements) {
    for (const int node : nodes) {
      all.segment<3>(row) = nodal.segment<3>(3 * node);
      row += 3;
    }
  }
  return all;
}

TEST_P(ElementDerivatives, VolumeGradientAndHessianAreThoseOfTheVolume) {
  const Eigen::VectorXd dx = test::random_values(random_, 3 * n_, 1.0);
  const Volumes at(system_, state_.x, dx);
  const Eigen::VectorXd corners = at_corners(system_.patch(), dx);
  for (int e = 0; e < 7; ++e) {
    // The dual of the volume against the gradient: two ways of the same code path for value and slope.
    EXPECT_NEAR(at.gradient.segment<24>(24 * e).dot(corners.segment<24>(24 * e)), at.dJ[e], 1e-13);
  }
  const auto gradients = [&](const Eigen::VectorXd& s) { return Volumes(system_, state_.x + s[0] * dx, dx).gradient; };
  const auto values = [&](const Eigen::VectorXd& s) { return Volumes(system_, state_.x + s[0] * dx, dx).J; };
  const Eigen::VectorXd step = Eigen::VectorXd::Constant(1, 1e-1);
  // Cubic polynomials: the differences are exact to round-off.
  EXPECT_LE(math::derivative_error(at.dJ, math::difference_jacobian(values, Eigen::VectorXd::Zero(1), step)).relative,
            1e-12);
  EXPECT_LE(math::derivative_error(at.dgradient, math::difference_jacobian(gradients, Eigen::VectorXd::Zero(1), step))
                .relative,
            1e-12);
}

TEST_P(ElementDerivatives, PressureTermsOfForceAndTangentAreThoseOfTheVolume) {
  const Eigen::VectorXd dx = test::random_values(random_, 3 * n_, 1.0);
  const Volumes at(system_, state_.x, dx);
  FemState without = state_;
  without.pressure.resize(0);
  const Eigen::VectorXd force = system_.forces(state_).force - system_.forces(without).force;
  const Eigen::VectorXd rank = test::random_values(random_, 7, 2.0);
  const Eigen::MatrixXd K = system_.tangent(state_, {.stiffness = 0.0,
                                                     .x_phi = 0.0,
                                                     .phi_phi = 0.0,
                                                     .rank_one = rank.data(),
                                                     .volume_gradients = at.gradient.data(),
                                                     .curvature = state_.pressure.data()});
  Eigen::VectorXd expected_force = Eigen::VectorXd::Zero(3 * n_);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(3 * n_);
  for (int e = 0; e < 7; ++e) {
    for (int a = 0; a < 8; ++a) {
      const int node = system_.patch().elements[static_cast<std::size_t>(e)][static_cast<std::size_t>(a)];
      const double factor = state_.pressure[e] * at.reference[e];
      expected_force.segment<3>(3 * node) += factor * at.gradient.segment<3>(24 * e + 3 * a);
      expected.segment<3>(3 * node) += factor * at.dgradient.segment<3>(24 * e + 3 * a) +
                                       rank[e] * at.dJ[e] * at.gradient.segment<3>(24 * e + 3 * a);
    }
  }
  EXPECT_LE((force - expected_force).norm(), 1e-13 * expected_force.norm());
  const Eigen::VectorXd given = K * test::joined(dx, Eigen::VectorXd::Zero(n_));
  EXPECT_LE((given - test::joined(expected, Eigen::VectorXd::Zero(n_))).norm(), 1e-13 * expected.norm());
}

/// Half-stored block matrix of the patch; every other pair of nodes is stored as its transpose.
struct HalfStored {
  std::map<std::pair<int, int>, int> slot;
  std::vector<std::int32_t> slots;

  explicit HalfStored(const FemSystem& system) {
    for (const auto& nodes : system.patch().elements)
      for (const int a : nodes)
        for (const int b : nodes) slot.try_emplace(stored(a, b), 0);
    int next = 0;
    for (auto& entry : slot) entry.second = next++;
    slots = system.order().block_slots([&](int row, int column) {
      return 2 * slot.at(stored(row, column)) + (stored(row, column) == std::pair(row, column) ? 0 : 1);
    });
  }
  static std::pair<int, int> stored(int a, int b) {
    return (a + b) % 2 == 0 ? std::pair(std::min(a, b), std::max(a, b)) : std::pair(std::max(a, b), std::min(a, b));
  }
  /// With unknowns `block` a node.
  Eigen::MatrixXd whole(const std::vector<double>& values, int n, int block) const {
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(block * n, block * n);
    for (const auto& [pair, k] : slot) {
      const auto B = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(values.data() + block * block * k,
                                                                                      block, block);
      K.block(block * pair.first, block * pair.second, block, block) = B;
      K.block(block * pair.second, block * pair.first, block, block) = B.transpose();
    }
    return K;
  }
};

TEST_P(ElementDerivatives, BlockMatrixHoldsTheElementMatrices) {
  const HalfStored half(system_);
  const fem::ElementTangentWeights weights{.mass = 2.0, .stiffness = 0.3, .rate = 0.5, .x_phi = 0.7, .phi_phi = 1.1};
  Eigen::MatrixXd expected = system_.tangent(state_, weights);
  std::vector<std::uint8_t> fixed(static_cast<std::size_t>(n_), 0);
  fixed[3] = 0b1010;
  fixed[12] = 0b0001;
  for (const int unknown : {13, 15, 48}) {
    expected.row(unknown).setZero();
    expected.col(unknown).setZero();
  }
  for (const int block : {3, 4}) {
    std::vector<double> values(static_cast<std::size_t>(block * block) * half.slot.size());
    const fem::BlockTarget to{
        .block = block, .values = values.data(), .slots = half.slots.data(), .fixed = fixed.data()};
    system_.each([&](const auto& range) {
      system_.kernels().tangent(system_.laws(), range, state_.fields(system_.patch()), weights, to);
    });
    const Eigen::MatrixXd given = half.whole(values, n_, block);
    for (int a = 0; a < n_; ++a) {
      for (int b = 0; b < n_; ++b) {
        const Eigen::MatrixXd of = expected.block(4 * a, 4 * b, block, block);
        EXPECT_LE((given.block(block * a, block * b, block, block) - of).cwiseAbs().maxCoeff(), 1e-15) << a << " " << b;
      }
    }
  }
}

TEST(ElementKernels, AgreeBetweenInstructionSets) {
  std::mt19937 random(5);
  const test::FemPatch patch = test::cube_of(3);
  const FemState state = test::random_state(patch, random);
  const FemState along = test::random_state(patch, random);
  const FemSystem base(patch, test::full_material(), fem::Isa::v1);
  const test::FemForces forces = base.forces(state);
  const test::FemForces action = base.action(state, along);
  const Eigen::MatrixXd K = base.tangent(state, {.mass = 2.0, .rate = 0.5});
  const fem::ElementEnergies energies = base.energies(state);
  for (const fem::Isa isa : test::isas()) {
    const FemSystem other(patch, test::full_material(), isa);
    const test::FemForces there = other.forces(state);
    const test::FemForces action_there = other.action(state, along);
    EXPECT_LE((there.force - forces.force).norm(), 1e-13 * forces.force.norm());
    EXPECT_LE((there.charge - forces.charge).norm(), 1e-13 * forces.charge.norm());
    EXPECT_LE((there.momentum - forces.momentum).norm(), 1e-13 * forces.momentum.norm());
    EXPECT_LE((there.least_J - forces.least_J).norm(), 1e-13);
    EXPECT_NEAR(there.least, forces.least_J.minCoeff(), 1e-13);
    EXPECT_LE((action_there.force - action.force).norm(), 1e-13 * action.force.norm());
    EXPECT_LE((action_there.charge - action.charge).norm(), 1e-13 * action.charge.norm());
    EXPECT_LE((other.tangent(state, {.mass = 2.0, .rate = 0.5}) - K).norm(), 1e-13 * K.norm());
    const fem::ElementEnergies sums = other.energies(state);
    EXPECT_NEAR(sums.elastic, energies.elastic, 1e-13 * energies.elastic);
    EXPECT_NEAR(sums.electric, energies.electric, 1e-13 * std::abs(energies.electric));
    EXPECT_NEAR(sums.dissipation, energies.dissipation, 1e-13 * energies.dissipation);
    EXPECT_NEAR(sums.kinetic, energies.kinetic, 1e-13 * energies.kinetic);
  }
}

}  // namespace
}  // namespace muldi
