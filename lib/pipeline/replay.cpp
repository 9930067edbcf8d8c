#include "pipeline/replay.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "build/place_bodies.hpp"
#include "multibody/joint.hpp"
#include "pipeline/loop_sentence.hpp"
#include "pipeline/step_options.hpp"
#include "pipeline/trajectory_rows.hpp"
#include "scene/read_scene.hpp"

namespace muldi::pipeline {
namespace {

using Interpolation = scene::ReplayInterpolation;

/// The scene with the muscles of the replay, checked like any scene.
scene::Scene scene_of_replay(const scene::Scene& scene) {
  const scene::Replay& said = *scene.optimal_control->replay;
  if (!said.muscles) return scene;
  scene::Scene changed = scene;
  for (auto& entry : changed.muscles) entry.value.model = *said.muscles;
  return changed == scene ? changed : scene::read_scene_text(scene::resolved_text(changed), scene.origin.place.file);
}

/// The values of a control over the horizon and what follows.
base::TimeFunction function_of(const control::Trajectory& optimum, std::size_t control, Interpolation between,
                               std::optional<double> hold) {
  const bool held = between == Interpolation::steps;
  base::Samples samples{.between = held ? base::Samples::Between::held : base::Samples::Between::linear};
  const double dt = optimum.step;
  for (std::size_t i = 0; i < optimum.u.size(); ++i) {
    samples.times.push_back((static_cast<double>(i) + (held ? 0.0 : 0.5)) * dt);
    samples.values.push_back(optimum.u[i][control]);
  }
  if (!hold) return base::TimeFunction(samples);
  const double end = static_cast<double>(optimum.u.size()) * dt;
  if (!held) {
    samples.times.push_back(end);
    samples.values.push_back(samples.values.back());
  }
  // The next step looks at its middle: far beyond this.
  samples.times.push_back(held ? end : end * (1.0 + 1e-9));
  samples.values.push_back(*hold);
  return base::TimeFunction(samples);
}

}  // namespace

void build_replay(const scene::Scene& scene) { build::build_model(scene_of_replay(scene)); }

ReplayRun::ReplayRun(const scene::Scene& scene, results::Recorder& recorder)
    : scene_(scene_of_replay(scene)), recorder_(recorder), built_(build::build_model(scene_)) {
  const scene::OptimalControl& said = *scene_.optimal_control;
  const double coarse = said.duration.max / said.n_steps();
  step_ = said.replay->step.value_or(coarse);
  fine_ = std::max(1L, std::lround(std::ceil(coarse / step_ - 1e-9)));
  if (said.replay->then) n_beyond_ = std::max(1L, std::lround(said.replay->then->duration / step_));
  deviations_.beyond = n_beyond_ > 0;
  rows_.emplace(recorder_, scene_, built_, NodeRows::Kind::replay,
                static_cast<std::size_t>((said.n_steps() * fine_ + n_beyond_) / scene_.record.every + 2));
  for (std::size_t j = 0; j < scene_.joints.size(); ++j) {
    const multibody::TreeLink* link = built_.link_of_joint(j);
    if (link == nullptr) continue;
    const auto kinds = scene_.joints[j].value.coordinates();
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      const std::string number = kinds.size() > 1 ? base::format("_{}", k + 1) : std::string();
      watched_.push_back({.rate = link->first_rate + static_cast<int>(k), .point = {}});
      deviations_.all.push_back(
          {.name = "joints/" + scene_.joints[j].name + number, .is_angle = kinds[k] == scene::Coordinate::angle});
    }
  }
  const auto watch_point = [&](const scene::RecordedPoint& point) {
    const std::string name = "points/" + point.body.name + "." + point.point.name;
    for (const Deviation& known : deviations_.all) {
      if (known.name == name) return;
    }
    const int body = build::body_index(scene_, point.body.name);
    watched_.push_back({.rate = -1, .point = multibody::body_point(body, build::to_eigen(point.point.position))});
    deviations_.all.push_back({.name = name});
  };
  for (const scene::RecordedPoint& point : scene_.record.points) watch_point(point);
  for (const auto& item : said.final.end.pose.points.items) watch_point(item.point);
}

void ReplayRun::set_controls(const control::Trajectory& optimum) {
  const scene::OptimalControl& said = *scene_.optimal_control;
  for (const auto& entry : said.controls) {
    const auto c = static_cast<std::size_t>(scene_.controls.index(entry.name));
    std::optional<double> hold;
    if (said.replay->then) {
      const auto* held = said.replay->then->controls.find(entry.name);
      hold = held != nullptr ? held->value.value : optimum.u.back()[c];
    }
    built_.model->controls[c].function = function_of(optimum, c, said.replay->interpolation, hold);
  }
}

