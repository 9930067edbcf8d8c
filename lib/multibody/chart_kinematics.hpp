#pragma once
/// Kinematics of a tree in its chart, templated on the scalar: with dual numbers all derivatives along a direction.
///
/// The motions of the tree are rotations and slides, one behind the other from the root outwards. A motion j moves
/// everything behind it rigidly, so that with the axes omega_j, the slides s_j and the pivots p_j of the moment
///
///     d x/d theta_k = omega_k x (x - p_k)  or  s_k,       d2 x/d theta_j d theta_k = omega_j x (d x/d theta_k)
///
/// for j before k, or 0 where j slides. The three angles of a ball are a rotation vector: there
/// d2 x/d theta_b d theta_a = (d omega_a/d theta_b) x (x - p) + omega_a x (omega_b x (x - p)).
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "math/jet.hpp"
#include "math/jet_eigen.hpp"
#include "multibody/kinematic_tree.hpp"

namespace muldi::multibody {

template <class S>
using Vector3s = Eigen::Matrix<S, 3, 1>;
template <class S>
using Matrix3s = Eigen::Matrix<S, 3, 3>;

/// Motions of a joint in the order in which they move what hangs on it: `sign` -1 where the joint is reversed.
struct MotionGroup {
  Motion::Kind kind = Motion::Kind::slide;
  int axis = 0;
  int coordinate = 0;  ///< in x
  int rate = 0;        ///< in theta
  double sign = 1.0;
  int link = 0;

  int size() const { return kind == Motion::Kind::ball ? 3 : 1; }
  bool slides() const { return kind == Motion::Kind::slide; }
};

/// Values of one configuration.
template <class S>
struct ChartKinematics {
  std::vector<Vector3s<S>> position;                   ///< of the links' bodies
  std::vector<Matrix3s<S>> orientation;                ///< likewise
  std::vector<Vector3s<S>> axis;                       ///< omega or slide of every rate
  std::vector<Vector3s<S>> pivot;                      ///< of every rate; unused by slides
  std::vector<std::array<Vector3s<S>, 9>> axis_slope;  ///< of every group: d omega_a/d theta_b at 3 a + b, balls only
};

/// Weights z of the unknowns of q, summed over the subtree of every link.
template <class S>
struct SubtreeWeights {
  std::vector<Vector3s<S>> force;   ///< of positions
  std::vector<Matrix3s<S>> moment;  ///< z x^T of positions and directors
};

/// N = sum z (x - p)^T over a subtree: for motions about the pivot p, sum z . (U (x - p)) = sum_ij U_ij N_ij.
template <class S>
Matrix3s<S> moment_about(const Vector3s<S>& pivot, const Vector3s<S>& force, const Matrix3s<S>& moment) {
  Matrix3s<S> N;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) N(r, c) = moment(r, c) - force[r] * pivot[c];
  }
  return N;
}

/// g with sum z . (v x (omega x (x - p))) = v . g.
template <class S>
Vector3s<S> response_to_turn(const Matrix3s<S>& N, const Vector3s<S>& omega) {
  const S trace = N(0, 0) + N(1, 1) + N(2, 2);
  Vector3s<S> g;
  for (int r = 0; r < 3; ++r) {
    g[r] = N(0, r) * omega[0] + N(1, r) * omega[1] + N(2, r) * omega[2] - trace * omega[r];
  }
  return g;
}

template <class S>
S dot(const Vector3s<S>& a, const Vector3s<S>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class S>
Matrix3s<S> hat_of(const Vector3s<S>& v) {
  Matrix3s<S> m;
  m << S(0.0), -v[2], v[1], v[2], S(0.0), -v[0], -v[1], v[0], S(0.0);
  return m;
}

template <class S>
Vector3s<S> cross(const Vector3s<S>& a, const Vector3s<S>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// c_k(t) = sum_i (-t)^i/(2 i + k)!: with t the square of an angle x, sin x/x, (1 - cos x)/x^2, (x - sin x)/x^3.
template <class S>
std::array<S, 3> rotation_series(const S& t) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  if (math::number(t) > 1.0) {
    const S x = sqrt(t);
    const S sine = sin(x);
    return {S(sine / x), S((1.0 - cos(x)) / t), S((x - sine) / (t * x))};
  }
  constexpr int n_terms = 12;
  std::array<S, 3> sum{S(0.0), S(0.0), S(0.0)};
  for (int i = n_terms; i-- > 0;) {
    // Horner from the back: 1/k! (1 - t/((k+1)(k+2)) (1 - ...)).
    for (int k = 1; k <= 3; ++k) {
      auto& c = sum[static_cast<std::size_t>(k - 1)];
      c = 1.0 - t * c * (1.0 / ((2 * i + k + 1) * (2 * i + k + 2)));
    }
  }
  sum[1] *= S(0.5);
  sum[2] *= S(1.0 / 6.0);
  return sum;
}

/// exp(v) and the matrix J of its rates: d exp(v)/dv_a = hat(J e_a) exp(v).
template <class S>
struct RotationVector {
  Matrix3s<S> rotation;
  Matrix3s<S> rates;

  explicit RotationVector(const Vector3s<S>& v) {
    const std::array<S, 3> c = rotation_series(S(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    const Matrix3s<S> h = hat_of(v);
    const Matrix3s<S> hh = h * h;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double one = i == j ? 1.0 : 0.0;
        rotation(i, j) = one + c[0] * h(i, j) + c[1] * hh(i, j);
        rates(i, j) = one + c[1] * h(i, j) + c[2] * hh(i, j);
      }
    }
  }
};

/// d(J e_a)/dv_b at 3 a + b.
template <class S>
std::array<Vector3s<S>, 9> rotation_rate_slopes(const Vector3s<S>& v) {
  using Seed = math::Dual<S>;
  std::array<Vector3s<S>, 9> slopes;
  for (int b = 0; b < 3; ++b) {
    Vector3s<Seed> seeded;
    for (int i = 0; i < 3; ++i) seeded[i] = Seed(v[i], S(i == b ? 1.0 : 0.0));
    const RotationVector<Seed> along(seeded);
    for (int a = 0; a < 3; ++a) {
      for (int i = 0; i < 3; ++i) slopes[static_cast<std::size_t>(3 * a + b)][i] = along.rates(i, a).slope;
    }
  }
  return slopes;
}

/// E turned about its own column `axis` by the angle.
template <class S>
void turn_about(Matrix3s<S>& E, int axis, const S& angle) {
  using std::cos;
  using std::sin;
  const S c = cos(angle);
  const S s = sin(angle);
  const int i = (axis + 1) % 3;
  const int j = (axis + 2) % 3;
  const Vector3s<S> e_i = E.col(i);
  const Vector3s<S> e_j = E.col(j);
  for (int r = 0; r < 3; ++r) {
    E(r, i) = c * e_i[r] + s * e_j[r];
    E(r, j) = c * e_j[r] - s * e_i[r];
  }
}

template <class S>
Vector3s<S> apply(const Matrix3s<S>& E, const Eigen::Vector3d& local) {
  Vector3s<S> v;
  for (int r = 0; r < 3; ++r) v[r] = E(r, 0) * local[0] + E(r, 1) * local[1] + E(r, 2) * local[2];
  return v;
}
template <class S>
Matrix3s<S> apply(const Matrix3s<S>& E, const Eigen::Matrix3d& local) {
  Matrix3s<S> m;
  for (int k = 0; k < 3; ++k) m.col(k) = apply(E, Eigen::Vector3d(local.col(k)));
  return m;
}

}  // namespace muldi::multibody
