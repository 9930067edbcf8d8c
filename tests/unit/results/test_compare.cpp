#include "results/compare.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "recording.hpp"

namespace muldi::results {
namespace {

using testing::HasSubstr;
using Rows = std::vector<std::array<double, 2>>;

const Rows plain{{1.0, 2.0}, {3.0, 4.0}, {5.0, -8.0}};

/// What may differ between the two files of a test.
struct Variant {
  Rows rows = plain;
  std::string unit = "mm";
  std::string status = "completed";
  std::string created = "today";
  double iterations = 3;
  std::string extra_channel = {};
  std::vector<Attribute> attributes = {};
};

void write(const std::string& path, const Variant& variant) {
  Hdf5Recorder recorder({.path = path});
  const Series run = recorder.declare_series({.axis = "time", .unit = "ms"});
  const Channel position = recorder.declare_channel(run, {.path = "bodies/a/x", .shape = {2}, .unit = variant.unit});
  const Channel iterations = recorder.declare_channel(run, {.path = "solver/iterations"});
  std::optional<Channel> extra;
  if (!variant.extra_channel.empty()) extra = recorder.declare_channel(run, {.path = variant.extra_channel});
  recorder.set_attribute("", "created", variant.created);
  for (const Attribute& attribute : variant.attributes) {
    recorder.set_attribute(attribute.object, attribute.name, attribute.value);
  }
  recorder.declare_checkpoint({.reals = {{"q", {variant.iterations}}}, .integers = {}});
  recorder.start();
  for (std::size_t i = 0; i < variant.rows.size(); ++i) {
    recorder.append(run.axis, 0.25 * static_cast<double>(i));
    recorder.append(position, variant.rows[i]);
    recorder.append(iterations, variant.iterations);
    if (extra) recorder.append(*extra, 0.0);
  }
  recorder.close({.status = variant.status});
}

Comparison compare_variants(const Variant& first, const Variant& second, const CompareOptions& options = {}) {
  const Scratch scratch;
  write(scratch / "a.h5", first);
  write(scratch / "b.h5", second);
  Comparison result = compare(scratch / "a.h5", scratch / "b.h5", options);
  result.first_file = "a.h5";
  result.second_file = "b.h5";
  return result;
}

TEST(Compare, FindsNothingBetweenEqualFiles) {
  const Comparison result = compare_variants({}, {});
  EXPECT_TRUE(result.same());
  EXPECT_EQ(to_text(result), "'a.h5' and 'b.h5' agree: 2 data sets, 9 values\n");
}

TEST(Compare, LeavesOutRunMetadataSolverAndCheckpoint) {
  EXPECT_TRUE(compare_variants({}, {.created = "tomorrow", .iterations = 9}).same());
  const Comparison asked = compare_variants({}, {.iterations = 9}, {.only = {"solver"}});
  ASSERT_EQ(asked.differences.size(), 1U);
  EXPECT_EQ(asked.differences[0].path, "/solver/iterations");
}

TEST(Compare, NamesIndexTimeAndValuesOfTheWorstDifference) {
  Rows changed = plain;
  changed[1][1] += 1e-6;
  changed[2][0] -= 1e-3;
  const Comparison result = compare_variants({}, {.rows = changed}, {.rtol = 1e-6, .atol = 0.0});
  ASSERT_EQ(result.differences.size(), 1U);
  const Difference& worst = result.differences[0];
  EXPECT_EQ(worst.kind, Difference::Kind::value);
  EXPECT_EQ(worst.index, (std::vector<std::size_t>{2, 0}));
  EXPECT_EQ(worst.time, 0.5);
  EXPECT_EQ(worst.left, 5.0);
  EXPECT_EQ(worst.right, 4.999);
  EXPECT_EQ(worst.count, 1U) << "1e-6 lies within the tolerance of 8e-6";
  // |a-b| / (rtol max|a|) = 1e-3 / (1e-6 * 8)
  EXPECT_NEAR(worst.excess, 125.0, 1e-6);
  EXPECT_EQ(to_text(result),
            "'a.h5' and 'b.h5' differ: 1 in 2 data sets, the worst first\n"
            "data set     index   time  first  second  |a-b|/tolerance\n"
            "/bodies/a/x  [2, 0]  0.5   5      4.999   125\n");
}

TEST(Compare, AddsAbsoluteAndRelativeTolerance) {
  Rows changed = plain;
  changed[0][0] += 0.0799;  // max|a| = 8
  EXPECT_TRUE(compare_variants({}, {.rows = changed}, {.rtol = 1e-2, .atol = 0.0}).same());
  EXPECT_TRUE(compare_variants({}, {.rows = changed}, {.rtol = 0.0, .atol = 0.08}).same());
  EXPECT_TRUE(compare_variants({}, {.rows = changed}, {.rtol = 5e-3, .atol = 0.04}).same());
  EXPECT_FALSE(compare_variants({}, {.rows = changed}, {.rtol = 5e-3, .atol = 0.03}).same());
}

TEST(Compare, TakesTolerancesFromTheFirstFile) {
  Rows changed = plain;
  changed[0][0] += 0.5;
  const Variant golden{.attributes = {{"bodies/a/x", "atol", 1.0}}};
  EXPECT_TRUE(compare_variants(golden, {.rows = changed}).same());
  EXPECT_FALSE(compare_variants({.rows = changed}, golden).same());
}

TEST(Compare, AgreesOnNaNOnlyInTheSamePlace) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const auto with = [](double value) {
    Rows rows = plain;
    rows[1][0] = value;
    return Variant{.rows = rows};
  };
  EXPECT_TRUE(compare_variants(with(nan), with(nan)).same());
  EXPECT_TRUE(compare_variants(with(infinity), with(infinity)).same());
  EXPECT_FALSE(compare_variants(with(nan), {}, {.rtol = 1e9}).same());
  EXPECT_FALSE(compare_variants({}, with(nan), {.rtol = 1e9}).same());
  EXPECT_FALSE(compare_variants({}, with(infinity), {.rtol = 1e9}).same());
  EXPECT_FALSE(compare_variants(with(-infinity), with(infinity), {.rtol = 1e9}).same());
}

TEST(Compare, ReportsWhatCannotBeComparedByValue) {
  Rows shorter = plain;
  shorter.pop_back();
  const Comparison result =
      compare_variants({.extra_channel = "muscles/m/force"}, {.rows = shorter, .unit = "m", .status = "interrupted"});
  EXPECT_EQ(to_text(result),
            "'a.h5' and 'b.h5' differ: 5 in 3 data sets, the worst first\n"
            "data set          index     time  first      second       |a-b|/tolerance\n"
            "/status           status          completed  interrupted\n"
            "/bodies/a/x       unit            mm         m\n"
            "/bodies/a/x       shape           [3, 2]     [2, 2]\n"
            "/muscles/m/force  data set        present    -\n"
            "/time             shape           [3]        [2]\n");
}

TEST(Compare, SelectsByPattern) {
  const Variant other{.rows = {{9.0, 9.0}, {9.0, 9.0}, {9.0, 9.0}}, .extra_channel = "bodies/b/x"};
  const auto paths = [&](const CompareOptions& options) {
    std::vector<std::string> found;
    for (const Difference& difference : compare_variants({}, other, options).differences)
      found.push_back(difference.path);
    return found;
  };
  EXPECT_THAT(paths({}), testing::ElementsAre("/bodies/b/x", "/bodies/a/x"));
  EXPECT_THAT(paths({.ignore = {"bodies/b"}}), testing::ElementsAre("/bodies/a/x"));
  EXPECT_THAT(paths({.only = {"/bodies/?/x"}, .ignore = {"*b*x"}}), testing::ElementsAre());
  EXPECT_THAT(paths({.only = {"/bodies/b/*"}}), testing::ElementsAre("/bodies/b/x"));
  EXPECT_THAT(paths({.ignore = {"*/x"}}), testing::ElementsAre());
}

TEST(Compare, CutsALongTable) {
  Rows changed = plain;
  changed[0][0] = 2.0;
  const Comparison result = compare_variants({.extra_channel = "zero"}, {.rows = changed});
  EXPECT_THAT(to_text(result, 1), HasSubstr("and 1 more\n"));
}

TEST(Compare, RefusesUnreadableFiles) {
  EXPECT_EQ(message_of<base::InputError>([] { compare("/nowhere/a.h5", "/nowhere/b.h5"); }),
            "error: cannot read '/nowhere/a.h5': No such file or directory");
}

}  // namespace
}  // namespace muldi::results
