#include "pipeline/study/identifiability.hpp"

#include <Eigen/SVD>
#include <array>
#include <cmath>
#include <limits>

#include "base/text.hpp"

namespace muldi::pipeline {
namespace {

constexpr double no_share = 1e-4;    // of a combination, below which a parameter is no part of it
constexpr double weak_share = 0.02;  // the same of a weak one, which is no sharp direction
constexpr double weak_limit = 0.5;   // relative half-width from which a combination is hardly determined

/// The basis of a null space (n, k) with as few parameters in each direction as elimination finds.
void simplify(Eigen::MatrixXd& N) {
  Eigen::Index column = 0;
  std::vector<bool> used(static_cast<std::size_t>(N.rows()), false);
  for (; column < N.cols(); ++column) {
    Eigen::Index pivot = -1;
    for (Eigen::Index i = 0; i < N.rows(); ++i) {
      if (used[static_cast<std::size_t>(i)]) continue;
      if (pivot < 0 || std::abs(N(i, column)) > std::abs(N(pivot, column))) pivot = i;
    }
    used[static_cast<std::size_t>(pivot)] = true;
    N.col(column) /= N(pivot, column);
    for (Eigen::Index other = 0; other < N.cols(); ++other) {
      if (other != column) N.col(other) -= N(pivot, other) * N.col(column);
    }
  }
}

}  // namespace

double student_quantile(long freedom) {
  if (freedom < 1) return std::numeric_limits<double>::quiet_NaN();
  // Exact to four digits; beyond ten degrees of freedom the expansion of Fisher and Cornish is.
  constexpr std::array<double, 10> table{12.7062, 4.3027, 3.1824, 2.7764, 2.5706,
                                         2.4469,  2.3646, 2.3060, 2.2622, 2.2281};
  if (freedom <= static_cast<long>(table.size())) return table[static_cast<std::size_t>(freedom) - 1];
  const double z = 1.959963984540054;
  const double n = static_cast<double>(freedom);
  const double z3 = z * z * z;
  const double z5 = z3 * z * z;
  const double z7 = z5 * z * z;
  return z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n);
}

FitQuality fit_quality(const Eigen::MatrixXd& J, const Eigen::VectorXd& r, const Eigen::VectorXd& theta,
                       const Eigen::VectorXd& scale, double tolerance) {
  const Eigen::Index n = J.cols();
  FitQuality quality;
  quality.freedom = J.rows() - n;
  Eigen::VectorXd unit = theta.cwiseAbs();
  for (Eigen::Index k = 0; k < n; ++k) {
    if (unit[k] == 0.0) unit[k] = scale[k];
  }
  const Eigen::MatrixXd relative = J * unit.asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(relative, Eigen::ComputeThinU | Eigen::ComputeFullV);
  const Eigen::VectorXd& s = svd.singularValues();
  const double largest = s.size() > 0 ? s[0] : 0.0;
  quality.singular_values = Eigen::VectorXd::Zero(n);
  if (largest > 0.0) quality.singular_values.head(s.size()) = s / largest;
  Eigen::Index rank = 0;
  while (rank < n && quality.singular_values[rank] > tolerance) ++rank;
  const Eigen::MatrixXd& V = svd.matrixV();

  quality.residual_deviation =
      quality.freedom > 0 ? r.norm() / std::sqrt(static_cast<double>(quality.freedom)) : std::nan("");
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < rank; ++i) variance += (V.col(i) / s[i]).cwiseAbs2();
  quality.deviation = quality.residual_deviation * unit.cwiseProduct(variance.cwiseSqrt());
  const double t = student_quantile(quality.freedom);
  Eigen::Index strong = rank;
  while (strong > 0 && t * quality.residual_deviation / s[strong - 1] > weak_limit) --strong;
  const auto add = [&](Eigen::Index first, Eigen::Index count, bool weak) {
    Eigen::MatrixXd N = V.middleCols(first, count);
    if (count > 0) simplify(N);
    for (Eigen::Index c = 0; c < count; ++c) {
      N.col(c) /= N.col(c).cwiseAbs().maxCoeff();
      FreeCombination combination{.weak = weak};
      for (Eigen::Index k = 0; k < n; ++k) {
        if (std::abs(N(k, c)) < (weak ? weak_share : no_share)) continue;
        combination.parameters.push_back(static_cast<std::size_t>(k));
        combination.shares.push_back(N(k, c));
        if (!weak) quality.deviation[k] = std::numeric_limits<double>::infinity();
      }
      quality.combinations.push_back(std::move(combination));
    }
  };
  add(rank, n - rank, false);
  add(strong, rank - strong, true);
  quality.half_width = t * quality.deviation;
  return quality;
}

std::string describe(const FreeCombination& combination, const std::vector<std::string>& names) {
  std::vector<std::string> own;
  std::vector<std::string> changes;
  for (std::size_t i = 0; i < combination.parameters.size(); ++i) {
    own.push_back(names[combination.parameters[i]]);
    changes.push_back(base::format("{:+.3g} %", combination.shares[i]));
  }
  const std::string what =
      combination.weak ? "hardly changes what is compared, within its errors" : "changes nothing that is compared";
  if (own.size() == 1) {
    return combination.weak ? base::format("the data hardly determine {}", own.front())
                            : base::format("the data say nothing about {}: take it out of `fit`", own.front());
  }
  return base::format(
      "the data {} tell {} apart: changing them together by {} {}; hold one of them fixed, or compare more",
      combination.weak ? "can hardly" : "cannot", base::joined(own, " and "), base::joined(changes, ", "), what);
}

}  // namespace muldi::pipeline
