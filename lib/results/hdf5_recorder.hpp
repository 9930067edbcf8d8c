#pragma once
/// Records into an HDF5 file that can be read at any moment.
///
/// While the run goes on the file is in SWMR mode: other programs open it with swmr=True (h5py) and see new rows after
/// `dataset.id.refresh()`; a plain open works too and shows the state of that moment. `status` is `running` from the
/// first byte; the true status is put down by `close()`, when the file has left SWMR mode. After a killed process the
/// file opens as it is, whatever the moment (unmarked_driver.hpp), and still says `running`: nothing need be done to
/// read it, `--resume` goes on from its checkpoint.
///
/// The axis of a series is written last: rows up to its length are complete whatever happens. After a write error the
/// file holds all rows of the last flush that succeeded, and the status `write_error` where that can still be written.
///
/// A new file is made in a thread of its own, beside the first steps: hundreds of data sets take milliseconds. Whether
/// the path can be written is known before; other failures come out of the first flush. Where addresses are limited
/// (`ulimit -v`) it is made before the first steps: the library does not survive a refused allocation, so that some
/// megabytes are kept back for whatever it does.
#include <future>

#include "base/address_reserve.hpp"
#include "results/checkpoint_store.hpp"
#include "results/hdf5_file.hpp"
#include "results/live_file.hpp"
#include "results/recorder.hpp"

namespace muldi::results {

/// What to do about the output file.
struct Output {
  enum class Mode { create, overwrite, resume };
  std::string path;
  Mode mode = Mode::create;  ///< create: an existing file is an InputError
  std::chrono::milliseconds flush_interval{500};
};

/// Recorder into an HDF5 file.
class Hdf5Recorder final : public Recorder {
 public:
  /// Opens the file to resume, if it is to be; a new one is made by `start()`.
  /// Throws InputError if the file to resume is missing, damaged, in use, or has no checkpoint.
  explicit Hdf5Recorder(Output output);
  /// A recording that was not closed (an exception passes) ends as `interrupted`.
  ~Hdf5Recorder() override;

  std::optional<Checkpoint> resume_point() const override { return resume_point_; }

 private:
  std::size_t block_rows(const SeriesSpec& series, std::size_t proposed) const override;
  void do_start() override;
  void do_flush(const Checkpoint* checkpoint, std::span<const std::int64_t> checkpoint_rows) override;
  void do_close(const Ending& ending, const Late& late) override;

  void open_to_resume();
  void create();
  /// Throws what went wrong while the file was made.
  void wait_until_created();
  void create_content();
  void reopen(hdf5::Access access);
  void resume();
  void check_layout() const;
  void check_rows() const;
  void cut();
  void open_checkpoints();
  hdf5::RowStorage storage(const Column& column) const;
  hdf5::DataSet& data_set_of(const Column& column);
  void write_rows(const Column& column);
  void end(const Ending& ending, const Late& late);
  void drop();
  void rescue(const std::string& sentence);

  /// What the library takes beside the rows, and some more.
  static constexpr std::size_t kept_back = 16UL << 20U;

  Output output_;
  base::AddressReserve reserve_{kept_back};
  LiveFile live_;
  hdf5::File file_;
  std::vector<hdf5::DataSet> data_sets_;  ///< in the order of the columns; opened by their first rows
  std::optional<CheckpointStore> checkpoints_;
  std::optional<Checkpoint> resume_point_;
  std::vector<std::int64_t> resume_rows_;  ///< by series
  std::future<void> created_;              ///< last, so that its thread ends before what it uses
};

}  // namespace muldi::results
