/// Joint coordinates as functions of q: value, rate, gradient and Hessian against jets.
#include <gtest/gtest.h>

#include "math/derivative_check.hpp"
#include "math/jet_eigen.hpp"
#include "multibody/joint_coordinate.hpp"
#include "support/random_tree.hpp"

namespace muldi::multibody {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Jet = math::Jet2<24>;
using Vector = std::array<Jet, 3>;

/// A body-fixed (or ground) vector with jets over the unknowns of bodies 0 and 1.
Vector carried(int body, const Eigen::Vector3d& local, const VectorXd& q, bool point) {
  Vector result{Jet(local[0]), Jet(local[1]), Jet(local[2])};
  if (body == ground) return result;
  for (int r = 0; r < 3; ++r) {
    auto& entry = result[static_cast<std::size_t>(r)];
    entry = Jet(0.0);
    if (point) entry += Jet::variable(q[12 * body + r], 12 * body + r);
    for (int k = 0; k < 3; ++k) {
      const int at = 12 * body + 3 + 3 * k + r;
      entry += local[k] * Jet::variable(q[at], at);
    }
  }
  return result;
}

Jet dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The definition of the coordinate (numerics 1.7).
Jet coordinate(const Joint& joint, const Motion& motion, const VectorXd& q) {
  const auto e_a = [&](int k) { return carried(joint.body_a, joint.triad_a.col(k), q, false); };
  const auto e_b = [&](int k) { return carried(joint.body_b, joint.triad_b.col(k), q, false); };
  if (!motion.is_angle()) {
    Vector p = carried(joint.body_b, joint.rho_b, q, true);
    const Vector from = carried(joint.body_a, joint.rho_a, q, true);
    for (std::size_t r = 0; r < 3; ++r) p[r] -= from[r];
    return dot(e_a(motion.axis), p) - joint.offset[motion.axis];
  }
  Jet sine(0.0);
  Jet cosine(0.0);
  for (const TriadProduct& term : motion.sine) sine += term.sign * dot(e_a(term.a), e_b(term.b));
  for (const TriadProduct& term : motion.cosine) cosine += term.sign * dot(e_a(term.a), e_b(term.b));
  return atan2(sine, cosine);
}

struct Case {
  Joint joint;
  Motion motion;
  VectorXd q;
};

/// Every scalar motion of every joint, between bodies and to ground from both sides, at q that need not satisfy any
/// constraint: midpoints of the integrator do not.
std::vector<Case> cases() {
  std::mt19937 random(60);
  std::vector<Case> list;
  for (const JointPattern& pattern : test::joint_patterns()) {
    for (const auto& ends : {std::pair(0, 1), std::pair(1, 0), std::pair(ground, 1), std::pair(0, ground)}) {
      for (const Motion& motion : pattern.motions) {
        if (motion.kind == Motion::Kind::ball) continue;
        test::RigidSystem system;
        VectorXd q(24);
        for (int body = 0; body < 2; ++body) {
          const Pose pose = test::random_pose(random, 50.0);
          system.add_body(1.0, Eigen::Vector3d::Ones(), pose);
          q.segment<3>(12 * body) = pose.position + test::random_vector(random, 10.0);
          const Eigen::Matrix3d turned = test::random_rotation(random);
          for (int k = 0; k < 3; ++k) {
            q.segment<3>(12 * body + 3 + 3 * k) = turned.col(k) + test::random_vector(random, 0.1);
          }
        }
        system.connect(pattern, ends, test::random_vector(random, 50.0), test::random_rotation(random));
        list.push_back({system.joints[0], motion, q});
      }
    }
  }
  return list;
}

TEST(JointCoordinate, ValueGradientAndHessianAreThoseOfTheDefinition) {
  std::mt19937 random(61);
  for (const Case& at : cases()) {
    const JointCoordinate coordinate_of(at.joint, at.motion);
    const Jet expected = coordinate(at.joint, at.motion, at.q);
    ASSERT_NEAR(coordinate_of.value(at.q), expected.value, 1e-12 * (1.0 + std::abs(expected.value)));
    VectorXd gradient = VectorXd::Zero(24);
    coordinate_of.add_gradient(at.q, 1.0, gradient);
    const JointCoordinate::LocalVector local_gradient = coordinate_of.gradient(at.q);
    const JointCoordinate::LocalMatrix local_hessian = coordinate_of.hessian(at.q);
    VectorXd scattered = VectorXd::Zero(24);
    MatrixXd hessian = MatrixXd::Zero(24, 24);
    const auto nodes = coordinate_of.nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(12 * i);
      scattered.segment<12>(12 * nodes[i]) = local_gradient.segment<12>(row);
      for (std::size_t j = 0; j < nodes.size(); ++j) {
        hessian.block<12, 12>(12 * nodes[i], 12 * nodes[j]) =
            local_hessian.block<12, 12>(row, static_cast<Eigen::Index>(12 * j));
      }
    }
    VectorXd jet_gradient(24);
    MatrixXd jet_hessian(24, 24);
    for (int i = 0; i < 24; ++i) {
      jet_gradient[i] = expected.d(i);
      for (int j = 0; j < 24; ++j) jet_hessian(i, j) = expected.dd(i, j);
    }
    ASSERT_LT(math::derivative_error(gradient, jet_gradient).relative, 1e-12);
    ASSERT_LT(math::derivative_error(scattered, jet_gradient).relative, 1e-12);
    ASSERT_LT(math::derivative_error(hessian, jet_hessian).relative, 1e-12);
    const VectorXd v = test::random_entries(random, 24, 1.0);
    ASSERT_NEAR(coordinate_of.rate(at.q, v), jet_gradient.dot(v), 1e-12 * jet_gradient.norm() * v.norm());
    model::EndDerivatives all;
    coordinate_of.differentiate(at.q, &v, all);
    const math::VectorFunction hessian_along = [&](const VectorXd& s) -> VectorXd {
      return coordinate_of.hessian(at.q + s[0] * v).reshaped();
    };
    const MatrixXd slope = math::difference_jacobian(hessian_along, VectorXd::Zero(1), VectorXd::Constant(1, 1e-3));
    const MatrixXd full = slope.col(0).reshaped(24, 24);
    const Eigen::Index n = all.hessian_slope.rows();
    const double size = 1e-9 * (1.0 + full.cwiseAbs().maxCoeff());
    ASSERT_LT((all.hessian_slope - full.topLeftCorner(n, n)).cwiseAbs().maxCoeff(), size);
    ASSERT_LT((all.gradient - gradient(coordinate_of.unknowns())).norm(), 1e-13 * gradient.norm());
  }
}

}  // namespace
}  // namespace muldi::multibody
