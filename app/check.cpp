/// `check --derivatives`: a table of all derivatives of a scene with their errors.
#include <cstdio>

#include "app/exit_code.hpp"
#include "app/run_output.hpp"
#include "app/verbs.hpp"
#include "base/text.hpp"
#include "pipeline/check_derivatives.hpp"
#include "scene/read_scene.hpp"

namespace muldi::app {

int check_derivatives(const std::string& path, const std::vector<std::string>& overrides) {
  const scene::Scene scene = scene::read_scene(path, overrides);
  print(scene.warnings);
  const build::BuiltModel built = build::build_model(scene);
  print(built.notes);
  const auto found = pipeline::check_derivatives(scene, built);
  std::size_t n_wrong = 0;
  std::string text = base::format("{:72} {:>10} {:>8}\n", "derivative", "error", "slope");
  for (const pipeline::CheckedDerivative& one : found) {
    n_wrong += one.passed ? 0 : 1;
    text += base::format("{:72} {:10.2e} {:8.3f}{}\n", one.of, one.error, one.slope, one.passed ? "" : "  WRONG");
  }
  text += base::format("{} derivatives, {} wrong\n", found.size(), n_wrong);
  std::fputs(text.c_str(), stdout);
  return n_wrong == 0 ? ExitCode::success : ExitCode::numerics_failed;
}

}  // namespace muldi::app
