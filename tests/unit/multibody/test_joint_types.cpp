/// The battery that every joint type of the registry must pass.
#include <Eigen/SVD>
#include <cmath>

#include "math/derivative_check.hpp"
#include "math/rotation.hpp"
#include "multibody/registry.hpp"
#include "support/random_tree.hpp"
#include "support/types_of.hpp"

namespace muldi::multibody {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Which bodies the joint connects; body 0 is the root of its chain, so that `reversed` joints are met from `to`.
enum class Form { between, between_reversed, anchored, anchored_reversed };
constexpr std::array forms{Form::between, Form::between_reversed, Form::anchored, Form::anchored_reversed};

int n_bodies(Form form) { return form == Form::between || form == Form::between_reversed ? 2 : 1; }

template <class Type>
struct JointTypeTest : testing::Test {
  std::mt19937 random{20180};

  test::RigidSystem system(Form form, const Eigen::Matrix3d& triad) {
    test::RigidSystem result;
    for (int i = 0; i < n_bodies(form); ++i) {
      result.add_body(10.0, {2000.0, 2100.0, 2200.0}, test::random_pose(random, 100.0));
    }
    const int other = n_bodies(form) == 2 ? 0 : ground;
    const int body = n_bodies(form) - 1;
    const bool forward = form == Form::between || form == Form::anchored;
    result.connect(Type::pattern, forward ? std::pair(other, body) : std::pair(body, other),
                   test::random_vector(random, 100.0), triad);
    return result;
  }
  test::RigidSystem system(Form form) { return system(form, test::random_rotation(random)); }

