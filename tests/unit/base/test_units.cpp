#include "base/units.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace muldi::base {
namespace {

const UnitSystem usual;

double value(std::string_view text, Dimension dimension, const UnitSystem& system = usual) {
  const QuantityResult result = parse_quantity(text, dimension, system);
  EXPECT_EQ(result.error, "");
  return result.value;
}

std::string error(std::string_view text, Dimension dimension) {
  const QuantityResult result = parse_quantity(text, dimension, usual);
  EXPECT_FALSE(result);
  return result.error;
}

UnitSystem system_of(std::string_view length, std::string_view mass, std::string_view time, std::string_view current) {
  std::string fault;
  const UnitSystem system = UnitSystem::make(length, mass, time, current, fault);
  EXPECT_EQ(fault, "");
  return system;
}

TEST(UnitReader, KeepsBareNumbers) {
  EXPECT_EQ(value("1e-3", dimension::length), 1e-3);
  EXPECT_EQ(value(" -4.5 ", dimension::force), -4.5);
}

// The system mm, g, ms, A is coherent: factors from numerics.md section 2.
TEST(UnitReader, ConvertsPowersOfTenExactly) {
  EXPECT_EQ(value("30 kV/mm", dimension::field), 30000.0);
  EXPECT_EQ(value("9.81 m/s^2", dimension::acceleration), 9.81 / 1000);
  EXPECT_EQ(value("10 g/(ms*mm)", dimension::viscosity), 10.0);
  EXPECT_EQ(value("1 g/cm^3", dimension::density), 1e-3);
  EXPECT_EQ(value("0.7 MPa", dimension::stress), 0.7);
  EXPECT_EQ(value("10 um", dimension::length), 0.01);
  EXPECT_EQ(value("1 s", dimension::time), 1000.0);
  EXPECT_EQ(value("3 kg", dimension::mass), 3000.0);
  EXPECT_EQ(value("5 N mm", dimension::torque), 5.0);
  EXPECT_EQ(value("5 N.m", dimension::torque), 5000.0);
  EXPECT_EQ(value("2 N/m", dimension::stiffness), 2e-3);
  EXPECT_EQ(value("1 C", dimension::charge), 1000.0);
  EXPECT_EQ(value("8.8542e-12 F/m", dimension::permittivity), 8.8542e-12);
  EXPECT_EQ(value("100 Hz", dimension::frequency), 0.1);
  EXPECT_EQ(value("5 1/ms", dimension::frequency), 5.0);
  EXPECT_EQ(value("4 mm2", dimension::area), 4.0);
  EXPECT_EQ(value("1 Ohm A", dimension::voltage), 1.0);
}

TEST(UnitReader, NeedsNoSpace) { EXPECT_EQ(value("30kV/mm", dimension::field), 30000.0); }

TEST(UnitReader, TurnsAnglesIntoRadians) {
  const double pi = std::acos(-1.0);
  EXPECT_DOUBLE_EQ(value("7.73 deg", dimension::angle), 7.73 * pi / 180);
  EXPECT_DOUBLE_EQ(value("1 rev", dimension::angle), 2 * pi);
  EXPECT_EQ(value("0.5 rad", dimension::angle), 0.5);
  EXPECT_EQ(value("0.5", dimension::angle), 0.5);
  EXPECT_DOUBLE_EQ(value("60 rpm", dimension::angular_velocity), 2 * pi / 1000);
  EXPECT_DOUBLE_EQ(value("1 N mm/deg", dimension::rotational_stiffness), 180 / pi);
}

TEST(UnitReader, AnglesMayBeLeftOutWhereTheFieldHasThem) {
  EXPECT_EQ(value("3 N mm", dimension::rotational_stiffness), 3.0);
  EXPECT_EQ(value("3 N mm/rad", dimension::rotational_stiffness), 3.0);
  EXPECT_EQ(value("3 1/s", dimension::angular_velocity), 3e-3);
}

TEST(UnitReader, RejectsAnglesElsewhere) {
  EXPECT_EQ(error("3 deg", dimension::none), "needs a number without unit, got '3 deg' (angle)");
  EXPECT_EQ(error("3 N mm/rad", dimension::torque),
            "needs torque or energy (mJ), got '3 N mm/rad' (rotational stiffness)");
}

TEST(UnitReader, RejectsWrongDimension) {
  EXPECT_EQ(error("30 kV", dimension::field), "needs electric field (V/mm), got '30 kV' (voltage)");
  EXPECT_EQ(error("1 kg m3", dimension::mass), "needs mass (g), got '1 kg m3' (kg m^3)");
}

TEST(UnitReader, RejectsHertzForAngularVelocity) {
  EXPECT_EQ(error("50 Hz", dimension::angular_velocity),
            "needs angular velocity (rad/ms), got '50 Hz': write rev/s or rad/s");
}

TEST(UnitReader, RejectsUnknownUnits) {
  EXPECT_EQ(error("3 parsnips", dimension::length), "unknown unit 'parsnips' in '3 parsnips'");
  EXPECT_EQ(error("3 mm mm^", dimension::length), "unknown unit 'mm mm^' in '3 mm mm^'");
  EXPECT_EQ(error("3 2 mm", dimension::length), "unknown unit '2 mm' in '3 2 mm'");
  EXPECT_EQ(error("3 s since 2000", dimension::time), "unknown unit 's since 2000' in '3 s since 2000'");
  EXPECT_EQ(error("3 lg(re 1 mm)", dimension::length), "unknown unit 'lg(re 1 mm)' in '3 lg(re 1 mm)'");
  EXPECT_EQ(error("3 m @ 4", dimension::length), "unknown unit 'm @ 4' in '3 m @ 4'");
}

TEST(UnitReader, RejectsWhatIsNoFiniteNumber) {
  EXPECT_EQ(error("nan", dimension::length), "needs a finite number, got 'nan'");
  EXPECT_EQ(error("1e999", dimension::length), "needs a finite number, got '1e999'");
  EXPECT_EQ(error("inf mm", dimension::length), "needs a finite number, got 'inf mm'");
  EXPECT_EQ(error("1e308 km", dimension::length), "is too large: '1e308 km'");
  EXPECT_EQ(error("mm", dimension::length), "needs a number, got 'mm'");
  EXPECT_EQ(error("", dimension::length), "needs a number, got ''");
}

TEST(UnitSystem, ConvertsToItsOwnUnits) {
  const UnitSystem si = system_of("m", "kg", "s", "A");
  EXPECT_EQ(value("30 kV/mm", dimension::field, si), 3e7);
  EXPECT_EQ(value("10 g/(ms*mm)", dimension::viscosity, si), 1e4);
  EXPECT_EQ(si.si(dimension::stress), 1.0);
  EXPECT_DOUBLE_EQ(usual.si(dimension::stress), 1e6);
}

TEST(UnitSystem, GivesThePermittivityOfVacuumOfTheThesis) {
  EXPECT_EQ(usual.eps0(), 8.8542e-12);  // mF/mm, the same number
  EXPECT_EQ(system_of("m", "kg", "s", "A").eps0(), 8.8542e-12);
  EXPECT_DOUBLE_EQ(system_of("mm", "g", "ms", "mA").eps0(), 8.8542e-6);
}

TEST(UnitSystem, NamesUnitsOfResults) {
  EXPECT_EQ(usual.unit_name(dimension::none), "1");
  EXPECT_EQ(usual.unit_name(dimension::length), "mm");
  EXPECT_EQ(usual.unit_name(dimension::velocity), "mm/ms");
  EXPECT_EQ(usual.unit_name(dimension::force), "N");
  EXPECT_EQ(usual.unit_name(dimension::stress), "MPa");
  EXPECT_EQ(usual.unit_name(dimension::energy), "mJ");
  EXPECT_EQ(usual.unit_name(dimension::power), "W");
  EXPECT_EQ(usual.unit_name(dimension::voltage), "V");
  EXPECT_EQ(usual.unit_name(dimension::field), "V/mm");
  EXPECT_EQ(usual.unit_name(dimension::charge), "mC");
  EXPECT_EQ(usual.unit_name(dimension::viscosity), "MPa ms");
  EXPECT_EQ(usual.unit_name(dimension::momentum), "g mm/ms");
  EXPECT_EQ(usual.unit_name(dimension::angular_velocity), "rad/ms");
  EXPECT_EQ(usual.unit_name(dimension::rotational_stiffness), "N mm/rad");
  EXPECT_EQ(usual.unit_name(dimension::permittivity), "mF/mm");
  EXPECT_EQ(usual.unit_name(dimension::density), "g/mm^3");
  const UnitSystem si = system_of("m", "kg", "s", "A");
  EXPECT_EQ(si.unit_name(dimension::energy), "J");
  EXPECT_EQ(si.unit_name(dimension::momentum), "kg m/s");
  // No prefix makes a centimetre system's force: 1 g cm/s^2 is 10 uN.
  EXPECT_EQ(system_of("cm", "g", "s", "A").unit_name(dimension::force), "g cm/s^2");
}

TEST(UnitSystem, RefusesUnitsOfOtherQuantities) {
  std::string fault;
  EXPECT_EQ(UnitSystem::make("kg", "g", "ms", "A", fault), UnitSystem());
  EXPECT_EQ(fault, "'kg' is no unit of length");
  UnitSystem::make("mm", "g", "parsec", "A", fault);
  EXPECT_EQ(fault, "'parsec' is no unit of time");
}

TEST(UnitSystem, UnitNamesAreReadBack) {
  for (const Dimension dimension :
       {dimension::force, dimension::stress, dimension::viscosity, dimension::field, dimension::permittivity,
        dimension::inertia, dimension::angular_velocity, dimension::rotational_damping, dimension::momentum}) {
    const std::string name = usual.unit_name(dimension);
    EXPECT_EQ(value("1 " + name, dimension), 1.0) << name;
  }
}

}  // namespace
}  // namespace muldi::base
