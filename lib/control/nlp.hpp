#pragma once
/// A nonlinear program without a solver: functions, sparse structure, values.
///
///     min f(x)   with   x_lower <= x <= x_upper,   c_lower <= c(x) <= c_upper.
#include <Eigen/Core>
#include <vector>

namespace muldi::control {

/// Places of the entries that may differ from 0, each once.
struct SparsePattern {
  std::vector<int> rows = {};
  std::vector<int> columns = {};

  std::size_t size() const { return rows.size(); }
};

struct NlpBounds {
  Eigen::VectorXd x_lower;
  Eigen::VectorXd x_upper;
  Eigen::VectorXd c_lower;
  Eigen::VectorXd c_upper;
};

class Nlp {
 public:
  virtual ~Nlp() = default;

  virtual int n_variables() const = 0;
  virtual int n_constraints() const = 0;
  virtual const NlpBounds& bounds() const = 0;
  virtual const SparsePattern& jacobian_pattern() const = 0;
  /// Lower triangle.
  virtual const SparsePattern& hessian_pattern() const = 0;

  /// Where the functions below are evaluated; false if they cannot be.
  virtual bool move_to(const Eigen::VectorXd& x) = 0;
  virtual double objective() = 0;
  virtual void gradient(Eigen::VectorXd& out) = 0;
  virtual void constraints(Eigen::VectorXd& out) = 0;
  /// Values in the order of the pattern.
  virtual void jacobian(double* values) = 0;
  /// Of factor f + mu . c.
  virtual void hessian(double factor, const Eigen::VectorXd& mu, double* values) = 0;
};

}  // namespace muldi::control
