#pragma once
/// YAML text to located nodes; the only file pair that includes yaml-cpp.
///
/// yaml-cpp 0.7 gives the events; anchors, merge keys `<<` (shallow, a map or a list of maps), duplicate keys, cycles
/// and limits are dealt with here.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.hpp"
#include "scene/node.hpp"

namespace muldi::scene {

/// Limits on what is read, against files that are no scenes.
inline constexpr std::size_t largest_input = 16u << 20;  ///< bytes
inline constexpr std::size_t most_nodes = 1'000'000;     ///< with aliases expanded
inline constexpr std::size_t deepest_nesting = 64;

/// The one document of `text`; `source` is put into the marks, `file` into the messages. Nothing and at least one error
/// in `diagnostics` where the text is too large, no YAML, empty, or several documents. Duplicate keys are errors, too,
/// but the rest is read (the first one holds).
std::optional<Node> parse_yaml(std::string_view text, const std::string& file, int source,
                               std::vector<base::Diagnostic>& diagnostics);

/// Why an input of more than `largest_input` bytes is not read.
std::string too_large(std::size_t bytes);

}  // namespace muldi::scene