  /// Calls `check` with 50 systems of each form at random coordinates.
  template <class Check>
  void for_systems(Check check) {
    for (const Form form : forms) {
      for (int n = 0; n < 50; ++n) {
        const test::RigidSystem system = this->system(form);
        const auto model = test::make_model(system);
        check(system, test::manifold_of(*model), test::random_coordinates(random, *model->manifold));
      }
    }
  }
};

/// Positions in units of the scene, so that singular values compare.
MatrixXd dimensionless(MatrixXd G, double length) {
  for (Eigen::Index k = 0; k < G.cols(); ++k) {
    if (k % 12 < 3) G.col(k) *= length;
  }
  return G;
}

Eigen::Index rank_of(const MatrixXd& G) {
  if (G.size() == 0) return 0;
  Eigen::JacobiSVD<MatrixXd> svd(G);
  svd.setThreshold(1e-6);
  return svd.rank();
}

using Types = test::TypesOf<JointTypes>::type;
class TypeNames {
 public:
  template <class Type>
  static std::string GetName(int) {  // NOLINT(readability-identifier-naming): GoogleTest asks for this name
    return std::string(Type::name);
  }
};
TYPED_TEST_SUITE(JointTypeTest, Types, TypeNames);

TYPED_TEST(JointTypeTest, ConstraintsAndFreedomsAreSixTogether) {
  EXPECT_EQ(TypeParam::pattern.n_constraints() + TypeParam::pattern.n_rates(), 6);
}

TYPED_TEST(JointTypeTest, NullSpaceMatrixIsAnnihilatedByTheConstraints) {
  // Entries of G T are at most of size 1 to 10 (lengths are in units of the scene): 1e-12 is a thousand round-offs.
  this->for_systems([&](const test::RigidSystem&, const TreeManifold& manifold, const VectorXd& x) {
    const VectorXd q = test::configuration_at(manifold, x);
    const MatrixXd GT = test::dense_jacobian(manifold.tree_rows(), q) * test::dense_null_space(manifold, x);
    ASSERT_LT(GT.lpNorm<Eigen::Infinity>(), 1e-12);
    const VectorXd rates = test::random_entries(this->random, manifold.n_v(), 1.0);
    ASSERT_LT((GT * rates).template lpNorm<Eigen::Infinity>(), 1e-12);
  });
}

TYPED_TEST(JointTypeTest, ConstraintsHaveFullRankAndTheNullSpaceTheRest) {
  this->for_systems([&](const test::RigidSystem& system, const TreeManifold& manifold, const VectorXd& x) {
    const VectorXd q = test::configuration_at(manifold, x);
    const auto n_rows = static_cast<Eigen::Index>(manifold.tree_rows().size());
    ASSERT_EQ(n_rows, TypeParam::pattern.n_constraints() + 6 * system.n_bodies());
    ASSERT_EQ(rank_of(dimensionless(test::dense_jacobian(manifold.tree_rows(), q), system.length)), n_rows);
    ASSERT_EQ(rank_of(test::dense_null_space(manifold, x) / system.length), manifold.n_v());
    ASSERT_EQ(n_rows + manifold.n_v(), 12 * system.n_bodies());
  });
}

TYPED_TEST(JointTypeTest, KeepsItsRankForEveryInitialOrientation) {
  // The 24 turns of a cube put directors of the two bodies parallel in every way (numerics C12).
  for (int column = 0; column < 6; ++column) {
    for (int quarter = 0; quarter < 4; ++quarter) {
      const int axis = column % 3;
      const Eigen::Matrix3d to_axis = math::axis_rotation((axis + 1) % 3, column < 3 ? 0.0 : std::acos(-1.0)) *
                                      math::triad_about(Vector3d::Unit(axis));
      test::RigidSystem system;
      system.add_body(1.0, Vector3d::Ones(), {});
      system.add_body(1.0, Vector3d::Ones(),
                      {.orientation = to_axis * math::axis_rotation(2, quarter * std::acos(0.0))});
      system.connect(TypeParam::pattern, {0, 1}, Vector3d(10.0, 20.0, 30.0));
      const auto model = test::make_model(system);
      const TreeManifold& manifold = test::manifold_of(*model);
      const MatrixXd G =
          test::dense_jacobian(manifold.tree_rows(), test::configuration_at(manifold, manifold.reference()));
      ASSERT_EQ(rank_of(dimensionless(G, system.length)), TypeParam::pattern.n_constraints() + 12);
    }
  }
}

TYPED_TEST(JointTypeTest, ScenePoseHasCoordinateZero) {
  for (const Form form : forms) {
    const test::RigidSystem system = this->system(form);
    const auto model = test::make_model(system);
    const VectorXd q = test::configuration_at(*model->manifold, model->manifold->reference());
    for (int i = 0; i < system.n_bodies(); ++i) {
      const Pose& pose = system.poses[static_cast<std::size_t>(i)];
      ASSERT_LT((q.segment<3>(12 * i) - pose.position).norm(), 1e-12 * system.length);
      for (int k = 0; k < 3; ++k) ASSERT_LT((q.segment<3>(12 * i + 3 + 3 * k) - pose.orientation.col(k)).norm(), 1e-14);
    }
  }
}

TYPED_TEST(JointTypeTest, EveryConfigurationIsAdmissible) {
  this->for_systems([&](const test::RigidSystem&, const TreeManifold& manifold, const VectorXd& x) {
    ASSERT_LT(manifold.violation(test::configuration_at(manifold, x)), 1e-14);
  });
}

TYPED_TEST(JointTypeTest, CoordinatesAndRelativePoseAreInverse) {
  for (int n = 0; n < 50; ++n) {
    const test::RigidSystem system = this->system(Form::between);
    const Joint& joint = system.joints[0];
    const VectorXd reported = test::random_entries(this->random, TypeParam::pattern.n_rates(), 1.5);
    VectorXd x(TypeParam::pattern.n_coordinates());
    stored_coordinates(joint, reported.data(), x.data());
    const Pose a = test::random_pose(this->random, 50.0);
    const Pose b = pose_of_b(joint, relative_pose(joint, x.data()), a);
    VectorXd again(x.size());
    coordinates_of(joint, measure(joint, a, b), x.data(), again.data());
    VectorXd reported_again(reported.size());
    reported_coordinates(joint, again.data(), reported_again.data());
    // Positions of size 100 carry round-off of 1e-14.
    ASSERT_LT((reported_again - reported).norm(), 1e-12);
    const Pose a_again = pose_of_a(joint, relative_pose(joint, x.data()), b);
    ASSERT_LT((a_again.position - a.position).norm(), 1e-12);
    ASSERT_LT((a_again.orientation - a.orientation).norm(), 1e-13);
  }
}

TYPED_TEST(JointTypeTest, NullSpaceColumnsAreTheMotionsOfTheCoordinates) {
  this->for_systems([&](const test::RigidSystem& system, const TreeManifold& manifold, const VectorXd& x) {
    if (manifold.n_v() == 0) return;
    const auto moved = [&](const VectorXd& w) -> VectorXd {
      VectorXd x_new = x;
      manifold.retract(x, w, x_new);
      return test::configuration_at(manifold, x_new);
    };
    const MatrixXd expected =
        math::difference_jacobian(moved, VectorXd::Zero(manifold.n_v()), VectorXd::Constant(manifold.n_v(), 0.02));
    const MatrixXd difference = test::dense_null_space(manifold, x) - expected;
    // The extrapolated differences of sines are exact to 0.02^6/100, times the lengths of the scene.
    ASSERT_LT(difference.lpNorm<Eigen::Infinity>(), 1e-11 * system.length);
  });
}

TYPED_TEST(JointTypeTest, IsInvariantUnderRigidMotion) {
  for (const Form form : forms) {
    for (int n = 0; n < 20; ++n) {
      const test::RigidSystem system = this->system(form);
      const Pose motion = test::random_pose(this->random, 100.0);
      const auto model = test::make_model(system);
      const auto moved_model = test::make_model(system.moved(motion));
      const TreeManifold& manifold = test::manifold_of(*model);
      const TreeManifold& moved = test::manifold_of(*moved_model);
      VectorXd x = test::random_coordinates(this->random, manifold);
      VectorXd x_moved = x;
      if (system.n_bodies() == 2) {
        // The free root measures its coordinates in world axes: carry the joint's own coordinates only.
        x.head<7>() = manifold.reference().head<7>();
        x_moved.head<7>() = moved.reference().head<7>();
      }
      const VectorXd q = test::configuration_at(manifold, x);
      const VectorXd q_moved = test::configuration_at(moved, x_moved);
      for (int i = 0; i < system.n_bodies(); ++i) {
        ASSERT_LT((q_moved.segment<3>(12 * i) - motion.point(q.segment<3>(12 * i))).norm(), 1e-11);
        for (int k = 1; k < 4; ++k) {
          ASSERT_LT((q_moved.segment<3>(12 * i + 3 * k) - motion.orientation * q.segment<3>(12 * i + 3 * k)).norm(),
                    1e-13);
        }
      }
      const Eigen::Index n_joint = TypeParam::pattern.n_rates();
      const MatrixXd T = test::dense_null_space(manifold, x).rightCols(n_joint);
      const MatrixXd T_moved = test::dense_null_space(moved, x_moved).rightCols(n_joint);
      for (Eigen::Index k = 0; k < T.rows(); k += 3) {
        ASSERT_LT((T_moved.middleRows<3>(k) - motion.orientation * T.middleRows<3>(k)).norm(), 1e-11);
      }
    }
  }
}

TYPED_TEST(JointTypeTest, DifferenceUndoesRetraction) {
  this->for_systems([&](const test::RigidSystem&, const TreeManifold& manifold, const VectorXd& x) {
    const VectorXd w = test::random_entries(this->random, manifold.n_v(), 1.0);
    VectorXd x_new = x;
    manifold.retract(x, w, x_new);
    VectorXd again(manifold.n_v());
    manifold.difference(x, x_new, again);
    ASSERT_LT((again - w).norm(), 1e-12);
    VectorXd aliased = x;
    manifold.retract(aliased, w, aliased);
    ASSERT_EQ(aliased, x_new);
  });
}

// ---- single types

TEST(RevoluteJoint, CountsWholeTurns) {
  test::RigidSystem system;
  system.add_body(1.0, Vector3d::Ones(), {.position = Vector3d(10.0, 0.0, 0.0)});
  system.connect(Revolute::pattern, {ground, 0}, Vector3d::Zero());
  const Joint& joint = system.joints[0];
  double angle = 0.0;
  for (int n = 1; n <= 1000; ++n) {
    const double goal = 0.1 * n;
    double now = 0.0;
    coordinates_of(joint, relative_pose(joint, &goal), &angle, &now);
    angle = now;
  }
  EXPECT_NEAR(angle, 100.0, 1e-12);  // almost sixteen turns
}

TEST(UniversalJoint, IsRegularAtNinetyDegrees) {
  // e_1^A is perpendicular to e_2^B always; both angles at 89.9999 degrees are no special place.
  test::RigidSystem system;
  system.add_body(1.0, Vector3d::Ones(), {.position = Vector3d(0.0, 0.0, 10.0)});
  system.connect(Universal::pattern, {ground, 0}, Vector3d::Zero());
  const auto model = test::make_model(system);
  const TreeManifold& manifold = test::manifold_of(*model);
  for (const double degrees : {89.9999, 90.0, 180.0}) {
    const double angle = degrees * std::acos(-1.0) / 180.0;
    const VectorXd x{{angle, angle}};
    const MatrixXd T = test::dense_null_space(manifold, x);
    Eigen::JacobiSVD<MatrixXd> svd(T.bottomRows<9>());
    EXPECT_NEAR(svd.singularValues()[0] / svd.singularValues()[1], 1.0, 1e-12) << "perpendicular axes of equal weight";
    const MatrixXd G = test::dense_jacobian(manifold.tree_rows(), test::configuration_at(manifold, x));
    EXPECT_LT((G * T).lpNorm<Eigen::Infinity>(), 1e-14);
    EXPECT_EQ(rank_of(dimensionless(G, system.length)), 10);
    VectorXd measured(2);
    const Joint& joint = system.joints[0];
    const Pose b = pose_of_b(joint, relative_pose(joint, x.data()), {});
    coordinates_of(joint, measure(joint, {}, b), x.data(), measured.data());
    EXPECT_LT((measured - x).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace muldi::multibody
