/// Joints of faces of which neither mesh refines the other: what the sums reproduce, and what they hand over.
#include "fem/solid/mortar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace muldi::fem {
namespace {

/// Two layers of faces in the plane z = 0, the attached ones first; nodes inside are moved by up to `shake` of a cell.
struct Layers {
  Eigen::VectorXd X;
  std::vector<FaceNodes> attached = {};
  std::vector<FaceNodes> others = {};

  Layers(int n, int m, double shake, double width = 1.0) {
    std::vector<double> x;
    attached = layer(n, shake, width, x);
    others = layer(m, shake, 1.0, x);
    X = Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
  }

  static std::vector<FaceNodes> layer(int n, double shake, double width, std::vector<double>& x) {
    const int first = static_cast<int>(x.size() / 3);
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        const bool inside = i > 0 && i < n && j > 0 && j < n;
        const double by = inside ? shake / n : 0.0;
        x.push_back(width * (static_cast<double>(i) / n + by * std::sin(3.0 * i + 5.0 * j)));
        x.push_back(width * (static_cast<double>(j) / n + by * std::cos(7.0 * i - 2.0 * j)));
        x.push_back(0.0);
      }
    }
    std::vector<FaceNodes> faces;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const int a = first + j * (n + 1) + i;
        faces.push_back({a, a + 1, a + n + 2, a + n + 1});
      }
    }
    return faces;
  }

  std::vector<NodeSum> sums() const { return mortar_sums(X, attached, others, 1e-9); }
  Eigen::Vector3d at(int node) const { return X.segment<3>(3 * static_cast<Eigen::Index>(node)); }

  /// Forces of a unit pressure on nodes: a quarter of the area each on parallelograms, by Gauss's points elsewhere.
  std::map<int, double> forces(const std::vector<FaceNodes>& faces) const {
    std::map<int, double> found;
    const double g = 1.0 / std::sqrt(3.0);
    const std::array<double, 4> xi = {-1, 1, 1, -1}, eta = {-1, -1, 1, 1};
    for (const FaceNodes& face : faces) {
      for (const double s : {-g, g}) {
        for (const double t : {-g, g}) {
          Eigen::Matrix2d J = Eigen::Matrix2d::Zero();
          std::array<double, 4> N{};
          for (std::size_t a = 0; a < 4; ++a) {
            N[a] = 0.25 * (1 + s * xi[a]) * (1 + t * eta[a]);
            const Eigen::RowVector2d slope(0.25 * xi[a] * (1 + t * eta[a]), 0.25 * eta[a] * (1 + s * xi[a]));
            J += at(face[a]).head<2>() * slope;
          }
          for (std::size_t a = 0; a < 4; ++a) found[face[a]] += J.determinant() * N[a];
        }
      }
    }
    return found;
  }

  /// Largest difference between the forces of a unit pressure on the others and those that the attached nodes hand
  /// over, of a force.
  double imbalance() const {
    std::map<int, double> handed = forces(attached);
    const std::vector<NodeSum> all = sums();
    // Nodes inside hand over to those of the sides, these to the others: the sums come in the opposite order.
    for (auto sum = all.rbegin(); sum != all.rend(); ++sum) {
      for (std::size_t k = 0; k < sum->to.size(); ++k) handed[sum->to[k]] += sum->weights[k] * handed[sum->node];
      handed.erase(sum->node);
    }
    // Corners lie on corners.
    for (const int node : {attached.front()[0], attached.back()[2]}) handed.erase(node);
    double most = 0.0;
    double size = 0.0;
    for (const auto& [node, force] : forces(others)) {
      size = std::max(size, force);
      const bool is_corner = (at(node).head<2>().array() * (1.0 - at(node).head<2>().array())).abs().maxCoeff() < 1e-12;
      if (!is_corner) most = std::max(most, std::abs(handed[node] - force));
    }
    return most / size;
  }
};

class Mortar : public ::testing::TestWithParam<double> {};

TEST_P(Mortar, ReproducesWhateverIsLinear) {
  const Layers layers(5, 3, GetParam());
  const std::vector<NodeSum> sums = layers.sums();
  ASSERT_EQ(sums.size(), 36U - 4U) << "all nodes but the corners";
  for (const NodeSum& sum : sums) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    double whole = 0.0;
    for (std::size_t k = 0; k < sum.to.size(); ++k) {
      x += sum.weights[k] * layers.at(sum.to[k]);
      whole += sum.weights[k];
    }
    EXPECT_NEAR(whole, 1.0, 1e-14);
    EXPECT_LT((x - layers.at(sum.node)).norm(), 1e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(Shakes, Mortar, ::testing::Values(0.0, 0.2));

TEST(MortarForces, OfAConstantPressureAreThoseOfTheOtherMesh) {
  EXPECT_LT(Layers(3, 2, 0.0).imbalance(), 1e-13);
  EXPECT_LT(Layers(2, 3, 0.0).imbalance(), 1e-13);
  EXPECT_LT(Layers(7, 4, 0.0).imbalance(), 1e-13);
}

TEST(MortarForces, OfDistortedFacesAreThoseOfTheOtherMeshToTheErrorOfIntegration) {
  EXPECT_LT(Layers(3, 2, 0.2).imbalance(), 1e-4);
  EXPECT_LT(Layers(7, 4, 0.2).imbalance(), 1e-4);
}

TEST(MortarSums, AreNotNeededWhereOneMeshRefinesTheOther) {
  EXPECT_TRUE(Layers(4, 2, 0.0).sums().empty());
  EXPECT_TRUE(Layers(3, 3, 0.0).sums().empty());
  EXPECT_TRUE(Layers(4, 4, 0.2).sums().empty());
  EXPECT_FALSE(Layers(2, 4, 0.0).sums().empty());
}

TEST(MortarSums, AreThereWhereTheOtherFacesReachFurther) { EXPECT_EQ(Layers(3, 2, 0.0, 0.9).sums().size(), 12U); }

TEST(MortarSums, DoNotExistOnCurvedFacesNorBesideTheOthers) {
  Layers curved(3, 2, 0.0);
  for (Eigen::Index k = 0; k < curved.X.size(); k += 3) curved.X[k + 2] = 0.1 * curved.X[k] * curved.X[k + 1];
  EXPECT_TRUE(curved.sums().empty());
  EXPECT_TRUE(Layers(3, 2, 0.0, 1.1).sums().empty());
}

}  // namespace
}  // namespace muldi::fem
