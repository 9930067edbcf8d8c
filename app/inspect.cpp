/// The verbs that only look: compare, info, schema.
#include <cstdio>

#include "app/exit_code.hpp"
#include "app/verbs.hpp"
#include "base/build_info.hpp"
#include "base/text.hpp"
#include "results/info.hpp"
#include "scene/read_scene.hpp"
#include "scene/reference.hpp"
#include "scene/study.hpp"

namespace muldi::app {

int compare(const std::string& first, const std::string& second, const results::CompareOptions& options) {
  const results::Comparison comparison = results::compare(first, second, options);
  std::fputs(results::to_text(comparison).c_str(), stdout);
  return comparison.same() ? ExitCode::success : ExitCode::differs;
}

int info(const std::string& file) {
  std::fputs(results::info(file).c_str(), stdout);
  return ExitCode::success;
}

int schema(bool of_studies, bool markdown) {
  std::fputs((of_studies ? scene::study_schema_text()
              : markdown ? scene::reference_text()
                         : scene::schema_text())
                 .c_str(),
             stdout);
  return ExitCode::success;
}

std::string version_text() {
  const base::BuildInfo& build = base::build_info();
  std::string text =
      base::format("muldi-sim {} ({})\n{}\n{}\n", build.version, build.commit, build.compiler, build.flags);
  for (const base::LibraryVersion& library : build.libraries)
    text += base::format("{} {}\n", library.name, library.version);
  text.pop_back();
  return text;
}

}  // namespace muldi::app
