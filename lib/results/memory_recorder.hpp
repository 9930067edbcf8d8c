#pragma once
/// A recorder that keeps everything in memory: for tests and for runs inside a run.
#include "results/recorder.hpp"

namespace muldi::results {

/// Keeps the rows of every channel; values are visible after `flush()` or `close()`.
class MemoryRecorder final : public Recorder {
 public:
  using Recorder::Recorder;

  /// All rows of a channel, row-major. `path` as declared; throws ContractError if there is none of this type.
  std::span<const double> reals(std::string_view path) const;
  std::span<const std::int64_t> integers(std::string_view path) const;
  /// What was declared before the start.
  const Layout& declared() const { return layout(); }
  /// What was declared after the start; filled by `close()`.
  std::span<const Attribute> late_attributes() const { return late_.attributes; }
  std::span<const FixedArray> late_fixed() const { return late_.fixed; }
  /// The last checkpoint that was flushed; the declared one before.
  const Checkpoint& checkpoint() const { return checkpoint_; }
  /// How the run ended; status `running` until then.
  const Ending& ending() const { return ending_; }

 private:
  void do_start() override;
  void do_flush(const Checkpoint* checkpoint, std::span<const std::int64_t> checkpoint_rows) override;
  void do_close(const Ending& ending, const Late& late) override;
  std::size_t channel_index(std::string_view path, ValueType type) const;

  std::vector<std::vector<double>> reals_;           ///< by channel; empty for integers
  std::vector<std::vector<std::int64_t>> integers_;  ///< by channel; empty for reals
  Late late_;
  Checkpoint checkpoint_;
  Ending ending_{.status = "running", .where = {}, .time = 0.0};
};

}  // namespace muldi::results
