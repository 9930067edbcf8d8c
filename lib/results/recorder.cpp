#include "results/recorder.hpp"

#include <algorithm>
#include <bit>
#include <set>

namespace muldi::results {
namespace {

constexpr std::size_t max_block_rows = 1024;
constexpr std::size_t max_block_bytes = std::size_t{16} << 20;
/// Rows of a block with many narrow channels, whatever it takes: chunks of a few rows would drown in their index.
constexpr std::size_t min_narrow_rows = 64;
constexpr std::size_t wide_row_bytes = 4096;

/// Folder of a path with its trailing slash; empty for a path at the top.
std::string_view folder(std::string_view path) {
  const auto slash = path.rfind('/');
  return slash == std::string_view::npos ? std::string_view{} : path.substr(0, slash + 1);
}

/// Rows held in memory, a power of two: a full block is some hundred kilobytes for a lumped scene.
std::size_t proposed_rows(std::size_t row_bytes, std::size_t widest_bytes, std::size_t expected_rows) {
  std::size_t rows = std::clamp<std::size_t>(max_block_bytes / row_bytes, 1, max_block_rows);
  if (widest_bytes < wide_row_bytes) rows = std::max(rows, min_narrow_rows);
  rows = std::bit_floor(rows);
  return expected_rows == 0 ? rows : std::min(rows, std::bit_ceil(expected_rows));
}

template <class Value>
bool same_shape(const std::vector<CheckpointVector<Value>>& a, const std::vector<CheckpointVector<Value>>& b) {
  return std::ranges::equal(a, b, [](const auto& left, const auto& right) {
    return left.name == right.name && left.values.size() == right.values.size();
  });
}

template <class Value>
void copy_values(const std::vector<CheckpointVector<Value>>& from, std::vector<CheckpointVector<Value>>& to) {
  for (std::size_t i = 0; i < from.size(); ++i) std::ranges::copy(from[i].values, to[i].values.begin());
}

}  // namespace

Recorder::Recorder(std::chrono::milliseconds flush_interval) : flush_interval_(flush_interval) {}

Series Recorder::declare_series(const SeriesSpec& spec) {
  MULDI_EXPECT(state_ == State::declaring, "declarations come before start()");
  const std::size_t index = layout_.series.size();
  layout_.series.push_back(spec);
  ChannelSpec axis{.path = spec.axis, .shape = {}, .unit = spec.unit, .doc = spec.doc};
  layout_.channels.push_back({std::move(axis), index, true});
  return {index, Channel{layout_.channels.size() - 1}};
}

Channel Recorder::declare_channel(Series series, ChannelSpec spec) {
  MULDI_EXPECT(state_ == State::declaring, "declarations come before start()");
  MULDI_EXPECT(series.index < layout_.series.size(), "the series is declared first");
  MULDI_EXPECT(count(spec.shape) > 0 && spec.shape.size() < 8, "a row has at least one value, at most 7 indices");
  layout_.channels.push_back({std::move(spec), series.index, false});
  return {layout_.channels.size() - 1};
}

void Recorder::declare_fixed(FixedSpec spec, std::span<const double> values) {
  add_fixed({std::move(spec), ValueType::float64, {values.begin(), values.end()}, {}});
}

void Recorder::declare_fixed(FixedSpec spec, std::span<const std::int64_t> values) {
  add_fixed({std::move(spec), ValueType::int64, {}, {values.begin(), values.end()}});
}

void Recorder::add_fixed(FixedArray array) {
  MULDI_EXPECT(array.reals.size() + array.integers.size() == count(array.spec.shape),
               "a fixed array has as many values as its shape says");
  (state_ == State::declaring ? layout_.fixed : late_.fixed).push_back(std::move(array));
}

void Recorder::set_attribute(std::string object, std::string name, AttributeValue value) {
  auto& list = state_ == State::declaring ? layout_.attributes : late_.attributes;
  const auto same = [&](const Attribute& old) { return old.object == object && old.name == name; };
  const auto found = std::ranges::find_if(list, same);
  if (found != list.end()) {
    found->value = std::move(value);
  } else {
    list.push_back({std::move(object), std::move(name), std::move(value)});
  }
}

void Recorder::declare_checkpoint(Checkpoint first) {
  MULDI_EXPECT(state_ == State::declaring, "declarations come before start()");
  layout_.checkpoint = std::move(first);
}

void Recorder::check_paths() const {
  std::set<std::string_view> axes;
  for (const SeriesSpec& series : layout_.series) axes.insert(folder(series.axis));
  MULDI_EXPECT(axes.size() == layout_.series.size(), "a folder has one axis");
  std::set<std::string_view> paths;
  const auto check = [&](const std::string& path) {
    MULDI_EXPECT(!path.empty() && path.front() != '/' && path.back() != '/', "a path has no slash at its ends");
    MULDI_EXPECT(paths.insert(path).second, "a path is declared once");
  };
  for (const DeclaredChannel& channel : layout_.channels) {
    check(channel.spec.path);
    std::string_view enclosing = folder(channel.spec.path);
    while (!enclosing.empty() && !axes.contains(enclosing)) {
      enclosing.remove_suffix(1);
      enclosing = folder(enclosing);
    }
    MULDI_EXPECT(enclosing == folder(layout_.series[channel.series].axis),
                 "a channel lies below the axis of its series");
  }
  for (const FixedArray& array : layout_.fixed) check(array.spec.path);
}

void Recorder::make_blocks() {
  std::vector<std::size_t> row_values(layout_.series.size(), 0);
  std::vector<std::size_t> widest(layout_.series.size(), 0);
  columns_.resize(layout_.channels.size());
  blocks_.resize(layout_.series.size());
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const DeclaredChannel& channel = layout_.channels[i];
    columns_[i] = {
        .channel = i, .block = channel.series, .width = count(channel.spec.shape), .type = channel.spec.type};
    row_values[channel.series] += columns_[i].width;
    widest[channel.series] = std::max(widest[channel.series], columns_[i].width);
    ++blocks_[channel.series].n_columns;
  }
  for (std::size_t s = 0; s < blocks_.size(); ++s) {
    blocks_[s].capacity = block_rows(
        layout_.series[s],
        proposed_rows(row_values[s] * sizeof(double), widest[s] * sizeof(double), layout_.series[s].expected_rows));
    blocks_[s].values.assign(blocks_[s].capacity * row_values[s], 0.0);
  }
  std::vector<std::size_t> offset(blocks_.size(), 0);
  for (Column& column : columns_) {
    column.begin = blocks_[column.block].values.data() + offset[column.block];
    offset[column.block] += column.width * blocks_[column.block].capacity;
  }
}

