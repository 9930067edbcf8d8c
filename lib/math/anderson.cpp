#include "math/anderson.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace muldi::math {
namespace {

/// A difference with less than this part of its squared length outside the span of newer ones is left out.
constexpr double independent = 1e-12;
constexpr double growth_limit = 2.0;

}  // namespace

AndersonAcceleration::AndersonAcceleration(int depth, Eigen::VectorXd weights)
    : depth_(depth),
      weights_(std::move(weights)),
      x_differences_(static_cast<std::size_t>(depth)),
      f_differences_(static_cast<std::size_t>(depth)),
      gram_(depth, depth),
      lower_(depth, depth),
      right_(depth),
      coefficients_(depth) {
  MULDI_EXPECT(depth >= 1, "at least one difference");
}

double AndersonAcceleration::product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  return weights_.size() == 0 ? a.dot(b) : (a.array() * b.array() * weights_.array().square()).sum();
}

/// The differences to the last iterate replace the oldest ones.
void AndersonAcceleration::remember(const Eigen::VectorXd& x, const Eigen::VectorXd& f) {
  newest_ = (newest_ + 1) % depth_;
  count_ = std::min(count_ + 1, depth_);
  x_differences_[static_cast<std::size_t>(newest_)] = x - last_x_;
  f_differences_[static_cast<std::size_t>(newest_)] = f - last_f_;
  for (int i = 0; i < count_; ++i) {
    const int place = (newest_ - i + depth_) % depth_;
    gram_(newest_, place) =
        product(f_differences_[static_cast<std::size_t>(newest_)], f_differences_[static_cast<std::size_t>(place)]);
    gram_(place, newest_) = gram_(newest_, place);
  }
}

/// The combination of the differences that is nearest to f, into coefficients_ (newest first); zero for dependent ones.
bool AndersonAcceleration::combine(const Eigen::VectorXd& f) {
  const auto place = [&](int i) { return (newest_ - i + depth_) % depth_; };
  for (int i = 0; i < count_; ++i) {
    double pivot = gram_(place(i), place(i));
    right_(i) = product(f_differences_[static_cast<std::size_t>(place(i))], f);
    for (int j = 0; j < i; ++j) {
      double sum = gram_(place(i), place(j));
      for (int k = 0; k < j; ++k) sum -= lower_(i, k) * lower_(j, k);
      lower_(i, j) = lower_(j, j) > 0.0 ? sum / lower_(j, j) : 0.0;
      pivot -= lower_(i, j) * lower_(i, j);
      right_(i) -= lower_(i, j) * right_(j);
    }
    const bool keeps = pivot > independent * gram_(place(i), place(i)) && pivot > 0.0;
    lower_(i, i) = keeps ? std::sqrt(pivot) : 0.0;
    right_(i) = keeps ? right_(i) / lower_(i, i) : 0.0;
  }
  for (int i = count_ - 1; i >= 0; --i) {
    double sum = right_(i);
    for (int k = i + 1; k < count_; ++k) sum -= lower_(k, i) * coefficients_(k);
    coefficients_(i) = lower_(i, i) > 0.0 ? sum / lower_(i, i) : 0.0;
  }
  return coefficients_.head(count_).allFinite();
}

void AndersonAcceleration::accelerate(const Eigen::VectorXd& x, Eigen::VectorXd& f) {
  MULDI_EXPECT(x.size() == f.size() && (weights_.size() == 0 || weights_.size() == f.size()), "vectors of one size");
  const double norm = std::sqrt(product(f, f));
  // Growth says that the history (or the factor behind f) describes another place.
  if (has_last_ && !(norm <= growth_limit * last_norm_)) reset();
  if (has_last_) remember(x, f);
  last_x_ = x;
  last_f_ = f;
  last_norm_ = norm;
  has_last_ = true;
  if (count_ == 0 || !combine(last_f_)) return;
  for (int i = 0; i < count_; ++i) {
    const std::size_t place = static_cast<std::size_t>((newest_ - i + depth_) % depth_);
    f -= coefficients_(i) * (x_differences_[place] + f_differences_[place]);
  }
}

}  // namespace muldi::math
