#pragma once
/// Anderson acceleration of fixed-point iterations (Walker and Ni 2011, SIAM J. Numer. Anal. 49): chord iterations with
/// an old factor converge in fewer steps.
#include <Eigen/Core>
#include <vector>

namespace muldi::math {

/// Combines the last updates so that their combination is least. No memory is requested after the first use.
///
/// Safe-guarded: differences that depend on newer ones are left out, and the history is dropped when an update is more
/// than twice as long as the one before it.
class AndersonAcceleration {
 public:
  /// `depth`: differences kept (>= 1). `weights` (n): positive factors of the unknowns in the norm, one if it is empty;
  /// for unknowns of different units.
  explicit AndersonAcceleration(int depth, Eigen::VectorXd weights = {});

  /// Forgets the history: a new step, a new factor.
  void reset() { count_ = 0, has_last_ = false; }
  /// Replaces f, the plain update of the iterate x (its fixed point has f = 0), by the accelerated one: the caller goes
  /// on from x + f.
  void accelerate(const Eigen::VectorXd& x, Eigen::VectorXd& f);
  /// Differences in the history.
  int n_kept() const { return count_; }

 private:
  void remember(const Eigen::VectorXd& x, const Eigen::VectorXd& f);
  bool combine(const Eigen::VectorXd& f);
  double product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;

  int depth_;
  int count_ = 0;
  int newest_ = -1;
  bool has_last_ = false;
  double last_norm_ = 0.0;
  Eigen::VectorXd weights_;
  Eigen::VectorXd last_x_, last_f_;
  std::vector<Eigen::VectorXd> x_differences_, f_differences_;
  Eigen::MatrixXd gram_;   // of the differences of updates, by their places
  Eigen::MatrixXd lower_;  // its Cholesky factor, newest difference first
  Eigen::VectorXd right_, coefficients_;
};

}  // namespace muldi::math
