#pragma once
/// Overrides of scene entries: `--set path.to[2].key=value`.
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.hpp"
#include "scene/node.hpp"

namespace muldi::scene {

/// Sets the entry that `override` names to its value (YAML), making maps on the way; list entries must exist, and so
/// must the body, control, ... into which a path leads where the scene has others: a new one is set as a whole. Unknown
/// keys are found by the reader afterwards. `source` is put into the marks.
void apply_override(Node& root, const std::string& override, int source, std::vector<base::Diagnostic>& diagnostics);

/// What one of the named entries of a section is called, `body` of `bodies`; empty if it is no such section.
std::string_view noun_of(std::string_view section);

/// What stands for the file in messages about an override.
std::string override_name(std::string_view override);

}  // namespace muldi::scene
