#pragma once
/// The scene format as a page to read.
#include <string>

namespace muldi::scene {

/// schemas/SCENE.md: every key with meaning, kind, unit, range, default and need, and every word of every choice, from
/// the descriptions that the reader follows; ends with a newline.
std::string reference_text();

}  // namespace muldi::scene
