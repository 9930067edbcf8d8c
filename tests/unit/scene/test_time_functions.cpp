#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "reading.hpp"

namespace muldi::scene {
namespace {

base::TimeFunction field(const std::string& function) {
  return scene_of("controls: {c: {field: " + function + "}}\n").controls[0].value.value;
}

std::string field_errors(const std::string& function) {
  return errors_of("controls: {c: {field: " + function + "}}\n");
}

TEST(TimeFunctions, NumbersAreConstant) {
  EXPECT_EQ(field("30 kV/mm"), base::TimeFunction(30000.0));
  EXPECT_EQ(field("0"), base::TimeFunction(0.0));
}

TEST(TimeFunctions, StepsAndTablesTakeUnits) {
  const base::TimeFunction steps = field("{steps: [[0, 1 kV/mm], [1 s, 2 kV/mm]]}");
  EXPECT_EQ(steps.at(999.0), 1000.0);
  EXPECT_EQ(steps.at(1000.0), 2000.0);
  EXPECT_EQ(field("{table: [[0, 0], [2, 10]]}").at(1.0), 5.0);
}

TEST(TimeFunctions, TablesMayStartLate) { EXPECT_EQ(field("{table: [[5, 3], [6, 4]]}").at(0.0), 3.0); }

TEST(TimeFunctions, RampsStartAtZeroUnlessSaid) {
  const base::TimeFunction ramp = field("{ramp: {to: 4 kV/mm, over: 20 ms}}");
  EXPECT_EQ(ramp.at(0.0), 0.0);
  EXPECT_EQ(ramp.at(10.0), 2000.0);
  EXPECT_EQ(field("{ramp: {from: 1, to: 3, start: 10, over: 2}}").at(11.0), 2.0);
}

TEST(TimeFunctions, SinesTakeHertzAndDegrees) {
  const base::TimeFunction sine = field("{sine: {amplitude: 2, frequency: 250 Hz, phase: 90 deg, offset: 1}}");
  EXPECT_DOUBLE_EQ(sine.at(0.0), 3.0);
  EXPECT_DOUBLE_EQ(sine.at(2.0), -1.0);  // half a period of 4 ms
}

TEST(TimeFunctions, ExpressionsTakeAUnit) {
  EXPECT_DOUBLE_EQ(field("{expression: \"30*(1-exp(-t/20))\", unit: kV/mm}").at(20.0), 30000.0 * (1 - std::exp(-1.0)));
  EXPECT_EQ(field("{expression: 2*t}").at(3.0), 6.0);
}

TEST(TimeFunctions, TimeIsInTheScenesUnit) {
  const Scene scene = scene_of(
      "units: {length: m, mass: kg, time: s, current: A}\n"
      "controls: {c: {force: {table: [[0, 0], [500 ms, 1 N]]}}, e: {force: {expression: t, unit: kN}}}\n");
  EXPECT_EQ(scene.controls[0].value.value.at(0.25), 0.5);
  EXPECT_EQ(scene.controls[1].value.value.at(0.25), 250.0);
}

TEST(TimeFunctions, UnknownKeysOfFormsAreErrors) {
  EXPECT_EQ(field_errors("{expression: t, units: kV/mm}"),
            "test.yaml:2:39: error: controls.c.field.units: unknown key (did you mean 'unit'?)");
  EXPECT_EQ(field_errors("{ramp: {to: 1, over: 1, form: 2}}"),
            "test.yaml:2:47: error: controls.c.field.ramp.form: unknown key (did you mean 'from'?)");
  EXPECT_EQ(field_errors("{steps: [[0, 1]], table: [[0, 1]]}"),
            "test.yaml:2:23: error: controls.c.field: needs one function of time: {steps: [[t, v], ...]}, {table: [[t, "
            "v], ...]}, {ramp}, {sine}, {expression} or {file}");
}

/// A folder with a scene and a CSV file that is gone at the end.
class CsvFolder : public testing::Test {
 protected:
  CsvFolder() { std::filesystem::create_directories(folder_ / "tables"); }
  ~CsvFolder() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  base::TimeFunction read(const std::string& csv, const std::string& options) {
    std::ofstream(folder_ / "tables" / "u.csv") << csv;
    std::ofstream(folder_ / "scene.yaml")
        << "muldi: 1\ncontrols: {c: {layer_voltage: {file: tables/u.csv, " + options + "}}}\n";
    return read_scene((folder_ / "scene.yaml").string()).controls[0].value.value;
  }

 private:
  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("muldi_csv_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(CsvFolder, HeldAndLinearColumns) {
  const base::TimeFunction held = read("time,a,b\n0,1,5\n10,2,6\n", "column: 3, unit: kV, interpolation: steps");
  EXPECT_EQ(held.at(9.0), 5000.0);
  EXPECT_EQ(held.at(10.0), 6000.0);
  EXPECT_EQ(read("0,1\n10,2\n", "interpolation: linear").at(5.0), 1.5);
}

TEST_F(CsvFolder, TakesCommentsBlankLinesAndOtherSeparators) {
  EXPECT_EQ(read("# recorded\n\n0; 1\n 10 ;3\r\n", "interpolation: linear").at(5.0), 2.0);
  EXPECT_EQ(read("0\t1\n10\t3", "interpolation: linear").at(5.0), 2.0);
  EXPECT_EQ(read("0 1\n10   3\n", "interpolation: linear").at(5.0), 2.0);
}

TEST_F(CsvFolder, OnlyOneLineOfHeadings) {
  EXPECT_THROW(read("time,u\nms,V\n0,1\n", "interpolation: linear"), base::InputError);
  EXPECT_THROW(read("", "interpolation: linear"), base::InputError);
}

}  // namespace
}  // namespace muldi::scene
