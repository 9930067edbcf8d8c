#include "scene/input_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "base/text.hpp"
#include "scene/yaml.hpp"

namespace muldi::scene {

InputFile read_input_file(const std::string& path) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) return {.text = {}, .error = "it is a folder"};
  std::ifstream file(path, std::ios::binary);
  if (!file) return {.text = {}, .error = std::strerror(errno)};
  const auto size = std::filesystem::file_size(path, code);
  if (!code && size > largest_input) return {.text = {}, .error = too_large(size)};
  // One byte more than allowed tells endless files (pipes, devices) from large ones.
  std::string text(code ? largest_input + 1 : static_cast<std::size_t>(size), '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > largest_input) return {.text = {}, .error = too_large(text.size())};
  return {.text = std::move(text), .error = {}};
}

InputFile read_named_file(const std::string& path) {
  std::error_code code;
  if (std::filesystem::exists(path, code) && !std::filesystem::is_regular_file(path, code) &&
      !std::filesystem::is_directory(path, code))
    return {.text = {}, .error = "it is a device or a pipe"};
  return read_input_file(path);
}

std::string why_not_in_folder(std::string_view file) {
  if (file.empty()) return "needs the name of a file";
  if (file.front() == '/') return "needs a path from the scene's folder, got " + base::in_quotes(file);
  for (std::string_view rest = file; !rest.empty();) {
    const std::size_t slash = rest.find('/');
    if (rest.substr(0, slash) == "..") return "must stay in the scene's folder, got " + base::in_quotes(file);
    rest.remove_prefix(slash == rest.npos ? rest.size() : slash + 1);
  }
  return {};
}

}  // namespace muldi::scene
