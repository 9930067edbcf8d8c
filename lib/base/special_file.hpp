#pragma once
/// Devices, pipes and sockets in place of files: results are read and written at any place of a file, and none of these
/// ends.
#include <string>

namespace muldi::base {

/// Whether something other than a file or a folder is at the path.
bool is_special_file(const std::string& path);

/// Throws EnvironmentError with the reason where a file cannot be written at the path: before work is done whose result
/// would be lost. Devices, pipes and sockets are refused too.
void refuse_unwritable_output(const std::string& path);

/// Throws EnvironmentError unless the path is that of a file, or of none yet; folders say so themselves.
void refuse_special_output(const std::string& path);

}  // namespace muldi::base
