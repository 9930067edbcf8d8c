#pragma once
/// Who writes a file: a lock that dies with its process, where the library has a mark that survives it.
///
/// Our own files never carry the mark (unmarked_driver.hpp). Those of other writers may, if they were killed.
#include <string>

namespace muldi::results {

/// Throws InputError if nobody is writing the file and it has fewer bytes than it claims, or a mark that keeps all
/// readers out.
void check_whole(const std::string& path);

/// Throws InputError if the file holds nothing: its writer is just making it, or was killed before it was made.
void check_begun(const std::string& path);

/// Removes the mark that a killed writer has left; does nothing to other files. Throws InputError if the writer lives,
/// EnvironmentError if the file cannot be written.
void remove_stale_mark(const std::string& path);

/// An open descriptor and a shared lock on a file under recording.
class LiveFile {
 public:
  LiveFile() = default;
  /// Locks the file; throws EnvironmentError if it cannot be opened, InputError if another process writes it.
  explicit LiveFile(const std::string& path);
  LiveFile(LiveFile&& other) noexcept;
  LiveFile& operator=(LiveFile&& other) noexcept;
  ~LiveFile();

  /// True while a process records into the file.
  static bool is_live(const std::string& path);

 private:
  int descriptor_ = -1;
  std::string path_;
};

}  // namespace muldi::results
