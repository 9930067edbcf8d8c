#pragma once
/// What a result file holds, declared before the first row: series of rows, fixed arrays, attributes, the checkpoint.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/error.hpp"

namespace muldi::results {

enum class ValueType { float64, int64 };

/// Shape of one row or of a fixed array; {} is a scalar.
using Shape = std::vector<std::size_t>;

/// Number of values in an array of this shape.
constexpr std::size_t count(const Shape& shape) {
  std::size_t product = 1;
  for (const std::size_t extent : shape) product *= extent;
  return product;
}

/// A series is a set of channels whose rows advance together, beside the axis that numbers them.
/// A channel belongs to the nearest enclosing folder with an axis: `time` rules `/`, `statics/load` rules `/statics`.
struct SeriesSpec {
  std::string axis = "time";      ///< path of the axis data set, without a leading slash
  std::string unit = {};          ///< unit of the axis
  std::string doc = {};           ///< one sentence
  std::size_t expected_rows = 0;  ///< a hint for the size of chunks, 0 if unknown; more or fewer rows are fine
};

/// One quantity recorded row by row.
struct ChannelSpec {
  std::string path = {};  ///< path of the data set, without a leading slash, e.g. `bodies/pendulum/position`
  Shape shape = {};       ///< shape of a row: {}, {3}, {3, 3}, {k}; no extent is 0
  std::string unit = {};
  std::string doc = {};
  ValueType type = ValueType::float64;
};

/// A data set known before the start, e.g. the reference positions of a mesh.
struct FixedSpec {
  std::string path = {};  ///< path of the data set, without a leading slash
  Shape shape = {};
  std::string unit = {};
  std::string doc = {};
};

/// Text is UTF-8.
using AttributeValue = std::variant<double, std::int64_t, std::string>;

/// An attribute of the file (object empty), of a group or of a data set.
struct Attribute {
  std::string object = {};
  std::string name = {};
  AttributeValue value = {};

  friend bool operator==(const Attribute&, const Attribute&) = default;
};

/// A named vector of a checkpoint.
template <class Value>
struct CheckpointVector {
  std::string name = {};
  std::vector<Value> values = {};

  friend bool operator==(const CheckpointVector&, const CheckpointVector&) = default;
};

/// Everything needed to go on bit for bit; names and sizes are fixed by the first one.
struct Checkpoint {
  std::vector<CheckpointVector<double>> reals = {};
  std::vector<CheckpointVector<std::int64_t>> integers = {};

  friend bool operator==(const Checkpoint&, const Checkpoint&) = default;
  /// The vector of this name; throws ContractError if there is none.
  const std::vector<double>& real(std::string_view name) const { return find(reals, name); }
  const std::vector<std::int64_t>& integer(std::string_view name) const { return find(integers, name); }

 private:
  template <class Value>
  static const std::vector<Value>& find(const std::vector<CheckpointVector<Value>>& list, std::string_view name) {
    const auto found = std::ranges::find(list, name, &CheckpointVector<Value>::name);
    MULDI_EXPECT(found != list.end(), "the checkpoint has this vector");
    return found->values;
  }
};

/// A declared fixed array with its values; `reals` or `integers` is filled, as `type` says.
struct FixedArray {
  FixedSpec spec = {};
  ValueType type = ValueType::float64;
  std::vector<double> reals = {};
  std::vector<std::int64_t> integers = {};

  const void* values() const {
    return type == ValueType::float64 ? static_cast<const void*>(reals.data()) : integers.data();
  }
};

/// A channel and the index of its series; the axis is the first channel of its series.
struct DeclaredChannel {
  ChannelSpec spec = {};
  std::size_t series = 0;
  bool axis = false;
};

/// All that was declared.
struct Layout {
  std::vector<SeriesSpec> series = {};
  std::vector<DeclaredChannel> channels = {};
  std::vector<FixedArray> fixed = {};
  std::vector<Attribute> attributes = {};
  Checkpoint checkpoint = {};  ///< the first one: names, sizes, values
};

}  // namespace muldi::results
