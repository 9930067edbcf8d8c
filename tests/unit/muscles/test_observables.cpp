/// Recorded quantities of muscles and springs.
#include "muscles/element_observables.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "muscles/lumped_dea.hpp"
#include "muscles/spring.hpp"

namespace muldi::muscles {
namespace {

LumpedDea muscle() {
  return {.shear_modulus = 0.2,
          .viscosity = 0.5,
          .density = 1e-3,
          .length = 2.0,
          .area = 3.0,
          .electric_law = ElectricLaw::ideal(3.7, 8.8542e-12)};
}

/// Paths and values at a particle (3, 4, 0)/2 that flies along x, with 100 V on the control.
std::map<std::string, double> values(const std::vector<model::Observable>& list, const Eigen::VectorXd& q,
                                     const Eigen::VectorXd& v, const std::vector<double>& accounts = {}) {
  const Eigen::VectorXd none;
  const std::array<double, 1> u{100.0};
  const model::NodeView at{.x = none,
                           .rate = none,
                           .q = q,
                           .v = v,
                           .constraint_force = none,
                           .multipliers = none,
                           .y = none,
                           .u = u,
                           .accounts = accounts};
  std::map<std::string, double> result;
  for (const model::Observable& observable : list) {
    EXPECT_EQ(observable.size(), 1u);
    double value = 0.0;
    observable.evaluate(at, {&value, 1});
    result[observable.path] = value;
  }
  return result;
}

model::LinearPoint particle() {
  model::LinearPoint point;
  point.add(0, 0, 1.0);
  return point;
}
const model::LinearPoint origin = model::LinearPoint::constant(Eigen::Vector3d::Zero());
const Eigen::VectorXd position{{1.5, 2.0, 0.0}};
const Eigen::VectorXd velocity{{0.5, 0.0, 0.0}};

TEST(MuscleObservables, AreThoseOfTheResultFormat) {
  TwoPointComponent<LumpedDea> component{"upper", muscle(), particle(), origin};
  component.controls[0] = {.control = 0, .factor = field_per_layer_voltage(0.01)};
  component.element.layer_thickness = 0.01;
  const auto at = values(observables_of(component), position, velocity);
  ASSERT_EQ(at.size(), 7u);
  EXPECT_DOUBLE_EQ(at.at("muscles/upper/length"), 2.5);
  EXPECT_DOUBLE_EQ(at.at("muscles/upper/stretch"), 1.25);
  EXPECT_DOUBLE_EQ(at.at("muscles/upper/force"), muscle().pull(2.5, 0.3, 1e4));
  EXPECT_DOUBLE_EQ(at.at("muscles/upper/field"), 1e4);
  EXPECT_DOUBLE_EQ(at.at("muscles/upper/true_field"), 8e3);
  EXPECT_DOUBLE_EQ(at.at("muscles/upper/layer_voltage"), 100.0);
  EXPECT_DOUBLE_EQ(at.at("muscles/upper/charge"), 3.7 * 8.8542e-12 * 3.0 * 1e4 / (1.25 * 1.25));  // eps A E / L^2
}

TEST(MuscleObservables, LackVoltageAndChargeWithoutALayerThickness) {
  const FreeActuator<LumpedDea> actuator{"free", muscle(), 0, 0, {ControlInput{.constant = 1e4}}};
  const auto at = values(observables_of(actuator), Eigen::VectorXd{{1.5}}, Eigen::VectorXd{{-0.1}});
  ASSERT_EQ(at.size(), 5u);
  EXPECT_DOUBLE_EQ(at.at("muscles/free/length"), 1.5);
  EXPECT_DOUBLE_EQ(at.at("muscles/free/stretch"), 0.75);
  EXPECT_DOUBLE_EQ(at.at("muscles/free/force"), muscle().pull(1.5, -0.1, 1e4));
}

TEST(MuscleObservables, OfItsSourceAreThoseOfACapacitorOfAllLayers) {
  TwoPointComponent<LumpedDea> component{"upper", muscle(), particle(), origin};
  component.controls[0] = {.control = 0, .factor = field_per_layer_voltage(0.01)};
  component.element.layer_thickness = 0.01;
  model::Model model;
  add_electric(component, {.capacitance = true, .stored_energy = true, .supplied_energy = true}, model);
  const double account = 1e-3;  // of what was supplied before the charge of now
  const auto at = values(model.observables, position, velocity, {account});
  ASSERT_EQ(at.size(), 3u);
  // eps A / (L^2 t) of a layer, and 200 layers of 100 V.
  const double capacitance = 3.7 * 8.8542e-12 * 3.0 / (1.25 * 1.25 * 0.01);
  EXPECT_DOUBLE_EQ(at.at("muscles/upper/capacitance"), capacitance);
  EXPECT_DOUBLE_EQ(at.at("muscles/upper/stored_energy"), 0.5 * 200 * capacitance * 1e4);
  EXPECT_DOUBLE_EQ(at.at("muscles/upper/supplied_energy"), account + 200 * capacitance * 1e4);
  EXPECT_TRUE(model.books_supply);
}

TEST(MuscleObservables, OfItsSourceAreOnlyThoseThatAreWanted) {
  const FreeActuator<LumpedDea> actuator{"free", muscle(), 0, 0, {ControlInput{.constant = 1e4}}};
  model::Model model;
  add_electric(actuator, {.capacitance = true, .stored_energy = true}, model);
  const auto at = values(model.observables, Eigen::VectorXd{{1.5}}, Eigen::VectorXd{{-0.1}});
  ASSERT_EQ(at.size(), 1u);  // without a layer thickness no layer has a capacitance
  EXPECT_DOUBLE_EQ(at.at("muscles/free/stored_energy"), -muscle().electric(1.5, Controls<double, 1>{1e4}));
  EXPECT_FALSE(model.books_supply);
}

TEST(SpringObservables, AreLengthAndPull) {
  const TwoPointComponent<Spring> spring{"s1", Spring{.stiffness = 2.0, .rest_length = 2.0, .damping = 0.1}, particle(),
                                         origin};
  const auto at = values(observables_of(spring), position, velocity);
  ASSERT_EQ(at.size(), 2u);
  EXPECT_DOUBLE_EQ(at.at("springs/s1/length"), 2.5);
  EXPECT_DOUBLE_EQ(at.at("springs/s1/force"), 2.0 * 0.5 + 0.1 * 0.3);
}

}  // namespace
}  // namespace muldi::muscles
