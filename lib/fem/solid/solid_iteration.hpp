#pragma once
/// The matrix of a large solid in dynamics, solved by iteration (performance, 0.5 and 4).
///
/// Where mass or viscosity dominate, a Chebyshev polynomial serves the positions and multigrid the potential; the
/// matrix of both is kept in single precision as well, which halves what an application reads.
#include <optional>
#include <string>
#include <vector>

#include "fem/solid/solid_linear.hpp"
#include "math/coupled_preconditioner.hpp"
#include "math/krylov.hpp"

namespace muldi::fem {

/// Which iteration; `cg` for definite matrices only.
enum class KrylovMethod { cg, minres, gmres };

class SolidIteration final : public SolidLinear {
 public:
  struct Options {
    KrylovMethod method = KrylovMethod::cg;
    double accuracy = 1e-3;  ///< relative, of the residual
    math::BlockChebyshev::Degrees degrees = {};
    int expected_negative = 0;  ///< what n_negative() says of a matrix that shows no sign of another count
  };
  SolidIteration(const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
                 std::vector<std::vector<int>> electrodes, Options options);

  double accuracy() const override { return options_.accuracy; }
  std::string name() const override { return name_of(options_); }
  static std::string name_of(const Options& options);
  /// Bytes of the preconditioner and of the vectors, known before they are made.
  static double bytes_of(const math::SymmetricBlockPattern& pattern, const Options& options);
  /// Iterations of all solves so far.
  long iterations() const { return iterations_; }

 private:
  double prepare() override { return balance_potentials(matrix_, mask_); }
  int factorise_free() override;
  void solve_free(Eigen::VectorXd& x) override;

  Options options_;
  math::CoupledPreconditioner preconditioner_;
  math::ConjugateGradients cg_;
  math::Minres minres_;
  math::FlexibleGmres gmres_;
  Eigen::VectorXd rhs_;
  long iterations_ = 0;
};

}  // namespace muldi::fem
