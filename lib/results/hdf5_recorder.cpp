#include "results/hdf5_recorder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <limits>

namespace muldi::results {
namespace {

constexpr std::size_t compressed_row_bytes = 4096;  // a field; rows of numbers are written faster than compressed
constexpr std::size_t max_chunk_bytes = std::size_t{256} << 10;

hdf5::RowStorage storage_of(std::size_t width, std::size_t block_rows) {
  const std::size_t row_bytes = width * sizeof(double);
  const std::size_t rows = std::bit_floor(std::max<std::size_t>(max_chunk_bytes / row_bytes, 1));
  return {std::min(rows, block_rows), row_bytes >= compressed_row_bytes};
}

/// Makes sure that the path can be written; a file that is there is an error unless it may be overwritten.
void claim(const Output& output) {
  std::error_code none;
  if (std::filesystem::exists(output.path, none) && !std::filesystem::is_regular_file(output.path, none)) {
    throw base::EnvironmentError("cannot write '" + output.path + "': not a regular file");
  }
  const bool overwrite = output.mode == Output::Mode::overwrite;
  const int descriptor = ::open(output.path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | (overwrite ? 0 : O_EXCL), 0666);
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (descriptor < 0 && error == EEXIST) {
    throw base::InputError("'" + output.path + "' exists (--force overwrites it, --output names another file)");
  }
  if (descriptor < 0) throw base::EnvironmentError("cannot write '" + output.path + "': " + std::strerror(error));
}

void describe(hdf5::DataSet& set, const std::string& unit, const std::string& doc) {
  if (!unit.empty()) set.add_attribute("unit", unit);
  if (!doc.empty()) set.add_attribute("doc", doc);
}

void set_status(hdf5::File& file, const Ending& ending) {
  file.set_attribute({{}, "status", ending.status});
  file.set_attribute({{}, "status_time", ending.time});
  file.set_attribute({{}, "status_where", ending.where});
}

const Ending running{.status = "running", .where = {}, .time = std::numeric_limits<double>::quiet_NaN()};

/// What is wrong with a data set that a recording wants to go on with; empty if it fits.
std::string mismatch(const hdf5::File& file, const hdf5::DataSet& set, const ChannelSpec& spec) {
  const auto unit = file.attribute(set.path(), "unit");
  if (!set.grows() || set.storage().chunk_rows == 0) return "is not made of rows";
  if (!std::ranges::equal(std::span(set.shape()).subspan(1), spec.shape)) return "has rows of another shape";
  if (set.type() != spec.type) return "has values of another type";
  if (unit.value_or(std::string()) != AttributeValue(spec.unit)) return "has another unit";
  return {};
}

bool same_bits(const hdf5::DataSet& set, const FixedArray& array) {
  if (set.shape() != array.spec.shape || set.type() != array.type) return false;
  std::vector<std::int64_t> bits(count(set.shape()));
  if (bits.empty()) return true;
  set.read_rows(0, set.shape().empty() ? 1 : set.shape()[0], bits.data());
  return std::memcmp(bits.data(), array.values(), bits.size() * sizeof(double)) == 0;
}

}  // namespace

Hdf5Recorder::Hdf5Recorder(Output output) : Recorder(output.flush_interval), output_(std::move(output)) {
  if (output_.mode == Output::Mode::resume) open_to_resume();
}

Hdf5Recorder::~Hdf5Recorder() {
  if (!started()) return;
  try {
    close({.status = "interrupted", .where = "the recording was not closed", .time = running.time});
  } catch (const std::exception&) {
    // The status says what could be saved; a destructor has nobody to tell.
  }
}

void Hdf5Recorder::open_to_resume() {
  remove_stale_mark(output_.path);
  {
    const hdf5::File reader = hdf5::File::open(output_.path, hdf5::Access::read);
    const auto store = CheckpointStore::open(reader);
    if (!store) throw base::InputError("'" + output_.path + "' cannot be resumed: it has no checkpoint");
    StoredCheckpoint stored = store->read();
    resume_point_ = std::move(stored.checkpoint);
    resume_rows_ = std::move(stored.rows);
  }
  live_ = LiveFile(output_.path);
  file_ = hdf5::File::open(output_.path, hdf5::Access::write);
  file_.own_all_bytes();
}

std::size_t Hdf5Recorder::block_rows(const SeriesSpec& series, std::size_t proposed) const {
  if (output_.mode != Output::Mode::resume || !file_.contains(series.axis)) return proposed;
  const std::size_t rows = file_.data_set(series.axis).storage().chunk_rows;
  return std::has_single_bit(rows) ? rows : proposed;
}

void Hdf5Recorder::do_start() {
  if (output_.mode == Output::Mode::resume) {
    resume();
    reserve_.try_take();
  } else {
    create();
  }
}

void Hdf5Recorder::create() {
  reserve_.take();
  claim(output_);
  live_ = LiveFile(output_.path);
  created_ = std::async(reserve_.is_limited() ? std::launch::deferred : std::launch::async, [this] {
    const base::AddressReserve::Use use(reserve_);
    try {
      file_ = hdf5::File::create(output_.path);
      create_content();
      reopen(hdf5::Access::append);
    } catch (...) {
      drop();
      std::error_code ignored;
      std::filesystem::remove(output_.path, ignored);
      throw;
    }
  });
  if (reserve_.is_limited()) created_.wait();
}

void Hdf5Recorder::wait_until_created() {
  if (!created_.valid()) return;
  hdf5::prepare_thread();
  created_.get();
}

/// Writes what was changed and opens the file anew; data sets are opened when they are asked for.
void Hdf5Recorder::reopen(hdf5::Access access) {
  data_sets_ = std::vector<hdf5::DataSet>(columns().size());
  checkpoints_.reset();
  file_.close();
  file_ = hdf5::File::open(output_.path, access);
}

hdf5::RowStorage Hdf5Recorder::storage(const Column& column) const {
  return storage_of(column.width, blocks()[column.block].capacity);
}

void Hdf5Recorder::create_content() {
  set_status(file_, running);
  for (const FixedArray& array : layout().fixed) {
    hdf5::DataSet set = file_.create_fixed(array);
    describe(set, array.spec.unit, array.spec.doc);
  }
  for (const Column& column : columns()) {
    const DeclaredChannel& channel = layout().channels[column.channel];
    hdf5::DataSet set = file_.create_rows(channel.spec, storage(column));
    describe(set, channel.spec.unit, channel.spec.doc);
    if (channel.axis) set.add_attribute("axis", std::int64_t{1});
  }
  for (const Attribute& attribute : layout().attributes) file_.set_attribute(attribute);
  std::vector<std::string> axes;
  for (const SeriesSpec& series : layout().series) axes.push_back(series.axis);
  CheckpointStore::create(file_, layout().checkpoint, axes);
}

void Hdf5Recorder::resume() {
  check_layout();
  check_rows();
  open_checkpoints();
  try {
    set_status(file_, running);
    reopen(hdf5::Access::shorten);
    cut();
    reopen(hdf5::Access::append);
  } catch (const base::EnvironmentError& error) {
    rescue(error.what());
    throw;
  }
}

void Hdf5Recorder::check_layout() const {
  std::vector<base::Diagnostic> differences;
  const auto report = [&](const std::string& path, const std::string& what) {
    differences.push_back({.place = {.file = output_.path}, .path = path, .message = what});
  };
  std::vector<std::string> expected;
  for (const DeclaredChannel& channel : layout().channels) {
    expected.push_back(channel.spec.path);
    if (!file_.contains(channel.spec.path)) {
      report(channel.spec.path, "cannot be resumed: the file lacks it");
    } else if (const auto what = mismatch(file_, file_.data_set(channel.spec.path), channel.spec); !what.empty()) {
      report(channel.spec.path, "cannot be resumed: it " + what);
    }
  }
  for (const FixedArray& array : layout().fixed) {
    const std::string& path = array.spec.path;
    if (!file_.contains(path) || !same_bits(file_.data_set(path), array))
      report(path, "cannot be resumed: the file has other values");
  }
  for (const std::string& path : file_.data_sets()) {
    if (file_.data_set(path).grows() && std::ranges::find(expected, path) == expected.end()) {
      report(path, "cannot be resumed: the scene does not record it");
    }
  }
  if (!differences.empty()) throw base::InputError(std::move(differences));
}

void Hdf5Recorder::check_rows() const {
  for (const Column& column : columns()) {
    const std::string& path = layout().channels[column.channel].spec.path;
    if (file_.data_set(path).shape()[0] < static_cast<std::size_t>(resume_rows_[column.block])) {
      throw base::InputError("'" + output_.path + "' cannot be resumed: /" + path + " is too short");
    }
  }
}

void Hdf5Recorder::cut() {
  for (const Column& column : columns()) {
    data_set_of(column).resize(static_cast<std::size_t>(resume_rows_[column.block]));
  }
  for (std::size_t s = 0; s < blocks().size(); ++s) go_on_at(s, static_cast<std::size_t>(resume_rows_[s]));
  for (const Column& column : columns()) {
    const Block& block = blocks()[column.block];
    data_set_of(column).read_rows(block.first, block.next - block.first, column.begin);
  }
}

hdf5::DataSet& Hdf5Recorder::data_set_of(const Column& column) {
  hdf5::DataSet& set = data_sets_[column.channel];
  if (set.is_open()) return set;
  const ChannelSpec& spec = layout().channels[column.channel].spec;
  const bool as_created = output_.mode != Output::Mode::resume;
  set = as_created ? file_.open_rows(spec, storage(column)) : file_.data_set(spec.path);
  return set;
}

void Hdf5Recorder::open_checkpoints() {
  checkpoints_ = CheckpointStore::open(file_);
  checkpoints_->order_as(layout().checkpoint, output_.path);
}

void Hdf5Recorder::write_rows(const Column& column) {
  const Block& block = blocks()[column.block];
  if (block.next == block.written) return;
  hdf5::DataSet& set = data_set_of(column);
  set.resize(block.next);
  if (set.storage().compressed) {
    set.write_rows(block.written, block.next - block.written,
                   column.begin + (block.written - block.first) * column.width);
    return;
  }
  const std::size_t rows = set.storage().chunk_rows;
  for (std::size_t row = (block.written - block.first) / rows * rows; row < block.next - block.first; row += rows) {
    set.write_chunk(block.first + row, column.begin + row * column.width, rows * column.width * sizeof(double));
  }
}

void Hdf5Recorder::do_flush(const Checkpoint* checkpoint, std::span<const std::int64_t> checkpoint_rows) {
  const auto write = [&](bool axes) {
    for (const Column& column : columns()) {
      if (layout().channels[column.channel].axis == axes) write_rows(column);
    }
    file_.flush();
  };
  wait_until_created();
  const base::AddressReserve::Use use(reserve_);
  try {
    write(false);
    write(true);
    if (checkpoint == nullptr) return;
    if (!checkpoints_) open_checkpoints();
    checkpoints_->write(*checkpoint, checkpoint_rows);
  } catch (const base::EnvironmentError& error) {
    rescue(error.what());
    throw;
  }
}

void Hdf5Recorder::do_close(const Ending& ending, const Late& late) {
  wait_until_created();
  reserve_.release();
  try {
    data_sets_.clear();
    checkpoints_.reset();
    file_.close();
    end(ending, late);
  } catch (const base::EnvironmentError& error) {
    rescue(error.what());
    throw;
  }
}

void Hdf5Recorder::end(const Ending& ending, const Late& late) {
  file_ = hdf5::File::open(output_.path, hdf5::Access::write);
  set_status(file_, ending);
  for (const FixedArray& array : late.fixed) {
    file_.remove(array.spec.path);
    hdf5::DataSet set = file_.create_fixed(array);
    describe(set, array.spec.unit, array.spec.doc);
  }
  for (const Attribute& attribute : late.attributes) file_.set_attribute(attribute);
  file_.close();
  live_ = {};
}

/// Leaves the file as the last flush left it.
void Hdf5Recorder::drop() {
  file_.abandon();
  data_sets_.clear();
  checkpoints_.reset();
  try {
    file_.close();
  } catch (const base::EnvironmentError&) {
    // What could not be written is lost: that is why we are here.
  }
}

/// After a write error: the file goes back to the last flush, its series get one length, its status says why it ends.
void Hdf5Recorder::rescue(const std::string& sentence) {
  drop();
  try {
    file_ = hdf5::File::open(output_.path, hdf5::Access::shorten);
    std::vector<std::size_t> rows;
    for (const SeriesSpec& series : layout().series) rows.push_back(file_.data_set(series.axis).shape()[0]);
    for (const DeclaredChannel& channel : layout().channels) {
      hdf5::DataSet set = file_.data_set(channel.spec.path);
      if (set.shape()[0] > rows[channel.series]) set.resize(rows[channel.series]);
    }
    reopen(hdf5::Access::write);
    set_status(file_, {.status = "write_error", .where = sentence, .time = running.time});
    file_.close();
  } catch (const base::EnvironmentError&) {
    drop();  // not even this could be written: the file says `running`
  }
  live_ = {};
}

}  // namespace muldi::results
