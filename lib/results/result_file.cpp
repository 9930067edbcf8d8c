#include "results/result_file.hpp"

#include <algorithm>
#include <filesystem>

namespace muldi::results {
namespace {

/// The folder of a path with its trailing slash.
std::string folder(const std::string& path) { return path.substr(0, path.rfind('/') + 1); }

}  // namespace

ResultFile::ResultFile(const std::string& path) : path_(path), file_(hdf5::File::open(path, hdf5::Access::read)) {
  bytes_ = std::filesystem::file_size(path);
  data_sets_ = file_.data_sets();
  std::map<std::string, std::size_t> rows;
  for (const std::string& name : data_sets_) {
    const hdf5::DataSet set = file_.data_set(name);
    if (!set.grows()) continue;
    rows[name] = set.shape()[0];
    if (set.shape().size() == 1 && file_.attribute(name, "axis")) axes_[name] = set.shape()[0];
  }
  // A writer may have added rows between two lines of the loop.
  for (const auto& [name, n] : rows) {
    if (const auto axis = nearest_axis(name)) axes_[*axis] = std::min(axes_[*axis], n);
  }
}

bool ResultFile::contains(const std::string& path) const { return std::ranges::binary_search(data_sets_, path); }

std::optional<std::string> ResultFile::axis_of(const std::string& path) const {
  if (!file_.data_set(path).grows()) return {};
  return nearest_axis(path);
}

std::optional<std::string> ResultFile::nearest_axis(const std::string& path) const {
  std::optional<std::string> nearest;
  for (const auto& [axis, rows] : axes_) {
    const std::string below = folder(axis);
    if (path.starts_with(below) && (!nearest || below.size() > folder(*nearest).size())) nearest = axis;
  }
  return nearest;
}

Array ResultFile::describe(const hdf5::DataSet& set) const {
  Array array{.type = set.type(), .shape = set.shape(), .grows = set.grows()};
  if (const auto axis = axis_of(set.path())) array.shape[0] = std::min(array.shape[0], axes_.at(*axis));
  if (const auto unit = attribute(set.path(), "unit"); unit && std::holds_alternative<std::string>(*unit)) {
    array.unit = std::get<std::string>(*unit);
  }
  return array;
}

Array ResultFile::read(const std::string& path) const {
  const hdf5::DataSet set = file_.data_set(path);
  Array array = describe(set);
  array.values = set.read_rows(0, array.shape.empty() ? 1 : array.shape[0]);
  return array;
}

Array ResultFile::last_row(const std::string& path) const {
  const hdf5::DataSet set = file_.data_set(path);
  Array array = describe(set);
  if (!array.grows) return read(path);
  if (array.shape[0] > 0) array.values = set.read_rows(array.shape[0] - 1, 1);
  array.shape[0] = std::min<std::size_t>(array.shape[0], 1);
  return array;
}

std::optional<AttributeValue> ResultFile::attribute(const std::string& object, const std::string& name) const {
  return file_.attribute(object, name);
}

std::string ResultFile::text(const std::string& name) const {
  const auto value = attribute({}, name);
  return value && std::holds_alternative<std::string>(*value) ? std::get<std::string>(*value) : std::string();
}

std::optional<StoredCheckpoint> ResultFile::checkpoint() const {
  const auto store = CheckpointStore::open(file_);
  if (!store) return {};
  return store->read();
}

}  // namespace muldi::results
