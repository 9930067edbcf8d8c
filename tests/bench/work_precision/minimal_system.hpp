#pragma once
/// Equations of motion in minimal coordinates, written by hand for the rivals: they share no code with lib/.
#include <Eigen/Core>
#include <vector>

namespace muldi::bench {

/// Coordinates of the largest system.
inline constexpr int most_coordinates = 6;
using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_coordinates, 1>;

/// x'' = a(x, x').
class MinimalSystem {
 public:
  virtual ~MinimalSystem() = default;
  /// The pose at t = 0; systems start at rest.
  virtual Coordinates start() const = 0;
  virtual void acceleration(const Coordinates& x, const Coordinates& v, Coordinates& a) const = 0;
  /// Kinetic energy, and the potential energy of an undamped system less that at the start.
  virtual double kinetic(const Coordinates& x, const Coordinates& v) const = 0;
  virtual double potential(const Coordinates& x) const = 0;

  int n() const { return static_cast<int>(start().size()); }
};

/// A uniform, incompressible, dielectric muscle of length z under a held nominal field (thesis 7.2), with the inertia
/// of thesis (7.47): b z'^2 / z^3 + c z'^2 of the axial motion.
struct UniformMuscle {
  double mu = 0.0;            ///< shear modulus, MPa
  double viscosity = 0.0;     ///< MPa ms
  double permittivity = 0.0;  ///< mC/(V mm)
  double length = 0.0;        ///< reference, mm
  double area = 0.0;          ///< reference, mm^2
  double shape = 1.0;         ///< second moment of the section over that of a square of the same area
  double mass = 0.0;          ///< g
  double field = 0.0;         ///< V/mm

  double b() const { return shape * mass * area * length / 48.0; }
  double c() const { return mass / 24.0; }
  /// dPi/dz.
  double potential_slope(double z) const {
    const double stretch = z / length;
    return area *
           (mu * (stretch - 1.0 / (stretch * stretch)) + permittivity * field * field / (stretch * stretch * stretch));
  }
  double potential(double z) const {
    const double stretch = z / length;
    return area * length *
           (0.5 * mu * (stretch * stretch + 2.0 / stretch - 3.0) -
            0.5 * permittivity * field * field / (stretch * stretch));
  }
  /// Factor of z'' in its equation of motion.
  double inertia(double z) const { return 2.0 * (b() / (z * z * z) + c()); }
  /// Force on the length at z'' = 0.
  double force(double z, double zd) const {
    return 3.0 * b() * zd * zd / (z * z * z * z) - potential_slope(z) - 1.5 * viscosity * area * length * zd / (z * z);
  }
};

}  // namespace muldi::bench
