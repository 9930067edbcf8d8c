#include "base/special_file.hpp"

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

}  // namespace muldi::base
