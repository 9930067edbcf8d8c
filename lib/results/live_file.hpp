#pragma once
/// Keeps an HDF5 file that is being written openable by everyone, at any moment.
///
/// The library marks a file that is open for writing in its superblock and refuses to open it otherwise than with
/// SWMR; the mark survives a killed process. Here the mark is removed after every flush and writers are kept apart by a
/// file lock instead, which dies with its process. The superblock is also made to claim some room beyond the end, so
/// that blocks written between two flushes lie inside the file it describes.
/// Layout of the superblock: HDF5 File Format Specification 3.0, section II.A (versions 2 and 3).
#include <cstdint>
#include <optional>
#include <string>

namespace muldi::results {

/// What matters here of the first 48 bytes of an HDF5 file.
struct Superblock {
  bool marked = false;              ///< marked as open for writing
  bool swmr = false;                ///< of these, the files that SWMR readers may open
  std::uint64_t end_of_file = 0;    ///< bytes that the file claims to have
  std::uint64_t bytes_on_disk = 0;  ///< bytes that it has
};

/// Throws InputError if nobody is writing the file and it has fewer bytes than it claims, or a mark that keeps all
/// readers out.
void check_whole(const std::string& path);

/// Removes the mark that a killed writer has left; does nothing to other files. Throws InputError if the writer lives,
/// EnvironmentError if the file cannot be written.
void remove_stale_mark(const std::string& path);

/// The superblock of a file, or nothing if the file is no HDF5 file, has an older format or a damaged superblock.
std::optional<Superblock> read_superblock(const std::string& path);

/// An open descriptor and a shared lock on a file under recording.
class LiveFile {
 public:
  LiveFile() = default;
  /// Locks the file; throws EnvironmentError if it cannot be opened, InputError if another process writes it.
  explicit LiveFile(const std::string& path);
  LiveFile(LiveFile&& other) noexcept;
  LiveFile& operator=(LiveFile&& other) noexcept;
  ~LiveFile();

  /// Removes the mark and claims `room` bytes (sparse) beyond the end. Throws EnvironmentError.
  void open_to_readers(std::uint64_t room);
  /// True while a process records into the file.
  static bool is_live(const std::string& path);

 private:
  int descriptor_ = -1;
  std::string path_;
};

}  // namespace muldi::results
