#pragma once
/// The checkpoint in a result file, complete at every moment.
///
/// `/checkpoint/<name>` has two rows, of which the one with the greater number in `/checkpoint/counter` counts; the
/// other is overwritten, its number last. `/checkpoint/rows` is the length of every series at that moment, in the order
/// of its attribute `axes`.
#include "results/hdf5_file.hpp"

namespace muldi::results {

/// A checkpoint and the rows that belong to it, by series.
struct StoredCheckpoint {
  Checkpoint checkpoint;           ///< vectors sorted by name
  std::vector<std::int64_t> rows;  ///< by series
};

/// The two slots of a file that is open.
class CheckpointStore {
 public:
  CheckpointStore() = default;
  /// Makes the slots, both with the first checkpoint. `axes` are the paths of the axes.
  static void create(hdf5::File& file, const Checkpoint& first, const std::vector<std::string>& axes);
  /// Opens the slots; nothing if the file has none.
  static std::optional<CheckpointStore> open(const hdf5::File& file);

  const std::vector<std::string>& axes() const { return axes_; }
  /// The newer checkpoint; a file under recording is read again until no write came between.
  StoredCheckpoint read() const;
  /// Overwrites the older one; names and sizes are those of the first, in the same order.
  void write(const Checkpoint& checkpoint, std::span<const std::int64_t> rows);
  /// Puts the vectors in the order of `first`, in which `write` gets them; throws InputError if names or sizes differ.
  void order_as(const Checkpoint& first, const std::string& file);

 private:
  std::vector<std::string> axes_;
  std::vector<hdf5::DataSet> reals_, integers_;
  hdf5::DataSet rows_, counter_;
};

}  // namespace muldi::results
