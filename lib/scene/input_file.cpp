#include "scene/input_file.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

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

}  // namespace muldi::scene
