#pragma once
/// Example systems of the thesis and of numerics 3.7, with the numbers they come with. Units mm, g, ms, A.
#include "support/rigid_system.hpp"

namespace muldi::test {

inline constexpr double eps0 = 8.8542e-12;        ///< the thesis's value, F/m = N/V^2
inline constexpr double earth_gravity = 9.81e-3;  ///< mm/ms^2
inline constexpr double degree = 0.017453292519943295;

/// Thesis Table 5.1: 40 g, 3.17e5 g mm^2 about the centre of mass, 46 mm from a revolute joint along z at the origin.
/// Joint coordinate 0 is horizontal (+x), gravity is -y; so an angle from the bottom of `a` is the coordinate a - pi/2.
RigidSystem pendulum(double gravity = earth_gravity);
/// A second body of the same kind hangs on the tip (92 mm) of the first.
RigidSystem double_pendulum(double gravity = earth_gravity);
/// n bodies of the pendulum in a row, alternating joint axes z and y.
RigidSystem revolute_chain(int n, double gravity = earth_gravity);

/// Thesis 7.2.5, 8.3: the pendulum body without gravity between two muscles (-10, +-15) -> (90, +-15), field control 0
/// on the upper one, control 1 on the lower; eps_r 3.1, d 11, eta 10.
RigidSystem muscle_joint(double upper_field, double lower_field = 0.0);
/// Thesis 8.3.2, Table 8.1: six bodies, twelve muscles; the fields of the muscles are controls 0 .. 11 (V/mm).
RigidSystem trunk(const std::vector<double>& fields);
/// Fields with E on the odd muscles (1, 3, ...) and 0 on the others.
std::vector<double> odd_fields(double field);
/// The connector rho_6 of the last body: the tip.
End trunk_tip();

/// Numerics 3.7: a symmetric top of 1 g on a ball joint at the origin, 50 mm to its centre of mass along its axis,
/// moments 4000 about the tip across and 800 along the axis; gravity -z; tilted from +z by `tilt` (rad) towards +x.
RigidSystem heavy_top(double tilt);

/// Numerics 3.8: free actuators under a constant field; one unknown, no bodies.
RigidSystem membrane(double field, double viscosity);
RigidSystem round_actuator(double field, double viscosity);

}  // namespace muldi::test
