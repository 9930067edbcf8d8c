/// Newton's iteration in every shipped scene of bodies and muscles: a handful of iterations, which only a quadratic end
/// gives (numerics 5 no. 2).
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "golden/scene_run.hpp"
#include "support/figure.hpp"

namespace muldi::golden {
namespace {

/// Scenes with motions and without finite elements, whose steps have exact tangents.
std::vector<std::string> scenes_of_bodies() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(MULDI_SOURCE_DIR) + "/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    const std::string name = entry.path().stem().string();
    const scene::Scene scene = shipped(name);
    const bool meshed = std::any_of(scene.muscles.begin(), scene.muscles.end(),
                                    [](const auto& muscle) { return scene::is_meshed(muscle.value); });
    if (scene.dynamics && scene.solids.empty() && !meshed) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

TEST(Newton, EndsInAHandfulOfIterationsInEveryScene) {
  int largest = 0;
  int n_scenes = 0;
  for (const std::string& name : scenes_of_bodies()) {
    scene::Scene scene = shipped(name, {"solver.tolerance=1e-12"});
    scene.dynamics->duration = 50.0 * scene.dynamics->step;
    scene.record.every = 1;
    const SceneRun run(std::move(scene));
    ASSERT_TRUE(run.outcome().completed()) << name << ": " << run.outcome().sentence;
    const auto iterations = run.iterations();
    const int most = static_cast<int>(*std::max_element(iterations.begin(), iterations.end()));
    std::cout << name << ": " << most << '\n';
    largest = std::max(largest, most);
    ++n_scenes;
  }
  test::record_at_least("2", "scenes of bodies and muscles whose Newton iteration was watched", n_scenes, 10);
  // From 1e-1 by squares: 1e-2, 1e-4, 1e-8, 1e-16, and one that sees it.
  test::record_figure("2", "most iterations of a step in any scene of bodies and muscles", largest, 6);
}

}  // namespace
}  // namespace muldi::golden
