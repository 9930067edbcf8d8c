#pragma once
/// A Chebyshev polynomial of the node-block Jacobi preconditioned matrix, in single precision.
#include <Eigen/Core>
#include <vector>

#include "math/sparse_block_matrix.hpp"

namespace muldi::math {

/// P ~ A^-1 for a symmetric positive definite block matrix, or for the leading part of its blocks (the displacement
/// beside a potential). Good where mass or viscosity dominate; needs no coarse grids. The same bits for any number of
/// threads. Saad, Iterative methods for sparse linear systems, algorithm 12.1.
class BlockChebyshev {
 public:
  /// Least and largest degree: products with A and one (>= 1) for an application. Of these it takes the one that fits
  /// the spectrum, 5/4 of the square root of its ratio: with less the iteration has to do what an application leaves,
  /// at the price of its own products, with more an application does what nobody asks for.
  struct Degrees {
    int least = 6;
    int largest = 6;
  };
  /// The pattern must outlive the object.
  BlockChebyshev(const SymmetricBlockPattern& pattern, int block_size, Degrees degrees);

  /// Takes new values. False if a diagonal block is not positive definite; the object is not usable then. The
  /// eigenvalues are estimated by Lanczos steps at the first time and when `new_spectrum` is set.
  bool update(const SymmetricBlockMatrix& matrix, bool new_spectrum = false);
  /// For every node, block_size entries of r (`stride` from node to node) to as many of z, the others of z are kept.
  void apply(const Eigen::VectorXd& r, int stride, Eigen::VectorXd& z);
  /// The interval of the polynomial.
  double lower_bound() const { return lower_; }
  double upper_bound() const { return upper_; }
  int degree() const { return degree_; }
  std::ptrdiff_t bytes() const;

 private:
  void estimate_spectrum();
  void times_inverse_diagonal(const Eigen::VectorXf& r, Eigen::VectorXf& out) const;
  template <int b>
  void step(float momentum, float gain, bool first);

  FloatBlockMatrix matrix_;
  Degrees degrees_;
  int degree_;
  double lower_ = 0.0;
  double upper_ = 0.0;
  std::vector<float> inverse_diagonal_;
  Eigen::VectorXf x_, r_, d_, q_;
};

}  // namespace muldi::math
