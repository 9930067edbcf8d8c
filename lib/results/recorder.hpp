#pragma once
/// Where solvers put their results row by row; knows no file format.
///
/// Use: declare series, channels, fixed arrays, attributes and the checkpoint; `start()`; for every row append each
/// channel of the series once, the axis included, in any order; `close()`. A row exists once it is complete, so that
/// all channels of a series always have the same length. Appending copies into a block of rows and allocates nothing;
/// blocks are handed on when full and every `flush_interval` of wall time.
#include <chrono>
#include <concepts>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

#include "base/error.hpp"
#include "results/layout.hpp"

namespace muldi::results {

/// Handle of a declared channel.
struct Channel {
  std::size_t index = 0;
};

/// Handle of a declared series; its axis is appended to like any channel.
struct Series {
  std::size_t index = 0;
  Channel axis;
};

/// How a run ended.
struct Ending {
  std::string status = {};  ///< completed, interrupted, no_convergence, ... as the result format lists them
  std::string where = {};   ///< one sentence, empty if there is nothing to say
  double time = 0.0;        ///< simulated time at the end, unit of time of the run
};

/// Common part of all recorders: declarations, row blocks, when to hand them on.
class Recorder {
 public:
  /// `flush_interval` is the longest wall time for which complete rows stay invisible while rows keep coming.
  explicit Recorder(std::chrono::milliseconds flush_interval = std::chrono::milliseconds(500));
  virtual ~Recorder() = default;
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Declares a series with its axis; before `start()`.
  Series declare_series(const SeriesSpec& spec);
  /// Declares a channel of a series; before `start()`.
  Channel declare_channel(Series series, ChannelSpec spec);
  /// Declares an array that never changes; `values` in row-major order, `count(spec.shape)` of them. After `start()` it
  /// is kept back and written by `close()`.
  void declare_fixed(FixedSpec spec, std::span<const double> values);
  void declare_fixed(FixedSpec spec, std::span<const std::int64_t> values);
  /// Sets an attribute of the file (`object` empty), a group or a data set; after `start()` it is kept back and
  /// written by `close()`. A later value replaces an earlier one.
  void set_attribute(std::string object, std::string name, AttributeValue value);
  /// Fixes names and sizes of the checkpoint and gives the first one; before `start()`.
  void declare_checkpoint(Checkpoint first);

  /// Where a resumed recording goes on: the checkpoint that belongs to the rows kept; nothing for a new recording.
  virtual std::optional<Checkpoint> resume_point() const { return {}; }

  /// Creates everything that was declared.
  /// Throws InputError (existing output, a file to resume that does not fit) and EnvironmentError (cannot write).
  void start();

  /// Appends one row of a channel: `count(shape)` values in row-major order.
  /// Completing a row may write: throws EnvironmentError.
  void append(Channel channel, std::span<const double> row) {
    store(channel, row.data(), row.size(), ValueType::float64);
  }
  void append(Channel channel, std::span<const std::int64_t> row) {
    store(channel, row.data(), row.size(), ValueType::int64);
  }
  /// Appends one row of a scalar channel; an integer may go to a channel of doubles, not the other way round.
  template <class Value>
  requires std::is_arithmetic_v<Value>
  void append(Channel channel, Value value) {
    if (std::integral<Value> && channel.index < columns_.size() && columns_[channel.index].type == ValueType::int64) {
      const auto integer = static_cast<std::int64_t>(value);
      store(channel, &integer, 1, ValueType::int64);
    } else {
      const auto real = static_cast<double>(value);
      store(channel, &real, 1, ValueType::float64);
    }
  }

  /// Remembers the state that belongs to all rows completed so far; the next flush puts it on record, after these rows.
  /// Names and sizes are those declared. Costs a copy: may be called every step.
  void write_checkpoint(const Checkpoint& checkpoint);

  /// Makes all complete rows and the last checkpoint visible. Throws EnvironmentError.
  void flush();

  /// Flushes, puts down how the run ended, and ends the recording; an incomplete row is dropped. Throws
  /// EnvironmentError.
  void close(const Ending& ending);

  /// Number of complete rows, including those kept when a file is resumed.
  std::size_t rows(Series series) const;
  bool started() const { return state_ == State::recording; }

 protected:
  /// Buffer of one channel: `count(shape)` values a row, rows one after the other.
  struct Column {
    std::size_t channel = 0;  ///< index in the layout
    std::size_t block = 0;    ///< index of the series
    std::size_t width = 0;    ///< values a row
    std::size_t next = 0;     ///< row that the next append fills
    ValueType type = ValueType::float64;
    double* begin = nullptr;  ///< values of the first row of the block; int64 values are stored by their bits
  };
  /// Rows [first, next) of a series; rows [first, written) have been handed on before.
  struct Block {
    std::size_t capacity = 0;  ///< rows; a power of two
    std::size_t first = 0;     ///< always a multiple of capacity
    std::size_t written = 0;
    std::size_t next = 0;
    std::size_t n_columns = 0;
    std::size_t filled = 0;  ///< columns that have the row `next`
    std::vector<double> values;
  };

  /// What came after the start.
  struct Late {
    std::vector<Attribute> attributes;
    std::vector<FixedArray> fixed;
  };

  const Layout& layout() const { return layout_; }
  std::span<const Block> blocks() const { return blocks_; }
  /// Columns in the order of `layout().channels`.
  std::span<const Column> columns() const { return columns_; }
  /// For resuming: the series goes on at `row`; the caller fills the rows from the block's first one.
  void go_on_at(std::size_t series, std::size_t row);

 private:
  enum class State { declaring, recording, closed, failed };

  /// Rows of the blocks of a series, a power of two; a recording that is resumed has its own.
  virtual std::size_t block_rows(const SeriesSpec&, std::size_t proposed) const { return proposed; }
  /// Creates what the layout says; may call `go_on_at`.
  virtual void do_start() = 0;
  /// Takes over rows [written, next) of every block and, if not null, the checkpoint with the number of rows of each
  /// series that belong to it.
  virtual void do_flush(const Checkpoint* checkpoint, std::span<const std::int64_t> checkpoint_rows) = 0;
  virtual void do_close(const Ending& ending, const Late& late) = 0;

  void add_fixed(FixedArray array);
  void make_blocks();
  void check_paths() const;
  void row_complete(Block& block);

  void store(Channel channel, const void* row, std::size_t size, ValueType type) {
    MULDI_EXPECT(channel.index < columns_.size() && state_ == State::recording, "append needs a started recorder");
    Column& column = columns_[channel.index];
    Block& block = blocks_[column.block];
    MULDI_EXPECT(size == column.width && type == column.type, "a row has the declared size and type");
    MULDI_EXPECT(column.next == block.next, "a channel is appended once a row");
    std::memcpy(column.begin + (column.next - block.first) * size, row, size * sizeof(double));
    ++column.next;
    if (++block.filled == block.n_columns) row_complete(block);
  }

  Layout layout_;
  std::vector<Column> columns_;
  std::vector<Block> blocks_;
  Late late_;
  Checkpoint checkpoint_;
  std::vector<std::int64_t> checkpoint_rows_;
  bool checkpoint_is_new_ = false;
  State state_ = State::declaring;
  std::chrono::steady_clock::duration flush_interval_;
  std::chrono::steady_clock::time_point next_flush_;
};

}  // namespace muldi::results
