#pragma once
/// Reading of result files: finished, interrupted, or still being written.
#include <map>
#include <optional>

#include "results/checkpoint_store.hpp"
#include "results/hdf5_file.hpp"

namespace muldi::results {

/// A data set with its values, row-major.
struct Array {
  ValueType type = ValueType::float64;
  Shape shape = {};
  bool grows = false;               ///< made of rows, counted by the first extent
  std::string unit = {};            ///< empty if there is none
  std::vector<double> values = {};  ///< integers beyond 2^53 are rounded
};

/// An open result file. All members throw InputError if the file turns out to be damaged.
class ResultFile {
 public:
  /// Throws InputError if the file is missing, not an HDF5 file, or truncated.
  explicit ResultFile(const std::string& path);

  const std::string& path() const { return path_; }
  /// Bytes on disk.
  std::uint64_t bytes() const { return bytes_; }
  /// Paths of all data sets of numbers, without leading slash, sorted.
  const std::vector<std::string>& data_sets() const { return data_sets_; }
  bool contains(const std::string& path) const;
  /// Paths of the axes with their numbers of complete rows at the moment of opening.
  const std::map<std::string, std::size_t>& axes() const { return axes_; }
  /// The axis that numbers the rows of a data set; nothing if it is not made of rows or has no axis.
  std::optional<std::string> axis_of(const std::string& path) const;

  /// A data set; of one made of rows the complete ones.
  Array read(const std::string& path) const;
  /// The last complete row; `values` is empty and the first extent 0 if there is none yet.
  Array last_row(const std::string& path) const;

  /// An attribute of `object` (empty: the file).
  std::optional<AttributeValue> attribute(const std::string& object, const std::string& name) const;
  std::vector<Attribute> attributes(const std::string& object) const { return file_.attributes(object); }
  /// A text attribute of the file, empty if there is none.
  std::string text(const std::string& name) const;
  /// The last checkpoint; nothing if the file has none.
  std::optional<StoredCheckpoint> checkpoint() const;

 private:
  Array describe(const hdf5::DataSet& set) const;
  std::optional<std::string> nearest_axis(const std::string& path) const;

  std::string path_;
  std::uint64_t bytes_ = 0;
  hdf5::File file_;
  std::vector<std::string> data_sets_;
  std::map<std::string, std::size_t> axes_;
};

}  // namespace muldi::results
