#include "scene_run.hpp"

#include <cmath>
#include <stdexcept>

#include "base/text.hpp"
#include "pipeline/run.hpp"
#include "scene/read_scene.hpp"

namespace muldi::golden {

scene::Scene shipped(const std::string& name, const Overrides& overrides) {
  const std::string folder = name.starts_with("si/") ? "/tests/golden/" : "/scenes/";
  return scene::read_scene(MULDI_SOURCE_DIR + folder + name + ".yaml", overrides);
}

scene::Scene written_and_read(const scene::Scene& scene, const Overrides& overrides) {
  return scene::read_scene_text(scene::resolved_text(scene), "generated.yaml", overrides);
}

SceneRun::SceneRun(scene::Scene scene) : scene_(std::move(scene)), built_(build::build_model(scene_)) {
  pipeline::RunContext context;
  context.warn = [this](const std::string& sentence) { warnings_.push_back(sentence); };
  outcome_ = pipeline::run(scene_, built_, recorder_, context, {});
}

Eigen::Map<const Eigen::MatrixXd> SceneRun::rows(const std::string& path) const {
  for (const results::DeclaredChannel& channel : recorder_.declared().channels) {
    if (channel.spec.path != path) continue;
    const std::span<const double> values = recorder_.reals(path);
    const std::size_t width = results::count(channel.spec.shape);
    return {values.data(), static_cast<Eigen::Index>(width), static_cast<Eigen::Index>(values.size() / width)};
  }
  throw std::out_of_range("no channel " + path);
}

std::size_t SceneRun::n_rows(const std::string& path) const { return static_cast<std::size_t>(rows(path).cols()); }

double SceneRun::value_at(const std::string& path, double t) const {
  const auto times = rows("time");
  for (Eigen::Index i = 0; i < times.cols(); ++i) {
    if (std::abs(times(0, i) - t) <= 1e-9 * std::abs(t)) return rows(path)(0, i);
  }
  throw std::out_of_range(base::format("no node at t = {}", t));
}

double SceneRun::attribute(const std::string& object, const std::string& name) const {
  for (const results::Attribute& attribute : recorder_.late_attributes()) {
    if (attribute.object == object && attribute.name == name) return std::get<double>(attribute.value);
  }
  throw std::out_of_range("no attribute " + name + " of " + object);
}

std::vector<std::int64_t> SceneRun::iterations(const std::string& prefix) const {
  const auto values = recorder_.integers(prefix + "solver/iterations");
  return {values.begin(), values.end()};
}

std::string step_of(double step) { return "dynamics.step=" + base::number_text(step); }

}  // namespace muldi::golden