void Recorder::start() {
  MULDI_EXPECT(state_ == State::declaring, "start() comes once");
  check_paths();
  make_blocks();
  checkpoint_ = layout_.checkpoint;
  checkpoint_rows_.assign(blocks_.size(), 0);
  do_start();
  state_ = State::recording;
  next_flush_ = std::chrono::steady_clock::now() + flush_interval_;
}

void Recorder::go_on_at(std::size_t series, std::size_t row) {
  Block& block = blocks_[series];
  block.first = row - row % block.capacity;
  block.written = block.next = row;
  for (Column& column : columns_) {
    if (column.block == series) column.next = row;
  }
}

void Recorder::row_complete(Block& block) {
  block.filled = 0;
  ++block.next;
  if (block.next == block.first + block.capacity || std::chrono::steady_clock::now() >= next_flush_) flush();
}

void Recorder::write_checkpoint(const Checkpoint& checkpoint) {
  MULDI_EXPECT(state_ == State::recording, "a checkpoint needs a started recorder");
  MULDI_EXPECT(same_shape(checkpoint.reals, checkpoint_.reals) && same_shape(checkpoint.integers, checkpoint_.integers),
               "a checkpoint has the declared names and sizes");
  copy_values(checkpoint.reals, checkpoint_.reals);
  copy_values(checkpoint.integers, checkpoint_.integers);
  for (std::size_t s = 0; s < blocks_.size(); ++s) checkpoint_rows_[s] = static_cast<std::int64_t>(blocks_[s].next);
  checkpoint_is_new_ = true;
}

void Recorder::flush() {
  MULDI_EXPECT(state_ == State::recording, "flush needs a started recorder");
  const bool has_rows = std::ranges::any_of(blocks_, [](const Block& block) { return block.next > block.written; });
  if (has_rows || checkpoint_is_new_) {
    try {
      do_flush(checkpoint_is_new_ ? &checkpoint_ : nullptr, checkpoint_rows_);
    } catch (...) {
      state_ = State::failed;
      throw;
    }
  }
  checkpoint_is_new_ = false;
  for (Block& block : blocks_) {
    block.written = block.next;
    if (block.next == block.first + block.capacity) {
      block.first = block.next;
      // Rows not yet recorded reach the disk as part of their chunk: zeros, not remains of the block before.
      std::ranges::fill(block.values, 0.0);
    }
  }
  next_flush_ = std::chrono::steady_clock::now() + flush_interval_;
}

void Recorder::close(const Ending& ending) {
  if (state_ == State::failed || state_ == State::closed) return;
  flush();
  state_ = State::closed;
  do_close(ending, late_);
}

std::size_t Recorder::rows(Series series) const {
  MULDI_EXPECT(series.index < blocks_.size(), "rows are counted after start()");
  return blocks_[series.index].next;
}

}  // namespace muldi::results
