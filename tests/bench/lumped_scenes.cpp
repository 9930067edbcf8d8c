/// Lumped scenes: stepping alone and in all, against the times that the project asks for.
#include "bench/bench_report.hpp"
#include "bench/scene_runs.hpp"

int main() {
  using namespace muldi;
  bench::BenchReport report("lumped_scenes");

  const std::vector<std::string> every_row{"record.every=1"};
  const double trunk_all =
      bench::median_seconds(5, [&] { bench::run_to_file(bench::scene_path("elephant_trunk_lumped"), every_row); });
  report.add({"trunk, 10 000 steps, every row in HDF5, in all", trunk_all, "s", 1.0});
  const bench::ReadyScene trunk(scene::read_scene(bench::scene_path("elephant_trunk_lumped")));
  variational::LoopStatistics statistics;
  const double trunk_steps = bench::median_seconds(5, [&] { statistics = trunk.step("auto"); });
  report.add({"trunk, stepping alone", trunk_steps, "s"});
  report.add({"trunk, one step", 1e6 * trunk_steps / static_cast<double>(statistics.steps), "us"});
  report.add({"trunk, Newton iterations a step",
              static_cast<double>(statistics.iterations) / static_cast<double>(statistics.steps), "1"});
  report.add({"trunk, dense joint space over tree",
              bench::median_seconds(3, [&] { trunk.step("dense"); }) / trunk_steps, "1"});

  const bench::ReadyScene joint(scene::read_scene(bench::scene_path("revolute_joint_lumped")));
  report.add(
      {"joint, 1000 steps, stepping alone", 1e3 * bench::median_seconds(11, [&] { joint.step("auto"); }), "ms", 10.0});
  const bench::ReadyScene membrane(scene::read_scene(bench::scene_path("membrane_lumped")));
  report.add(
      {"membrane, 500 steps, stepping alone", 1e3 * bench::median_seconds(11, [&] { membrane.step("auto"); }), "ms"});
  const bench::ReadyScene four_bar(scene::read_scene(bench::scene_path("four_bar")));
  report.add(
      {"four-bar, 1000 steps, stepping alone", 1e3 * bench::median_seconds(11, [&] { four_bar.step("auto"); }), "ms"});
  report.print();
}
