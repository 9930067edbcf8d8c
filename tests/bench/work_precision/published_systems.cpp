#include "bench/work_precision/published_systems.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace muldi::bench {
namespace {

using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;
constexpr double eps0 = 8.8542e-12;  // mC/(V mm), the value of the thesis
constexpr double mu = 0.7 / 3.0;     // MPa
constexpr double field = 30e3;       // V/mm

struct RoundBar {
  double diameter = 0.0;
  double length = 0.0;
  double permittivity = 0.0;  // relative
  double viscosity = 0.0;
  double density = muscle_density;
};

UniformMuscle round_muscle(const RoundBar& bar, bool is_charged) {
  const double area = 0.25 * pi * bar.diameter * bar.diameter;
  return {.mu = mu,
          .viscosity = bar.viscosity,
          .permittivity = bar.permittivity * eps0,
          .length = bar.length,
          .area = area,
          .shape = 3.0 / pi,
          .mass = bar.density * area * bar.length,
          .field = is_charged ? field : 0.0};
}

/// The length of an actuator whose centre rests.
class FreeMuscle final : public MinimalSystem {
 public:
  explicit FreeMuscle(UniformMuscle law) : law_(law) {}

  Coordinates start() const override { return Coordinates::Constant(1, law_.length); }
  void acceleration(const Coordinates& x, const Coordinates& v, Coordinates& a) const override {
    a.resize(1);
    a[0] = law_.force(x[0], v[0]) / law_.inertia(x[0]);
  }
  double kinetic(const Coordinates& x, const Coordinates& v) const override {
    return 0.5 * law_.inertia(x[0]) * v[0] * v[0];
  }
  double potential(const Coordinates& x) const override { return law_.potential(x[0]) - law_.potential(law_.length); }

 private:
  UniformMuscle law_;
};

}  // namespace

ChainParts joint_parts(double viscosity, double density) {
  const RoundBar bar{
      .diameter = 11.0, .length = 100.0, .permittivity = 3.1, .viscosity = viscosity, .density = density};
  ChainLink pendulum{.centre = {46.0, 0.0, 0.0}, .mass = 40.0, .inertia = {1.0e5, 3.17e5, 3.17e5}};
  std::vector<ChainMuscle> muscles;
  for (const double side : {1.0, -1.0}) {
    muscles.push_back(
        {.from = {-10.0, 15.0 * side, 0.0}, .to = {90.0, 15.0 * side, 0.0}, .law = round_muscle(bar, side > 0.0)});
  }
  return {.links = {pendulum}, .muscles = std::move(muscles)};
}

ChainParts trunk_parts(double density) {
  const RoundBar bar{.diameter = 8.0, .length = 50.0, .permittivity = 3.7, .viscosity = 100.0, .density = density};
  std::vector<ChainLink> links;
  std::vector<ChainMuscle> muscles;
  for (int i = 0; i < 6; ++i) {
    ChainLink link{.centre = {0.0, 36.958872, 0.0},
                   .next_joint = {0.0, 51.0, 0.0},
                   .mass = 61.0,
                   .inertia = {15036.0, 2524.0, 14940.0}};
    if (i > 0) link.place = Eigen::AngleAxisd(i % 2 == 1 ? 0.5 * pi : -0.5 * pi, Vector3d::UnitY()).toRotationMatrix();
    // Ends are the same in the frame of every joint; the link before sees them turned by its successor's place.
    for (const double side : {-1.0, 1.0}) {
      muscles.push_back({.joint = i,
                         .from = link.place * Vector3d(7.5 * side, -5.0, 0.0),
                         .to = {7.5 * side, 45.0, 0.0},
                         .law = round_muscle(bar, side < 0.0)});
    }
    links.push_back(link);
  }
  return {.links = std::move(links), .muscles = std::move(muscles)};
}

std::unique_ptr<MinimalSystem> system_of(ChainParts parts) {
  return std::make_unique<JointChain>(std::move(parts.links), std::move(parts.muscles));
}

std::unique_ptr<MinimalSystem> lumped_membrane() {
  return std::make_unique<FreeMuscle>(UniformMuscle{.mu = mu,
                                                    .viscosity = 0.01,
                                                    .permittivity = 3.7 * eps0,
                                                    .length = 1.0,
                                                    .area = 400.0,
                                                    .mass = muscle_density * 400.0,
                                                    .field = field});
}

}  // namespace muldi::bench
