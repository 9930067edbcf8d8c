#include "base/special_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "base/error.hpp"

namespace muldi::base {

bool is_special_file(const std::string& path) {
  std::error_code none;
  return std::filesystem::is_other(path, none);
}

void refuse_special_output(const std::string& path) {
  if (is_special_file(path)) throw EnvironmentError("cannot write '" + path + "': not a regular file");
}

void refuse_unwritable_output(const std::string& path) {
  refuse_special_output(path);
  std::error_code none;
  const bool exists = std::filesystem::exists(path, none);
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  // With a point at the end only a folder is one.
  const std::string asked = exists ? path : (folder.empty() ? std::filesystem::path(".") : folder / ".").string();
  if (::access(asked.c_str(), exists ? W_OK : W_OK | X_OK) == 0) return;
  throw EnvironmentError("cannot write '" + path + "': " + std::strerror(errno));
}

}  // namespace muldi::base
