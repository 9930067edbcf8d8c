/// Bonded nodes against the dense map T, and the places of points on faces.
#include <gtest/gtest.h>

#include "fem/solid/bonds.hpp"
#include "fem/solid/face_projection.hpp"
#include "math/check_numbers.hpp"

namespace muldi::fem {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Two cells beside one another with nodes of their own: 8 is one with 1, 11 lies between 2 and 1, 12 follows 5 in its
/// position alone.
SolidDescription two_cells() {
  SolidDescription data;
  data.X = VectorXd::Zero(48);
  data.cells = {{0, 1, 2, 3, 4, 5, 6, 7}, {8, 9, 10, 11, 12, 13, 14, 15}};
  data.bonds = {{.node = 8, .to = {1}, .weights = {1.0}},
                {.node = 11, .to = {2, 1}, .weights = {0.7, 0.3}},
                {.node = 12, .to = {5}, .weights = {1.0}, .potential = false}};
  return data;
}

/// T with the columns of bonded unknowns left zero; `block` unknowns a node.
MatrixXd dense_map(const SolidDescription& data, int block) {
  const Eigen::Index n = data.X.size() / 3 * block;
  MatrixXd T = MatrixXd::Identity(n, n);
  for (const Bond& bond : data.bonds) {
    for (int i = 0; i < block; ++i) {
      if (i == 3 && !bond.potential) continue;
      const Eigen::Index row = block * static_cast<Eigen::Index>(bond.node) + i;
      T.row(row).setZero();
      for (std::size_t k = 0; k < bond.to.size(); ++k) T(row, block * bond.to[k] + i) = bond.weights[k];
    }
  }
  return T;
}

class BondMap : public ::testing::TestWithParam<int> {};

TEST_P(BondMap, FoldsMatricesAndRowsAsTheDenseMap) {
  const int block = GetParam();
  const SolidDescription data = two_cells();
  const Bonds bonds(data);
  const MatrixXd T = dense_map(data, block);
  const math::SymmetricBlockPattern pattern(16, block, data.cells, bonds.pairs(data.cells));
  // The cells alone fill the matrix.
  math::SymmetricBlockMatrix K(pattern);
  math::CheckNumbers numbers;
  for (const auto& cell : data.cells) {
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = a; b < 8; ++b) {
        MatrixXd one = numbers.vector(static_cast<Eigen::Index>(block) * block).reshaped(block, block);
        if (a == b) one = (one + one.transpose()).eval();
        double* values =
            K.values().data() + static_cast<std::ptrdiff_t>(pattern.slot(cell[a], cell[b])) * block * block;
        for (int i = 0; i < block; ++i) {
          for (int j = 0; j < block; ++j) values[block * i + j] = one(i, j);
        }
      }
    }
  }
  const MatrixXd expected = T.transpose() * K.dense() * T;
  BondFold(bonds, pattern).apply(K);
  EXPECT_LT((K.dense() - expected).cwiseAbs().maxCoeff(), 1e-14);
  const VectorXd rows = numbers.vector(16L * block);
  VectorXd collected = rows;
  bonds.collect(block, collected);
  EXPECT_LT((collected - T.transpose() * rows).cwiseAbs().maxCoeff(), 1e-15);
  VectorXd x = rows;
  bonds.follow(block, x);
  EXPECT_LT((x - T * rows).cwiseAbs().maxCoeff(), 1e-15);
}

INSTANTIATE_TEST_SUITE_P(Blocks, BondMap, ::testing::Values(3, 4));

TEST(Bonds, GiveWhatIsHeldToTheSideThatHoldsIt) {
  SolidDescription data = two_cells();
  data.given.assign(16, 0);
  VectorXd own = VectorXd::Zero(48);
  own[3 * 1] = 2.0;  // x of node 1
  own[3 * 8] = 5.0;  // and of node 8, which is one with it
  const auto accounted = [&](int at_1, int at_8) {
    data.given[1] = static_cast<std::uint8_t>(at_1);
    data.given[8] = static_cast<std::uint8_t>(at_8);
    const Bonds bonds(data);
    VectorXd rows = own;
    bonds.gather(3, rows);
    VectorXd of_bonds = rows;
    bonds.account(3, rows);
    bonds.forces_of_bonds(of_bonds);
    return Eigen::Vector3d(rows[3], rows[24], of_bonds[24]);
  };
  EXPECT_EQ(accounted(1, 0)[0], 7.0);  // node 1 is held: it carries both, 5 of them through the bond
  EXPECT_EQ(accounted(1, 0)[2], 5.0);
  EXPECT_EQ(accounted(0, 1), Eigen::Vector3d(0.0, 7.0, -2.0));  // node 8 is held
  EXPECT_EQ(accounted(1, 1), Eigen::Vector3d(2.0, 5.0, 0.0));   // each is held by itself
  EXPECT_EQ(accounted(0, 0)[2], 5.0);
}

TEST(FaceProjection, FindsPlacesOnPlaneAndWarpedFacesAndGapsBeyondTheRim) {
  Eigen::Matrix<double, 3, 4> corners;
  corners << 0, 2, 2.5, 0.5, 0, 0, 1, 1, 0, 0, 0.3, 0;
  const Eigen::Vector4d weights(0.4 * 0.3, 0.6 * 0.3, 0.6 * 0.7, 0.4 * 0.7);
  const FaceProjection on = project_on_face(corners * weights, corners);
  EXPECT_LT(on.distance, 1e-15);
  for (std::size_t a = 0; a < 4; ++a) EXPECT_NEAR(on.weights[a], weights[static_cast<Eigen::Index>(a)], 1e-13);
  corners.row(2).setZero();
  EXPECT_NEAR(project_on_face({1.0, 0.5, 0.25}, corners).distance, 0.25, 1e-15);
  EXPECT_NEAR(project_on_face({1.0, -3.0, 4.0}, corners).distance, 5.0, 1e-12);
  const FaceProjection corner = project_on_face({-3.0, -4.0, 0.0}, corners);
  EXPECT_NEAR(corner.distance, 5.0, 1e-12);
  EXPECT_NEAR(corner.weights[0], 1.0, 1e-12);
}

}  // namespace
}  // namespace muldi::fem