void ReplayRun::start(const control::Trajectory& optimum, const Eigen::VectorXd& rates,
                      variational::State& state) const {
  const model::Model& model = *built_.model;
  const model::Manifold& manifold = *built_.manifold;
  state.x = optimum.x.front();
  state.q = Eigen::VectorXd::Zero(model.n_q());
  state.y = Eigen::VectorXd::Zero(model.n_y());
  manifold.configuration(state.x, state.q);
  for (const auto& part : model.substructures) part->start(state.q, state.y);
  const auto frame = manifold.make_frame();
  manifold.update(state.x, state.q, *frame);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(model.n_q());
  manifold.lift(*frame, rates, v);
  std::vector<double> u(model.controls.size());
  model.evaluate_controls(0.5 * step_, u);
  variational::NodeEvaluator(model, built_.linear, built_.solid_linear).momentum_of(state.q, v, u, state.p);
  state.increment = step_ * rates;
  state.multipliers = Eigen::VectorXd::Zero(manifold.n_loop_rows());
  if (!model.substructures.empty()) state.advance = step_ * v;
}

Outcome ReplayRun::run(const control::Trajectory& optimum, const Eigen::VectorXd& rates, RunContext& context) {
  const long n_nodes = static_cast<long>(optimum.x.size());
  step_ = optimum.step / static_cast<double>(fine_);
  set_controls(optimum);
  variational::State state;
  start(optimum, rates, state);
  variational::LoopOptions options;
  options.dt = step_;
  options.steps = (n_nodes - 1) * fine_ + n_beyond_;
  options.step = step_options(scene_, built_);
  variational::LoopCallbacks callbacks;
  callbacks.record = [&](const variational::NodeRecord& node) {
    if (node.step % scene_.record.every == 0 || node.last) rows_->write(node);
    compare(node, optimum);
    if (context.progress) context.progress(node.step, options.steps, node.t);
  };
  callbacks.interrupted = context.interrupted;
  variational::Ledger ledger;
  variational::StepReport last;
  variational::TimeLoop loop(*built_.model, options);
  const variational::LoopResult result = loop.run(state, ledger, last, callbacks);
  if (result.status != variational::Status::completed) {
    deviations_.stopped_at = result.t;
    deviations_.in_horizon = result.t < (1.0 - 1e-9) * optimum.step * static_cast<double>(n_nodes - 1);
  }
  store();
  return {.status = result.status,
          .sentence = result.sentence.empty() ? "" : "replay: " + loop_sentence(result, scene_),
          .time = result.t};
}

void ReplayRun::compare(const variational::NodeRecord& node, const control::Trajectory& optimum) {
  const long last_node = static_cast<long>(optimum.x.size()) - 1;
  const bool beyond = node.step > last_node * fine_;
  if (!beyond && node.step % fine_ != 0) return;
  const model::Manifold& manifold = *built_.manifold;
  const Eigen::VectorXd& wanted = optimum.x[static_cast<std::size_t>(beyond ? last_node : node.step / fine_)];
  Eigen::VectorXd w(manifold.n_v());
  Eigen::VectorXd q(built_.model->n_q());
  manifold.difference(wanted, node.state.x, w);
  manifold.configuration(wanted, q);
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    const Watched& watched = watched_[i];
    const double value =
        watched.rate >= 0 ? w[watched.rate] : (watched.point.value(node.state.q) - watched.point.value(q)).norm();
    Deviation& deviation = deviations_.all[i];
    if (beyond) {
      deviation.after = std::max(deviation.after, std::abs(value));
    } else {
      deviation.values.push_back(value);
      deviation.largest = std::max(deviation.largest, std::abs(value));
      deviation.final = std::abs(value);
    }
  }
}

void ReplayRun::store() const {
  for (const Deviation& deviation : deviations_.all) {
    if (deviation.values.empty()) continue;
    const std::string path = "replay/deviations/" + deviation.name;
    const std::string unit =
        scene_.units.unit_name(deviation.is_angle ? base::dimension::angle : base::dimension::length);
    recorder_.declare_fixed({.path = path,
                             .shape = {deviation.values.size()},
                             .unit = unit,
                             .doc = "replay less optimum at the nodes of the optimum; of points the distance"},
                            std::span<const double>(deviation.values));
    recorder_.set_attribute(path, "largest", deviation.largest);
    recorder_.set_attribute(path, "final", deviation.final);
    if (deviations_.beyond) recorder_.set_attribute(path, "after", deviation.after);
  }
}

}  // namespace muldi::pipeline
