/// Scenes, with whatever YAML does to them: what is read must read back from its resolved text to an equal scene.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "base/error.hpp"
#include "fuzz/target.hpp"
#include "scene/read_scene.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace muldi;
  // The folder does not exist: a scene that names files of tables is refused.
  const std::string name = "no_such_folder/scene.yaml";
  std::string resolved;
  scene::Scene read;
  try {
    read = scene::read_scene_text(fuzz::as_text(bytes, size), name);
    resolved = scene::resolved_text(read);
  } catch (const base::InputError&) {
    return 0;
  }
  try {
    if (scene::resolved_text(scene::read_scene_text(resolved, name)) == resolved) return 0;
    std::fputs("the resolved text reads back to another scene\n", stderr);
  } catch (const base::InputError& error) {
    std::fprintf(stderr, "the resolved text is refused: %s\n%s\n", error.what(), resolved.c_str());
  }
  std::abort();
}
