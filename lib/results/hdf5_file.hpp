#pragma once
/// The HDF5 library behind a few owning types; no other file includes its headers.
/// Errors become exceptions: EnvironmentError where a file is written, InputError where it is read.
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "results/layout.hpp"

namespace muldi::results::hdf5 {

/// The version of the library in use, e.g. `1.10.8`.
std::string library_version();

/// Keeps the library from printing its errors, which become exceptions here. Opening a file does it for the thread that
/// opens it; another thread that goes on with the file calls it before.
void prepare_thread();

/// An owned identifier of the library; closed with the object.
class Id {
 public:
  Id() = default;
  explicit Id(std::int64_t value) : value_(value) {}
  Id(Id&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Id& operator=(Id&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Id() { close(); }

  std::int64_t get() const { return value_; }
  bool valid() const { return value_ >= 0; }
  /// Closes now; false if the library reports an error.
  bool close();

 private:
  std::int64_t value_ = -1;
};

/// How a file is open. `append`: rows are added while other processes read; nothing can be created or removed.
/// `write` and `shorten` (taking rows away): everything reaches the disk in `close`, in an order in which a reader
/// never meets what is half done.
enum class Access { read, write, shorten, append };

/// What error messages name.
struct Origin {
  std::string file;
  Access access = Access::read;
};

/// How the rows of a data set are stored.
struct RowStorage {
  std::size_t chunk_rows = 0;  ///< 0: not in chunks
  bool compressed = false;
};

/// An open data set; its first extent grows if it was made of rows.
class DataSet {
 public:
  DataSet() = default;
  /// Asks the library for type, shape and storage.
  DataSet(Id id, Origin origin, std::string path);
  /// A set just made of no rows.
  DataSet(Id id, Origin origin, const ChannelSpec& spec, RowStorage storage);

  bool is_open() const { return id_.valid(); }
  /// All extents, the number of rows first if it grows.
  const Shape& shape() const { return shape_; }
  bool grows() const { return grows_; }
  /// How its rows are stored.
  const RowStorage& storage() const { return storage_; }
  ValueType type() const { return type_; }
  const std::string& path() const { return path_; }

  /// Adds an attribute to a set just made.
  void add_attribute(const std::string& name, const AttributeValue& value);
  /// Sets the number of rows.
  void resize(std::size_t rows);
  /// Writes one whole chunk, past the chunk cache; `row` is a multiple of the rows of a chunk; not for compressed sets.
  void write_chunk(std::size_t row, const void* values, std::size_t bytes);
  /// Writes `count` rows from `first`; 8 bytes a value.
  void write_rows(std::size_t first, std::size_t count, const void* values);
  /// Reads `count` rows from `first` in the type of the set, 8 bytes a value.
  void read_rows(std::size_t first, std::size_t count, void* values) const;
  /// The same, converted to double.
  std::vector<double> read_rows(std::size_t first, std::size_t count) const;
  /// Reads everything, row-major.
  std::vector<double> read() const { return read_rows(0, shape_.empty() ? 1 : shape_[0]); }

 private:
  void read_into(std::size_t first, std::size_t count, std::int64_t memory_type, void* values) const;
  [[noreturn]] void fail() const;

  Id id_;
  Origin origin_;
  std::string path_;
  Shape shape_;
  ValueType type_ = ValueType::float64;
  bool grows_ = false;
  RowStorage storage_;
};

/// An open file.
class File {
 public:
  File() = default;
  /// Makes a new file, in memory until `close` writes it as a whole; an existing one is overwritten. Hundreds of small
  /// objects are made several times faster so.
  static File create(const std::string& path);
  /// Opens a file. For reading: also one that is being written. For writing: also one whose writer was killed.
  static File open(const std::string& path, Access access);
  /// Moves the end that the header states to that of the file: a writer that was killed between the two has left rows
  /// beyond it.
  void own_all_bytes();

  DataSet create_rows(const ChannelSpec& spec, RowStorage storage);
  /// Makes a data set of fixed size; large ones are compressed unless they are to be overwritten in place.
  DataSet create_fixed(const FixedArray& array, bool overwritten = false);
  /// Removes a data set if there is one.
  void remove(const std::string& path);
  /// Opens a set of rows that is known to be as `create_rows` made it, without asking the library for its shape.
  DataSet open_rows(const ChannelSpec& spec, RowStorage storage) const;
  /// Opens a data set of numbers; throws if there is none.
  DataSet data_set(const std::string& path) const;
  /// Paths of all data sets of numbers below a group, without leading slash, sorted.
  std::vector<std::string> data_sets(const std::string& group = {}) const;
  bool contains(const std::string& path) const;

  /// Sets an attribute, replacing an older one; makes the group `object` if there is no such object.
  void set_attribute(const Attribute& attribute);
  /// An attribute of `object` (empty: the file), or nothing if there is none of a known type.
  std::optional<AttributeValue> attribute(const std::string& object, const std::string& name) const {
    for (Attribute& attribute : attributes(object)) {
      if (attribute.name == name) return std::move(attribute.value);
    }
    return {};
  }
  /// All attributes of a known type of `object`, sorted by name.
  std::vector<Attribute> attributes(const std::string& object) const;

  void flush();
  /// Closes after all its data sets; throws EnvironmentError if what is buffered cannot be written.
  void close();
  /// From here on nothing reaches the disk, which has failed: the file stays as after the last flush. Close it next.
  void abandon();

 private:
  explicit File(Origin origin);
  std::int64_t check(std::int64_t result, const std::string& object) const;

  Id id_;
  Origin origin_;
  Id links_;            ///< properties that make missing groups on the way
  Id rows_access_;      ///< properties that do without a chunk cache
  Id groups_creation_;  ///< properties of new groups
  /// The group that a new object belongs to, made if it is missing, and the object's own name there.
  std::pair<std::int64_t, const char*> place_of(const std::string& path);

  std::map<std::string, Id> groups_;  ///< open groups of a file in memory
  bool in_memory_ = false;
};

}  // namespace muldi::results::hdf5
