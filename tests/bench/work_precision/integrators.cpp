#include "bench/work_precision/integrators.hpp"

#include <cmath>

namespace muldi::bench {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_coordinates, most_coordinates>;

constexpr double newton_tolerance = 1e-12;  // of increments, relative to 1 rad or 1 mm
constexpr int newton_limit = 12;
constexpr double spectral_radius = 0.8;  // of generalised-alpha at infinite frequency

struct Point {
  Coordinates x;
  Coordinates v;
  Coordinates a;
};

void runge_kutta_4(const MinimalSystem& system, double h, Point& y) {
  Coordinates a1, a2, a3, a4;
  system.acceleration(y.x, y.v, a1);
  const Coordinates v2 = y.v + 0.5 * h * a1;
  system.acceleration(y.x + 0.5 * h * y.v, v2, a2);
  const Coordinates v3 = y.v + 0.5 * h * a2;
  system.acceleration(y.x + 0.5 * h * v2, v3, a3);
  const Coordinates v4 = y.v + h * a3;
  system.acceleration(y.x + h * v3, v4, a4);
  y.x += h / 6.0 * (y.v + 2.0 * v2 + 2.0 * v3 + v4);
  y.v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
}

/// The implicit methods as one family with the unknown A = x''-like value of the step's end:
///     x1 = x0 + h v0 + h^2 (c0 a0 + c1 A),  v1 = v0 + h (d0 a0 + d1 A),  m1 A + m0 a0 = f1 a(x1, v1) + f0 f(t0),
/// where a0 is A of the step before and f(t0) = a(x0, v0).
struct Family {
  double c0 = 0.0, c1 = 0.0, d0 = 0.0, d1 = 0.0, m0 = 0.0, m1 = 0.0, f0 = 0.0, f1 = 0.0;
};

Family family_of(Method method) {
  switch (method) {
    case Method::implicit_euler:
      return {.c0 = 0.0, .c1 = 1.0, .d0 = 0.0, .d1 = 1.0, .m0 = 0.0, .m1 = 1.0, .f0 = 0.0, .f1 = 1.0};
    case Method::trapezoidal:
      return {.c0 = 0.25, .c1 = 0.25, .d0 = 0.5, .d1 = 0.5, .m0 = 0.0, .m1 = 1.0, .f0 = 0.0, .f1 = 1.0};
    default:
      break;
  }
  const double r = spectral_radius;
  const double am = (2.0 * r - 1.0) / (r + 1.0);
  const double af = r / (r + 1.0);
  const double gamma = 0.5 - am + af;
  const double beta = 0.25 * (1.0 - am + af) * (1.0 - am + af);
  return {
      .c0 = 0.5 - beta, .c1 = beta, .d0 = 1.0 - gamma, .d1 = gamma, .m0 = am, .m1 = 1.0 - am, .f0 = af, .f1 = 1.0 - af};
}

/// Simplified Newton: the Jacobian, by differences, is kept over steps until convergence slows down.
class ImplicitStepper {
 public:
  ImplicitStepper(const MinimalSystem& system, const Family& family, double h)
      : system_(system), family_(family), h_(h) {}

  bool advance(Point& y) {
    if (f_.size() == 0) system_.acceleration(y.x, y.v, f_);
    for (int attempt = 0; attempt < 2; ++attempt) {
      if (!is_factorised_ || attempt > 0) factorise(y);
      if (iterate(y)) return true;
      is_factorised_ = false;
    }
    return false;
  }

 private:
  bool iterate(Point& y) {
    Point to{.x = y.x, .v = y.v, .a = y.a};
    Coordinates f;
    double last = 0.0;
    for (int i = 0; i < newton_limit; ++i) {
      to.x = y.x + h_ * y.v + h_ * h_ * (family_.c0 * y.a + family_.c1 * to.a);
      to.v = y.v + h_ * (family_.d0 * y.a + family_.d1 * to.a);
      system_.acceleration(to.x, to.v, f);
      const Coordinates r = family_.m1 * to.a + family_.m0 * y.a - family_.f1 * f - family_.f0 * f_;
      const Coordinates da = lu_.solve(r);
      to.a -= da;
      const double size = h_ * h_ * family_.c1 * da.lpNorm<Eigen::Infinity>();
      if (!std::isfinite(size)) return false;
      if (size <= newton_tolerance) {
        to.x -= h_ * h_ * family_.c1 * da;
        to.v -= h_ * family_.d1 * da;
        is_factorised_ = i <= 4;  // slow: a new Jacobian in the next step
        y = to;
        f_ = f;
        return true;
      }
      if (i > 0 && size > 0.9 * last) return false;
      last = size;
    }
    return false;
  }

  void factorise(const Point& y) {
    const auto n = y.x.size();
    Matrix S = family_.m1 * Matrix::Identity(n, n);
    Coordinates plus, minus;
    for (Eigen::Index j = 0; j < n; ++j) {
      constexpr double e = 1e-6;
      const Coordinates d = e * Coordinates::Unit(n, j);
      system_.acceleration(y.x + d, y.v, plus);
      system_.acceleration(y.x - d, y.v, minus);
      S.col(j) -= family_.f1 * h_ * h_ * family_.c1 / (2.0 * e) * (plus - minus);
      system_.acceleration(y.x, y.v + d, plus);
      system_.acceleration(y.x, y.v - d, minus);
      S.col(j) -= family_.f1 * h_ * family_.d1 / (2.0 * e) * (plus - minus);
    }
    lu_.compute(S);
    is_factorised_ = true;
  }

  const MinimalSystem& system_;
  Family family_;
  double h_;
  Coordinates f_;  // a(x, v) at the start of the step
  Eigen::PartialPivLU<Matrix> lu_;
  bool is_factorised_ = false;
};

}  // namespace

std::string name_of(Method method) {
  switch (method) {
    case Method::runge_kutta_4:
      return "explicit Runge-Kutta 4";
    case Method::implicit_euler:
      return "implicit Euler";
    case Method::trapezoidal:
      return "trapezoidal rule";
    case Method::generalised_alpha:
      return "generalised-alpha";
  }
  return "";
}

std::string options_of(Method method) {
  const std::string equations = "joint coordinates, hand-written equations of motion, fixed step";
  if (method == Method::runge_kutta_4) return equations + "; the classical four stages";
  const std::string newton =
      "; simplified Newton to increments of 1e-12, central-difference Jacobian kept until an iteration takes more than "
      "five steps";
  if (method == Method::generalised_alpha) return equations + "; spectral radius 0.8 (Chung and Hulbert)" + newton;
  return equations + newton;
}

Samples integrate(const MinimalSystem& system, Method method, const Grid& grid) {
  Samples samples;
  Point y{.x = system.start(), .v = Coordinates::Zero(system.n()), .a = {}};
  system.acceleration(y.x, y.v, y.a);
  ImplicitStepper implicit(system, family_of(method), grid.step);
  const long steps = grid.steps();
  const long every = grid.steps_a_sample();
  for (long i = 1; i <= steps; ++i) {
    if (method == Method::runge_kutta_4) {
      runge_kutta_4(system, grid.step, y);
    } else if (!implicit.advance(y)) {
      samples.completed = false;
      break;
    }
    if (i % every != 0) continue;
    samples.completed = y.x.allFinite();
    if (!samples.completed) break;
    samples.x.push_back(y.x);
    samples.v.push_back(y.v);
  }
  return samples;
}

}  // namespace muldi::bench
