#pragma once
/// Text files of bounded size.
#include <string>

namespace muldi::scene {

/// The content of a file, or the reason why it cannot be read.
struct InputFile {
  std::string text;
  std::string error;  ///< empty if the file was read
};

/// Reads a whole file; files larger than `largest_input` are refused unread.
InputFile read_input_file(const std::string& path);

}  // namespace muldi::scene
