#pragma once
/// Text files of bounded size.
#include <string>
#include <string_view>

namespace muldi::scene {

/// The content of a file, or the reason why it cannot be read.
struct InputFile {
  std::string text;
  std::string error;  ///< empty if the file was read
};

/// Reads a whole file; files larger than `largest_input` are refused unread.
InputFile read_input_file(const std::string& path);

/// The same of a file that a scene names: devices and pipes, which may never end, are refused unopened.
InputFile read_named_file(const std::string& path);

/// Why a scene may not name this file, empty if it may: scenes of strangers read nothing outside their own folder.
std::string why_not_in_folder(std::string_view file);

}  // namespace muldi::scene
