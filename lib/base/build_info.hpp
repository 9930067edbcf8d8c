#pragma once
/// What this build is: for `--version` and the provenance of records.
#include <array>
#include <string_view>

namespace muldi::base {

/// A library that the program was built with; an empty version means that the library does not tell.
struct LibraryVersion {
  std::string_view name;
  std::string_view version;
};

struct BuildInfo {
  std::string_view version;   ///< of the program, e.g. `0.1.0`
  std::string_view commit;    ///< git hash, with `-dirty` if files differed from it; `unknown` outside a clone
  std::string_view compiler;  ///< name and version, e.g. `GNU 12.2.0`
  std::string_view flags;     ///< compiler options without warnings and include paths
  std::array<LibraryVersion, 8> libraries;
};

/// Facts of the build; the commit is that of the last build of anything.
const BuildInfo& build_info();

}  // namespace muldi::base
