#include <gtest/gtest.h>

#include <random>

#include "base/error.hpp"
#include "math/block_matrix.hpp"

namespace muldi::math {
namespace {

TEST(BlockPattern, IsSymmetricAndHoldsTheDiagonal) {
  const BlockPattern pattern({2, 1, 3}, {{0, 2}, {0, 2}});
  EXPECT_EQ(pattern.n_rows(), 6);
  EXPECT_EQ(pattern.columns(0), (std::vector<int>{0, 2}));
  EXPECT_EQ(pattern.columns(1), (std::vector<int>{1}));
  EXPECT_EQ(pattern.columns(2), (std::vector<int>{0, 2}));
  EXPECT_TRUE(pattern.contains(2, 0));
  EXPECT_FALSE(pattern.contains(1, 2));
  EXPECT_EQ(pattern.n_values(), 2 * 5 + 1 + 3 * 5);
}

TEST(BlockPattern, GivesEveryValueToExactlyOneBlock) {
  const BlockPattern pattern({2, 1, 3, 12}, {{0, 2}, {3, 1}, {2, 3}});
  std::vector<int> owners(static_cast<std::size_t>(pattern.n_values()), 0);
  for (int i = 0; i < pattern.n_nodes(); ++i) {
    for (const int j : pattern.columns(i)) {
      const BlockSlot slot = pattern.slot(i, j);
      for (int r = 0; r < pattern.size(i); ++r) {
        for (int c = 0; c < pattern.size(j); ++c) ++owners[static_cast<std::size_t>(slot.first + r * slot.stride + c)];
      }
    }
  }
  EXPECT_EQ(owners, std::vector<int>(owners.size(), 1));
}

TEST(BlockPattern, RefusesTheSlotOfABlockThatIsNotStored) {
  const BlockPattern pattern({2, 1}, {});
  EXPECT_THROW(static_cast<void>(pattern.slot(0, 1)), base::ContractError);
}

TEST(BlockMatrix, MultipliesLikeItsDenseForm) {
  const BlockPattern pattern({12, 1, 3, 12}, {{0, 2}, {3, 1}, {2, 3}});
  BlockMatrix A(pattern);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> in(-1.0, 1.0);
  for (int i = 0; i < pattern.n_nodes(); ++i) {
    for (const int j : pattern.columns(i)) {
      auto block = A.block(i, j);
      for (Eigen::Index r = 0; r < block.rows(); ++r)
        for (Eigen::Index c = 0; c < block.cols(); ++c) block(r, c) = in(random);
    }
  }
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(pattern.n_rows(), -1.0, 2.0);
  Eigen::VectorXd y = Eigen::VectorXd::Constant(pattern.n_rows(), 7.0);  // is overwritten
  A.multiply(x, y);
  EXPECT_LT((y - A.dense() * x).lpNorm<Eigen::Infinity>(), 1e-14);
  EXPECT_EQ(A.dense()(0, 12), 0.0) << "nodes 0 and 1 are not coupled";
  A.set_zero();
  EXPECT_EQ(A.dense().norm(), 0.0);
}

}  // namespace
}  // namespace muldi::math
