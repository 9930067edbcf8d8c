#pragma once
/// Iterative solvers for A x = b with a preconditioner P ~ A^-1, both given as callables f(x, y): y = A x, y = P x.
///
/// Objects keep their vectors: no memory is requested after the first solve of a size. The same bits for any number of
/// threads, if the callables keep to that.
#include <Eigen/Core>
#include <memory>
#include <vector>

namespace muldi::math {

/// Refers to a callable (const VectorXd& x, VectorXd& y) that writes y = A x; the callable must outlive the call that
/// it is passed to.
class LinearMap {
 public:
  template <class F>
  LinearMap(const F& f)  // NOLINT(google-explicit-constructor): lambdas are passed as they are
      : object_(std::addressof(f)), call_([](const void* object, const Eigen::VectorXd& x, Eigen::VectorXd& y) {
          (*static_cast<const F*>(object))(x, y);
        }) {}

  void operator()(const Eigen::VectorXd& x, Eigen::VectorXd& y) const { call_(object_, x, y); }

 private:
  const void* object_;
  void (*call_)(const void*, const Eigen::VectorXd&, Eigen::VectorXd&);
};

struct KrylovLimits {
  double relative_tolerance = 1e-8;  ///< of |b|; the residual is measured as each solver says
  double absolute_tolerance = 0.0;   ///< converged too when the residual is at most this
  int max_iterations = 500;
};

enum class KrylovEnd {
  converged,
  iteration_limit,
  breakdown,  ///< A or P is not what the solver needs (not definite, or no numbers); x is the last iterate
};

struct KrylovOutcome {
  KrylovEnd end = KrylovEnd::iteration_limit;
  int iterations = 0;     ///< products with A after the one for the start
  double residual = 0.0;  ///< at the end, estimated by the recurrence

  bool converged() const { return end == KrylovEnd::converged; }
};

/// Conjugate gradients for A and P positive definite, in the flexible form of Polak and Ribiere (Notay 2000, SIAM J.
/// Sci. Comput. 22), which tolerates a P rounded to single precision. Residual: |b - A x|_2.
class ConjugateGradients {
 public:
  /// Improves x, the start.
  KrylovOutcome solve(LinearMap a, LinearMap p, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                      const KrylovLimits& limits = {});

 private:
  Eigen::VectorXd r_, z_, d_, q_;
};

/// MINRES (Paige and Saunders 1975) for A symmetric and P positive definite. Residual: (r . P r)^1/2, relative to that
/// of b.
class Minres {
 public:
  /// Improves x, the start.
  KrylovOutcome solve(LinearMap a, LinearMap p, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                      const KrylovLimits& limits = {});

 private:
  Eigen::VectorXd r_before_, r_, v_, z_, w_, w_before_, product_;
};

/// Flexible GMRES with restarts (Saad 1993, SIAM J. Sci. Comput. 14) for any A and a P that may change from iteration
/// to iteration. Residual: |b - A x|_2.
class FlexibleGmres {
 public:
  /// `restart`: vectors kept, twice.
  explicit FlexibleGmres(int restart = 30);
  /// Improves x, the start.
  KrylovOutcome solve(LinearMap a, LinearMap p, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                      const KrylovLimits& limits = {});

 private:
  bool extend(LinearMap a, LinearMap p, int k);
  double rotate(int k);
  void correct(int k, Eigen::VectorXd& x);

  int restart_;
  std::vector<Eigen::VectorXd> basis_;           // restart + 1, made when first needed
  std::vector<Eigen::VectorXd> preconditioned_;  // restart
  Eigen::MatrixXd hessenberg_;
  Eigen::VectorXd cosines_, sines_, g_, y_;
};

}  // namespace muldi::math
