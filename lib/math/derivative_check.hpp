#pragma once
/// Referees of derivatives: differences, the complex step and Taylor tests; also usable on a user's own scene.
#include <Eigen/Core>
#include <complex>
#include <functional>
#include <vector>

namespace muldi::math {

/// A function of n variables with m values.
using VectorFunction = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// The worst entry of a derivative against its referee.
struct DerivativeError {
  double relative = 0.0;  ///< |given - expected| over the largest magnitude in either matrix; NaN if one holds a NaN
  Eigen::Index row = 0;
  Eigen::Index column = 0;
  double given = 0.0;
  double expected = 0.0;
};

/// Compares two derivatives of the same shape.
DerivativeError derivative_error(const Eigen::MatrixXd& given, const Eigen::MatrixXd& expected);

/// Jacobian (m, n) at x (n) by central differences with steps h, h/2, h/4 (n) and Richardson extrapolation: error of
/// order h^6. Good to about 1e-11 for smooth functions with h near 1e-2 of the length over which they change.
Eigen::MatrixXd difference_jacobian(const VectorFunction& f, const Eigen::VectorXd& x, const Eigen::VectorXd& h);

/// Jacobian (m, n) at x (n) by the complex step Im f(x + i h e_j)/h: exact to round-off for functions that are analytic
/// and templated on the scalar. `f` maps an Eigen::VectorXcd (n) to an Eigen::VectorXcd (m).
template <class Function>
Eigen::MatrixXd complex_step_jacobian(const Function& f, const Eigen::VectorXd& x) {
  constexpr double h = 1e-30;
  Eigen::MatrixXd jacobian;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    Eigen::VectorXcd at = x.cast<std::complex<double>>();
    at[j] += std::complex<double>(0.0, h);
    const Eigen::VectorXcd value = f(at);
    if (j == 0) jacobian.resize(value.size(), x.size());
    jacobian.col(j) = value.imag() / h;
  }
  return jacobian;
}

/// Remainders |f(x + h d) - f(x) - sum_k h^k/k! f^(k)| over halved steps h.
struct TaylorTest {
  std::vector<double> step;
  std::vector<double> remainder;
  /// Least-squares slope of log remainder over log step at the three finest steps above round-off; one more than the
  /// number of correct derivatives. Infinite if every remainder is round-off: the derivatives are exact.
  double slope = 0.0;
};

/// Where and how a Taylor test looks.
struct TaylorSetup {
  Eigen::VectorXd x;          ///< (n)
  Eigen::VectorXd direction;  ///< d (n)
  double first_step = 1e-2;
  int n_steps = 8;
};

/// `derivatives`: f^(k) = d^k f(x + s d)/ds^k at s = 0, k = 1, 2, ..., each (m): J d, d.H.d and so on.
TaylorTest taylor_test(const VectorFunction& f, const std::vector<Eigen::VectorXd>& derivatives,
                       const TaylorSetup& setup);

}  // namespace muldi::math
