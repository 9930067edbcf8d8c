#include "results/memory_recorder.hpp"

namespace muldi::results {

void MemoryRecorder::do_start() {
  reals_.resize(layout().channels.size());
  integers_.resize(layout().channels.size());
  checkpoint_ = layout().checkpoint;
}

void MemoryRecorder::do_flush(const Checkpoint* checkpoint, std::span<const std::int64_t>) {
  for (const Column& column : columns()) {
    const Block& block = blocks()[column.block];
    const double* begin = column.begin + (block.written - block.first) * column.width;
    const std::size_t size = (block.next - block.written) * column.width;
    if (size == 0) continue;
    if (column.type == ValueType::float64) {
      reals_[column.channel].insert(reals_[column.channel].end(), begin, begin + size);
    } else {
      auto& values = integers_[column.channel];
      values.resize(values.size() + size);
      std::memcpy(values.data() + values.size() - size, begin, size * sizeof(double));
    }
  }
  if (checkpoint != nullptr) checkpoint_ = *checkpoint;
}

void MemoryRecorder::do_close(const Ending& ending, const Late& late) {
  ending_ = ending;
  late_ = late;
}

std::size_t MemoryRecorder::channel_index(std::string_view path, ValueType type) const {
  std::size_t index = 0;
  while (index < layout().channels.size() && layout().channels[index].spec.path != path) ++index;
  MULDI_EXPECT(index < layout().channels.size(), "the channel was declared");
  MULDI_EXPECT(layout().channels[index].spec.type == type, "the channel has the type that is asked for");
  return index;
}

std::span<const double> MemoryRecorder::reals(std::string_view path) const {
  return reals_[channel_index(path, ValueType::float64)];
}

std::span<const std::int64_t> MemoryRecorder::integers(std::string_view path) const {
  return integers_[channel_index(path, ValueType::int64)];
}

}  // namespace muldi::results
