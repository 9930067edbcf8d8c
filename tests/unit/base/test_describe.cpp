#include "base/describe.hpp"

#include <gtest/gtest.h>

namespace muldi::base {
namespace {

TEST(Dimension, DerivedDimensionsFollowFromTheBases) {
  EXPECT_EQ(dimension::energy, (Dimension{.length = 2, .mass = 1, .time = -2}));
  EXPECT_EQ(dimension::voltage, (Dimension{.length = 2, .mass = 1, .time = -3, .current = -1}));
  EXPECT_EQ(dimension::permittivity, (Dimension{.length = -3, .mass = -1, .time = 4, .current = 2}));
  EXPECT_EQ(dimension::permittivity * dimension::field * dimension::field, dimension::stress);
}

TEST(Dimension, AngleIsABaseOfItsOwn) {
  EXPECT_NE(dimension::angle, dimension::none);
  EXPECT_EQ(dimension::rotational_stiffness * dimension::angle, dimension::torque);
}

TEST(RangeText, NamesTheEndsThatExist) {
  EXPECT_EQ(range_text(any), "");
  EXPECT_EQ(range_text(positive), "> 0");
  EXPECT_EQ(range_text(non_negative), ">= 0");
  EXPECT_EQ(range_text({.max = 0.5, .max_open = true}), "< 0.5");
  EXPECT_EQ(range_text({.min = -1.0, .max = 0.5, .min_open = true}), "> -1 and <= 0.5");
  EXPECT_EQ(range_text({.min = 1.0, .max = 1.0}), "1");
}

}  // namespace
}  // namespace muldi::base
