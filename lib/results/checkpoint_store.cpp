#include "results/checkpoint_store.hpp"

#include <array>

namespace muldi::results {
namespace {

const std::string folder = "checkpoint/";

std::string name_of(const hdf5::DataSet& set) { return set.path().substr(folder.size()); }

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    names.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return names;
}

/// Both slots of a vector.
template <class Value>
FixedArray doubled(const std::string& name, const std::vector<Value>& values, ValueType type) {
  FixedArray array{.spec = {.path = folder + name, .shape = {2, values.size()}, .unit = {}, .doc = {}},
                   .type = type,
                   .reals = {},
                   .integers = {}};
  for (int slot = 0; slot < 2; ++slot) {
    if constexpr (std::is_same_v<Value, double>) {
      array.reals.insert(array.reals.end(), values.begin(), values.end());
    } else {
      array.integers.insert(array.integers.end(), values.begin(), values.end());
    }
  }
  return array;
}

std::array<std::int64_t, 2> read_counters(const hdf5::DataSet& set) {
  std::array<std::int64_t, 2> counters{};
  set.read_rows(0, 2, counters.data());
  return counters;
}

template <class Value>
std::vector<CheckpointVector<Value>> read_slot(const std::vector<hdf5::DataSet>& sets, std::size_t slot) {
  std::vector<CheckpointVector<Value>> vectors;
  for (const hdf5::DataSet& set : sets) {
    vectors.push_back({name_of(set), std::vector<Value>(set.shape()[1])});
    if (!vectors.back().values.empty()) set.read_rows(slot, 1, vectors.back().values.data());
  }
  return vectors;
}

template <class Value>
void write_slot(const std::vector<CheckpointVector<Value>>& vectors, std::vector<hdf5::DataSet>& sets,
                std::size_t slot) {
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (!vectors[i].values.empty()) sets[i].write_rows(slot, 1, vectors[i].values.data());
  }
}

/// Moves the sets into the order of the vectors; false if they are not the same.
template <class Value>
bool order(const std::vector<CheckpointVector<Value>>& vectors, std::vector<hdf5::DataSet>& sets) {
  if (vectors.size() != sets.size()) return false;
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const auto found = std::find_if(sets.begin() + static_cast<std::ptrdiff_t>(i), sets.end(),
                                    [&](const hdf5::DataSet& set) { return name_of(set) == vectors[i].name; });
    if (found == sets.end() || found->shape()[1] != vectors[i].values.size()) return false;
    std::swap(*found, sets[i]);
  }
  return true;
}

}  // namespace

void CheckpointStore::create(hdf5::File& file, const Checkpoint& first, const std::vector<std::string>& axes) {
  for (const auto& vector : first.reals) {
    file.create_fixed(doubled(vector.name, vector.values, ValueType::float64), true);
  }
  for (const auto& vector : first.integers) {
    file.create_fixed(doubled(vector.name, vector.values, ValueType::int64), true);
  }
  file.create_fixed(doubled("rows", std::vector<std::int64_t>(axes.size(), 0), ValueType::int64), true);
  file.create_fixed(doubled("counter", std::vector<std::int64_t>{0}, ValueType::int64), true);
  file.set_attribute({folder + "rows", "axes", joined(axes)});
}

std::optional<CheckpointStore> CheckpointStore::open(const hdf5::File& file) {
  if (!file.contains(folder + "counter")) return {};
  CheckpointStore store;
  for (const std::string& path : file.data_sets("checkpoint")) {
    hdf5::DataSet set = file.data_set(path);
    const std::string name = name_of(set);
    if (set.shape().size() != 2 || set.shape()[0] != 2) throw base::InputError("damaged checkpoint: /" + path);
    if (name == "counter") {
      store.counter_ = std::move(set);
    } else if (name == "rows") {
      store.rows_ = std::move(set);
    } else {
      (set.type() == ValueType::float64 ? store.reals_ : store.integers_).push_back(std::move(set));
    }
  }
  if (const auto axes = file.attribute(folder + "rows", "axes")) store.axes_ = split(std::get<std::string>(*axes));
  return store;
}

StoredCheckpoint CheckpointStore::read() const {
  for (;;) {
    const auto before = read_counters(counter_);
    const std::size_t slot = before[1] > before[0] ? 1 : 0;
    StoredCheckpoint stored{{read_slot<double>(reals_, slot), read_slot<std::int64_t>(integers_, slot)},
                            std::vector<std::int64_t>(axes_.size())};
    if (!axes_.empty()) rows_.read_rows(slot, 1, stored.rows.data());
    // A writer takes the other slot first: this one is disturbed only if both were written meanwhile.
    if (read_counters(counter_) == before) return stored;
  }
}

void CheckpointStore::write(const Checkpoint& checkpoint, std::span<const std::int64_t> rows) {
  const auto counters = read_counters(counter_);
  const std::size_t slot = counters[1] > counters[0] ? 0 : 1;
  write_slot(checkpoint.reals, reals_, slot);
  write_slot(checkpoint.integers, integers_, slot);
  if (!rows.empty()) rows_.write_rows(slot, 1, rows.data());
  const std::int64_t next = std::max(counters[0], counters[1]) + 1;
  counter_.write_rows(slot, 1, &next);
}

void CheckpointStore::order_as(const Checkpoint& first, const std::string& file) {
  if (!order(first.reals, reals_) || !order(first.integers, integers_)) {
    throw base::InputError("'" + file + "' cannot be resumed: its checkpoint is not of this scene");
  }
}

}  // namespace muldi::results
