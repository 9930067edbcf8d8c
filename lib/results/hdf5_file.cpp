#include "results/hdf5_file.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "base/error.hpp"
#include "base/special_file.hpp"
#include "results/hdf5_attribute.hpp"
#include "results/live_file.hpp"
#include "results/unmarked_driver.hpp"

namespace muldi::results::hdf5 {
namespace {

constexpr std::size_t compress_from_bytes = std::size_t{64} << 10;
constexpr std::size_t fixed_chunk_bytes = std::size_t{1} << 20;
constexpr unsigned deflate_level = 1;        // after the shuffle filter higher levels gain little and cost much
constexpr unsigned most_compact_links = 64;  // groups of fewer links are made and searched faster without an index
constexpr unsigned most_compact_attributes = 60000;
// Makes the header of the root group as large as the first page, which reaches the disk in one piece: what `close` puts
// down there appears all at once.
constexpr unsigned links_in_first_page = 71, link_name_bytes = 40;
constexpr std::size_t max_rank = 8;
constexpr unsigned swmr_attempts = 20;  // one millisecond in all

/// The innermost entry of the library's error stack, reduced to the operating system's words where it has them.
std::string reason() {
  std::string text;
  const auto take_first = [](unsigned, const H5E_error2_t* entry, void* out) -> herr_t {
    auto& result = *static_cast<std::string*>(out);
    if (result.empty() && entry->desc != nullptr) result = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &text);
  constexpr std::string_view mark = "error message = '";
  if (const auto begin = text.find(mark); begin != std::string::npos) {
    const auto end = text.find('\'', begin + mark.size());
    return text.substr(begin + mark.size(), end - begin - mark.size());
  }
  return text.empty() ? "unknown error" : text;
}

[[noreturn]] void fail_on(const Origin& origin, const std::string& object) {
  const std::string what = "'" + origin.file + "'" + (object.empty() ? "" : " (/" + object + ")") + ": " + reason();
  if (origin.access != Access::read) throw base::EnvironmentError("cannot write " + what);
  throw base::InputError("cannot read " + what);
}

/// The name of an object as the library takes it: the file itself is its root group.
const char* name_of(const std::string& object) { return object.empty() ? "/" : object.c_str(); }

/// Values on disk are little-endian of 8 bytes.
hid_t file_type(ValueType type) { return type == ValueType::float64 ? H5T_IEEE_F64LE : H5T_STD_I64LE; }
hid_t memory_type(ValueType type) { return type == ValueType::float64 ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64; }

/// Latest format (SWMR needs it), values written in place without a detour, no locks of the library: LiveFile has them.
Id access_properties(Access access) {
  prepare_thread();
  Id properties(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_libver_bounds(properties.get(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  H5Pset_sieve_buf_size(properties.get(), 0);
  H5Pset_file_locking(properties.get(), false, true);
  if (access == Access::read) set_reading_driver(properties.get());
  if (access == Access::append) set_driver(properties.get(), {Writing::Order::at_once});
  if (access == Access::write) set_driver(properties.get(), {Writing::Order::highest_first});
  if (access == Access::shorten) set_driver(properties.get(), {Writing::Order::lowest_first});
  return properties;
}

/// Missing groups of a path are made on the way.
Id link_properties() {
  Id properties(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(properties.get(), 1);
  return properties;
}

/// Properties of groups (of the file: its root group) of a few links and attributes, kept in the header of the group:
/// found faster than in an index, and changed in one piece.
Id compact(Id properties) {
  H5Pset_link_phase_change(properties.get(), most_compact_links, most_compact_links - 1);
  H5Pset_attr_phase_change(properties.get(), most_compact_attributes, most_compact_attributes - 1);
  return properties;
}

using Extents = std::array<hsize_t, max_rank>;

Extents extents_of(const Shape& shape, std::size_t first) {
  Extents extents{};
  std::ranges::copy(shape, extents.begin());
  extents[0] = first;
  return extents;
}

Id space_of(const Shape& shape, const hsize_t* maximum = nullptr) {
  if (shape.empty()) return Id(H5Screate(H5S_SCALAR));
  return Id(H5Screate_simple(static_cast<int>(shape.size()), extents_of(shape, shape[0]).data(), maximum));
}

void compress(const Id& properties) {
  H5Pset_shuffle(properties.get());
  H5Pset_deflate(properties.get(), deflate_level);
}

/// File and memory selections of some rows; a scalar is its own row.
std::pair<Id, Id> select_rows(const Id& data_set, const Shape& shape, std::size_t first, std::size_t rows) {
  if (shape.empty()) return {Id(H5Screate(H5S_SCALAR)), Id(H5Screate(H5S_SCALAR))};
  const Extents start{first}, extents = extents_of(shape, rows);
  Id file(H5Dget_space(data_set.get()));
  H5Sselect_hyperslab(file.get(), H5S_SELECT_SET, start.data(), nullptr, extents.data(), nullptr);
  return {std::move(file), Id(H5Screate_simple(static_cast<int>(shape.size()), extents.data(), nullptr))};
}

}  // namespace

/// The library's cleanup at exit would trip over a file that could not be closed for want of space; ours are closed by
/// their owners.
void prepare_thread() {
  static const bool once = H5dont_atexit() >= 0;
  thread_local const bool silent = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  static_cast<void>(once), static_cast<void>(silent);
}

std::string library_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(release);
}

bool Id::close() {
  if (value_ < 0) return true;
  return H5Idec_ref(std::exchange(value_, -1)) >= 0;
}

DataSet::DataSet(Id id, Origin origin, std::string path)
    : id_(std::move(id)), origin_(std::move(origin)), path_(std::move(path)) {
  const Id space(H5Dget_space(id_.get()));
  const Id type(H5Dget_type(id_.get()));
  const int rank = space.valid() ? H5Sget_simple_extent_ndims(space.get()) : -1;
  if (rank < 0 || rank > static_cast<int>(max_rank) || !type.valid()) fail();
  Extents extents{}, maximum{};
  H5Sget_simple_extent_dims(space.get(), extents.data(), maximum.data());
  shape_.assign(extents.begin(), extents.begin() + rank);
  grows_ = rank > 0 && maximum[0] == H5S_UNLIMITED;
  type_ = H5Tget_class(type.get()) == H5T_INTEGER ? ValueType::int64 : ValueType::float64;
  const Id creation(H5Dget_create_plist(id_.get()));
  if (H5Pget_layout(creation.get()) == H5D_CHUNKED) {
    H5Pget_chunk(creation.get(), rank, extents.data());
    storage_ = {static_cast<std::size_t>(extents[0]), H5Pget_nfilters(creation.get()) > 0};
  }
}

DataSet::DataSet(Id id, Origin origin, const ChannelSpec& spec, RowStorage storage)
    : id_(std::move(id)),
      origin_(std::move(origin)),
      path_(spec.path),
      shape_{0},
      type_(spec.type),
      grows_(true),
      storage_(storage) {
  shape_.insert(shape_.end(), spec.shape.begin(), spec.shape.end());
}

void DataSet::fail() const { fail_on(origin_, path_); }
void DataSet::add_attribute(const std::string& name, const AttributeValue& value) {
  if (!write_attribute(id_, name, value)) fail();
}

void DataSet::resize(std::size_t rows) {
  if (H5Dset_extent(id_.get(), extents_of(shape_, rows).data()) < 0) fail();
  shape_[0] = rows;
}

void DataSet::write_chunk(std::size_t row, const void* values, std::size_t bytes) {
  const Extents offset{row};
  if (H5Dwrite_chunk(id_.get(), H5P_DEFAULT, 0, offset.data(), bytes, values) < 0) fail();
}

void DataSet::write_rows(std::size_t first, std::size_t count, const void* values) {
  const auto [file, memory] = select_rows(id_, shape_, first, count);
  if (H5Dwrite(id_.get(), memory_type(type_), memory.get(), file.get(), H5P_DEFAULT, values) < 0) fail();
}

void DataSet::read_into(std::size_t first, std::size_t count, std::int64_t memory_type, void* values) const {
  if (count == 0 || muldi::results::count(shape_) == 0) return;
  const auto [file, memory] = select_rows(id_, shape_, first, count);
  if (H5Dread(id_.get(), memory_type, memory.get(), file.get(), H5P_DEFAULT, values) < 0) fail();
}

void DataSet::read_rows(std::size_t first, std::size_t count, void* values) const {
  read_into(first, count, memory_type(type_), values);
}

std::vector<double> DataSet::read_rows(std::size_t first, std::size_t rows) const {
  std::vector<double> values(rows * (shape_.empty() ? 1 : count({shape_.begin() + 1, shape_.end()})));
  read_into(first, rows, H5T_NATIVE_DOUBLE, values.data());
  return values;
}

std::int64_t File::check(std::int64_t result, const std::string& object) const {
  if (result < 0) fail_on(origin_, object);
  return result;
}

File::File(Origin origin)
    : origin_(std::move(origin)),
      links_(link_properties()),
      rows_access_(H5Pcreate(H5P_DATASET_ACCESS)),
      groups_creation_(compact(Id(H5Pcreate(H5P_GROUP_CREATE)))) {
  H5Pset_chunk_cache(rows_access_.get(), 1, 0, 1.0);
}

File File::create(const std::string& path) {
  const Id access = access_properties(Access::write);
  File file({path, Access::write});
  file.in_memory_ = true;
  const Id creation = compact(Id(H5Pcreate(H5P_FILE_CREATE)));
  H5Pset_est_link_info(creation.get(), links_in_first_page, link_name_bytes);
  file.id_ = Id(file.check(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), ""));
  return file;
}

File File::open(const std::string& path, Access access) {
  const Id properties = access_properties(access);
  File file({path, access});
  const unsigned write = H5F_ACC_RDWR | (access == Access::append ? H5F_ACC_SWMR_WRITE : 0U);
  if (access != Access::read) {
    file.id_ = Id(file.check(H5Fopen(path.c_str(), write, properties.get()), ""));
    return file;
  }
  if (base::is_special_file(path)) throw base::InputError("cannot read '" + path + "': not a regular file");
  check_begun(path);
  if (H5Fis_hdf5(path.c_str()) == 0) throw base::InputError("cannot read '" + path + "': not an HDF5 file");
  check_whole(path);
  // The library doubles its wait between two attempts: its default of 100 would never end on a damaged file.
  H5Pset_metadata_read_attempts(properties.get(), swmr_attempts);
  const unsigned swmr = H5F_ACC_RDONLY | H5F_ACC_SWMR_READ;
  // Plain readers are kept out where the writer was killed at a bad moment; SWMR readers of an older format.
  file.id_ = Id(H5Fopen(path.c_str(), swmr, properties.get()));
  if (!file.id_.valid()) file.id_ = Id(file.check(H5Fopen(path.c_str(), H5F_ACC_RDONLY, properties.get()), ""));
  return file;
}

void File::own_all_bytes() { check(H5Fincrement_filesize(id_.get(), 0), ""); }

std::pair<std::int64_t, const char*> File::place_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (!in_memory_ || slash == std::string::npos) return {id_.get(), path.c_str()};
  const std::string own = path.substr(0, slash);
  Id& group = groups_[own];
  if (!group.valid()) {
    const auto [parent, name] = place_of(own);
    group = Id(check(H5Gcreate2(parent, name, H5P_DEFAULT, groups_creation_.get(), H5P_DEFAULT), own));
  }
  return {group.get(), path.c_str() + slash + 1};
}

DataSet File::create_rows(const ChannelSpec& spec, RowStorage storage) {
  Shape shape{0};
  shape.insert(shape.end(), spec.shape.begin(), spec.shape.end());
  const Id space = space_of(shape, extents_of(shape, H5S_UNLIMITED).data());
  const Id creation(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_obj_track_times(creation.get(), false);
  H5Pset_chunk(creation.get(), static_cast<int>(shape.size()), extents_of(shape, storage.chunk_rows).data());
  if (storage.compressed) compress(creation);
  if (!storage.compressed) H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER);  // whole chunks are written
  const auto [group, name] = place_of(spec.path);
  Id id(check(H5Dcreate2(group, name, file_type(spec.type), space.get(), links_.get(), creation.get(),
                         storage.compressed ? H5P_DEFAULT : rows_access_.get()),
              spec.path));
  return DataSet(std::move(id), origin_, spec, storage);
}

DataSet File::create_fixed(const FixedArray& array, bool overwritten) {
  const FixedSpec& spec = array.spec;
  const Id space = space_of(spec.shape);
  const Id creation(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_obj_track_times(creation.get(), false);
  const std::size_t bytes = count(spec.shape) * sizeof(double);
  if (bytes >= compress_from_bytes && !overwritten) {
    const std::size_t rows = std::clamp<std::size_t>(fixed_chunk_bytes * spec.shape[0] / bytes, 1, spec.shape[0]);
    H5Pset_chunk(creation.get(), static_cast<int>(spec.shape.size()), extents_of(spec.shape, rows).data());
    compress(creation);
  }
  const hid_t on_disk = file_type(array.type);
  const auto [group, name] = place_of(spec.path);
  Id id(check(H5Dcreate2(group, name, on_disk, space.get(), links_.get(), creation.get(), H5P_DEFAULT), spec.path));
  const hid_t type = memory_type(array.type);
  if (bytes > 0) check(H5Dwrite(id.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values()), spec.path);
  return DataSet(std::move(id), origin_, spec.path);
}

void File::remove(const std::string& path) {
  if (contains(path)) check(H5Ldelete(id_.get(), path.c_str(), H5P_DEFAULT), path);
}

DataSet File::open_rows(const ChannelSpec& spec, RowStorage storage) const {
  const std::int64_t access = storage.compressed ? H5P_DEFAULT : rows_access_.get();
  return DataSet(Id(check(H5Dopen2(id_.get(), spec.path.c_str(), access), spec.path)), origin_, spec, storage);
}

DataSet File::data_set(const std::string& path) const {
  return DataSet(Id(check(H5Dopen2(id_.get(), path.c_str(), H5P_DEFAULT), path)), origin_, path);
}

std::vector<std::string> File::data_sets(const std::string& group) const {
  std::vector<std::string> paths;
  const auto visit = [](hid_t root, const char* name, const H5O_info_t* info, void* out) -> herr_t {
    if (info->type != H5O_TYPE_DATASET) return 0;
    const Id id(H5Dopen2(root, name, H5P_DEFAULT));
    if (!id.valid()) return -1;
    const Id type(H5Dget_type(id.get()));
    const H5T_class_t kind = H5Tget_class(type.get());
    if (kind == H5T_INTEGER || kind == H5T_FLOAT) static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  const Id root(check(H5Gopen2(id_.get(), name_of(group), H5P_DEFAULT), group));
  check(H5Ovisit2(root.get(), H5_INDEX_NAME, H5_ITER_NATIVE, visit, &paths, H5O_INFO_BASIC), group);
  for (std::string& path : paths) path.insert(0, group.empty() ? group : group + "/");
  std::ranges::sort(paths);
  return paths;
}

bool File::contains(const std::string& path) const {
  // Every group on the way is asked for: the library answers for the last link only.
  for (std::size_t end = path.find('/');; end = path.find('/', end + 1)) {
    if (H5Lexists(id_.get(), path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

void File::set_attribute(const Attribute& attribute) {
  const auto& [object, name, value] = attribute;
  if (!object.empty() && !contains(object)) {
    const Id group(
        check(H5Gcreate2(id_.get(), object.c_str(), links_.get(), groups_creation_.get(), H5P_DEFAULT), object));
  }
  const Id owner(check(H5Oopen(id_.get(), name_of(object), H5P_DEFAULT), object));
  if (H5Aexists(owner.get(), name.c_str()) > 0) check(H5Adelete(owner.get(), name.c_str()), object);
  check(write_attribute(owner, name, value) ? 0 : -1, object);
}

std::vector<Attribute> File::attributes(const std::string& object) const {
  std::vector<Attribute> result;
  if (!object.empty() && !contains(object)) return result;
  const Id owner(check(H5Oopen(id_.get(), name_of(object), H5P_DEFAULT), object));
  const auto visit = [](hid_t holder, const char* name, const H5A_info_t*, void* out) -> herr_t {
    const Id id(H5Aopen(holder, name, H5P_DEFAULT));
    if (!id.valid()) return -1;
    auto value = read_attribute(id);
    if (value) static_cast<std::vector<Attribute>*>(out)->push_back({{}, name, std::move(*value)});
    return 0;
  };
  check(H5Aiterate2(owner.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &result), object);
  for (Attribute& attribute : result) attribute.object = object;
  return result;
}

void File::flush() { check(H5Fflush(id_.get(), H5F_SCOPE_GLOBAL), ""); }
void File::close() {
  groups_.clear();
  if (!id_.close()) fail_on(origin_, "");
}

void File::abandon() {
  void* handle = nullptr;
  if (id_.valid() && H5Fget_vfd_handle(id_.get(), H5P_DEFAULT, &handle) >= 0) hdf5::abandon(handle);
}

}  // namespace muldi::results::hdf5
