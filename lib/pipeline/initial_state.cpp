#include "pipeline/initial_state.hpp"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"
#include "build/place_bodies.hpp"
#include "multibody/joint_coordinate.hpp"
#include "pipeline/checkpoint.hpp"
#include "pipeline/joint_momenta.hpp"
#include "pipeline/led_solids.hpp"
#include "statics/sweep.hpp"
#include "variational/node_values.hpp"

namespace muldi::pipeline {
namespace {

using multibody::JointCoordinate;
using multibody::Motion;

constexpr double closing_goal = 1e-13;   // of the loop rows, dimensionless
constexpr double closing_limit = 1e-10;  // beyond which the loops stay open
constexpr double longest_correction = 0.3;
constexpr double contradiction = 1e-9;  // of the wanted velocity

/// A linear condition row . w = value on minimal rates (or on their correction).
struct Condition {
  Eigen::VectorXd row;
  double value = 0.0;
  scene::Origin origin = {};
  std::string what = {};
};

Eigen::MatrixXd rows_of(const std::vector<Condition>& conditions, Eigen::Index n_v) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(conditions.size()), n_v);
  for (std::size_t i = 0; i < conditions.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) = conditions[i].row.transpose();
  return rows;
}

class InitialConditions {
 public:
  InitialConditions(const scene::Scene& scene, const build::BuiltModel& built, const Eigen::VectorXd& x)
      : scene_(scene), built_(built), manifold_(*built.manifold), frame_(manifold_.make_frame()), q_(manifold_.n_q()) {
    move_to(x);
  }

  void move_to(const Eigen::VectorXd& x) {
    manifold_.configuration(x, q_);
    manifold_.update(x, q_, *frame_);
    manifold_.choose_loop_rows(*frame_);
  }

  /// Independent rows of the loops with their violation as value.
  std::vector<Condition> loops() const {
    Eigen::MatrixXd B(manifold_.n_c(), manifold_.n_v());
    Eigen::VectorXd gaps(manifold_.n_loop_rows());
    const Eigen::MatrixXd& Z = manifold_.loop_basis(*frame_);
    manifold_.project_constraints(*frame_, Z, B);
    manifold_.constraints(q_, gaps);
    const Eigen::VectorXd g = Z.transpose() * gaps;
    std::vector<Condition> conditions;
    for (Eigen::Index i = 0; i < B.rows(); ++i) conditions.push_back({.row = B.row(i).transpose(), .value = -g[i]});
    return conditions;
  }

  /// Largest violation of a loop row.
  double gap() const {
    Eigen::VectorXd gaps(manifold_.n_loop_rows());
    manifold_.constraints(q_, gaps);
    return gaps.lpNorm<Eigen::Infinity>();
  }

  /// Wanted coordinates of loop-closing joints: what is missing.
  void add_cut_positions(std::vector<Condition>& conditions) const {
    for_each_cut_coordinate([&](const auto& entry, std::size_t k, const JointCoordinate& coordinate) {
      if (entry.value.position.empty()) return;
      const double missing = entry.value.position[k] - coordinate.value(q_);
      conditions.push_back({.row = gradient(coordinate), .value = missing, .origin = entry.origin});
    });
  }

  std::vector<Condition> velocities() const {
    std::vector<Condition> conditions = loops();
    for (Condition& condition : conditions) condition.value = 0.0;
    for (const auto& entry : scene_.initial.joints) {
      const auto* link = built_.link_of_joint(static_cast<std::size_t>(scene_.joints.index(entry.name)));
      if (link == nullptr) continue;
      for (std::size_t k = 0; k < entry.value.velocity.size(); ++k) {
        conditions.push_back({.row = Eigen::VectorXd::Unit(manifold_.n_v(), link->first_rate + static_cast<int>(k)),
                              .value = entry.value.velocity[k],
                              .origin = entry.origin,
                              .what = "joint velocity"});
      }
    }
    for_each_cut_coordinate([&](const auto& entry, std::size_t k, const JointCoordinate& coordinate) {
      if (entry.value.velocity.empty()) return;
      conditions.push_back({.row = gradient(coordinate),
                            .value = entry.value.velocity[k],
                            .origin = entry.origin,
                            .what = "joint velocity"});
    });
    for (const auto& entry : scene_.initial.bodies) add_body(entry, conditions);
    return conditions;
  }

 private:
  template <class Visit>
  void for_each_cut_coordinate(Visit visit) const {
    for (const auto& entry : scene_.initial.joints) {
      const auto index = static_cast<std::size_t>(scene_.joints.index(entry.name));
      if (built_.link_of_joint(index) != nullptr) continue;
      std::size_t k = 0;
      for (const Motion& motion : built_.joint(index).pattern.motions) {
        if (motion.kind == Motion::Kind::ball) {
          throw base::InputError({scene::error_at(
              entry.origin,
              "this joint closes a loop; initial values of a rotation vector are possible on the other "
              "joints of the loop only")});
        }
        visit(entry, k++, JointCoordinate(built_.joint(index), motion));
      }
    }
  }

  Eigen::VectorXd gradient(const JointCoordinate& coordinate) const {
    Eigen::VectorXd in_q = Eigen::VectorXd::Zero(manifold_.n_q());
    coordinate.add_gradient(q_, 1.0, in_q);
    return projected(in_q);
  }

  Eigen::VectorXd projected(const Eigen::VectorXd& in_q) const {
    Eigen::VectorXd row(manifold_.n_v());
    manifold_.project(*frame_, in_q, row);
    return row;
  }

  void add_body(const scene::Entry<scene::BodyVelocity>& entry, std::vector<Condition>& conditions) const {
    const int first = 12 * scene_.bodies.index(entry.name);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d unit = Eigen::Vector3d::Unit(k);
      if (entry.value.velocity) {
        const Eigen::VectorXd in_q = Eigen::VectorXd::Unit(manifold_.n_q(), first + k);
        conditions.push_back({.row = projected(in_q),
                              .value = (*entry.value.velocity)[static_cast<std::size_t>(k)],
                              .origin = entry.origin,
                              .what = "velocity"});
      }
      if (entry.value.angular_velocity) {
        // omega = 1/2 sum d_i x d_i'
        Eigen::VectorXd in_q = Eigen::VectorXd::Zero(manifold_.n_q());
        for (int i = 0; i < 3; ++i) {
          in_q.segment<3>(first + 3 + 3 * i) = 0.5 * unit.cross(Eigen::Vector3d(q_.segment<3>(first + 3 + 3 * i)));
        }
        conditions.push_back({.row = projected(in_q),
                              .value = (*entry.value.angular_velocity)[static_cast<std::size_t>(k)],
                              .origin = entry.origin,
                              .what = "angular velocity"});
      }
    }
  }

  const scene::Scene& scene_;
  const build::BuiltModel& built_;
  const multibody::TreeManifold& manifold_;
  std::unique_ptr<model::Frame> frame_;
  Eigen::VectorXd q_;
};

/// Moves what is free until the loops close and loop-closing joints have their positions.
void close_loops(const scene::Scene& scene, const build::BuiltModel& built, const std::vector<bool>& held,
                 Eigen::VectorXd& x) {
  const multibody::TreeManifold& manifold = *built.manifold;
  if (manifold.n_c() == 0) return;
  const Eigen::VectorXd scale = manifold.rate_scale();
  InitialConditions conditions(scene, built, x);
  double gap = 0.0;
  for (int iteration = 0; iteration < 100; ++iteration) {
    conditions.move_to(x);
    std::vector<Condition> wanted = conditions.loops();
    conditions.add_cut_positions(wanted);
    Eigen::MatrixXd rows = rows_of(wanted, manifold.n_v()) * scale.asDiagonal();
    Eigen::VectorXd missing(rows.rows());
    for (std::size_t i = 0; i < wanted.size(); ++i) missing[static_cast<Eigen::Index>(i)] = wanted[i].value;
    gap = std::max(conditions.gap(), missing.tail(missing.size() - manifold.n_c()).lpNorm<Eigen::Infinity>());
    if (gap <= closing_goal) return;
    for (std::size_t k = 0; k < held.size(); ++k) {
      if (held[k]) rows.col(static_cast<Eigen::Index>(k)).setZero();
    }
    Eigen::VectorXd step = rows.completeOrthogonalDecomposition().solve(missing);
    const double size = step.lpNorm<Eigen::Infinity>();
    if (size > longest_correction) step *= longest_correction / size;
    if (size < 1e-15) break;
    manifold.retract(x, scale.cwiseProduct(step), x);
  }
  if (gap <= closing_limit) return;
  const scene::Origin origin = scene.initial.joints.empty() ? scene.origin : scene.initial.joints[0].origin;
  throw base::InputError({scene::error_at(
      origin, base::format("the initial joint positions contradict the loops: they stay open by {:.3g} of the scene's "
                           "size; give fewer positions, or ones that can be reached",
                           gap))});
}

/// Positions of a solid in q, also of one that others are attached to.
model::Slice slice_of(const fem::SolidRecords& records) {
  return {.first = records.solid().q_slice().first + 3 * static_cast<Eigen::Index>(records.member().first_node),
          .size = 3 * static_cast<Eigen::Index>(records.member().n_nodes)};
}

/// Adds to v (n_q) the velocities of solids: with the bodies that they are tied to, which move by `rates`, and the
/// rigid motions that the scene gives to them; what is prescribed or follows others is left to Substructure::follow.
void add_velocities(const scene::Scene& scene, const build::BuiltModel& built, const variational::State& state,
                    const Eigen::VectorXd& rates, Eigen::VectorXd& v) {
  if (built.solids.empty()) return;
  LedSolids led(built, scene.solver.tolerance);
  if (led.any() && !rates.isZero(0.0)) {
    const auto frame = built.manifold->make_frame();
    built.manifold->update(state.x, state.q, *frame);
    Eigen::VectorXd of_bodies = Eigen::VectorXd::Zero(v.size());
    built.manifold->lift(*frame, rates, of_bodies);
    led.add_velocities({.x = state.x, .multipliers = {}, .q = state.q, .y = state.y}, of_bodies);
    for (const auto& records : built.solid_records) {
      const bool given = scene.initial.solids.find(records->member().name) != nullptr;
      const model::Slice slice = slice_of(*records);
      if (!given) v.segment(slice.first, slice.size) += of_bodies.segment(slice.first, slice.size);
    }
    v.head(built.manifold->n_q()) += of_bodies.head(built.manifold->n_q());
  }
  const Eigen::VectorXd& q = state.q;
  for (const auto& entry : scene.initial.solids) {
    const fem::SolidRecords& solid = *built.solid_records[static_cast<std::size_t>(scene.solids.index(entry.name))];
    const model::Slice slice = slice_of(solid);
    const Eigen::Vector3d velocity = build::to_eigen(entry.value.velocity.value_or(base::Vec3{}));
    const Eigen::Vector3d omega = build::to_eigen(entry.value.angular_velocity.value_or(base::Vec3{}));
    const Eigen::Vector3d centre = solid.solid().centre_of_mass(solid.member(), q);
    for (Eigen::Index first = slice.first; first < slice.end(); first += 3) {
      v.segment<3>(first) += velocity + omega.cross(Eigen::Vector3d(q.segment<3>(first)) - centre);
    }
  }
}

}  // namespace

Eigen::VectorXd initial_coordinates(const scene::Scene& scene, const build::BuiltModel& built) {
  Eigen::VectorXd x = built.manifold->reference();
  std::vector<bool> held(static_cast<std::size_t>(built.manifold->n_v()), false);
  for (const auto& entry : scene.initial.joints) {
    if (entry.value.position.empty()) continue;
    const auto index = static_cast<std::size_t>(scene.joints.index(entry.name));
    const auto* link = built.link_of_joint(index);
    if (link == nullptr) continue;
    const multibody::Joint& joint = built.joint(index);
    multibody::stored_coordinates(joint, entry.value.position.data(), x.data() + link->first_coordinate);
    for (int k = 0; k < joint.pattern.n_rates(); ++k) held[static_cast<std::size_t>(link->first_rate + k)] = true;
  }
  close_loops(scene, built, held, x);
  Eigen::VectorXd q(built.manifold->n_q());
  built.manifold->configuration(x, q);
  if (const std::string sentence = built.model->inadmissible(q); !sentence.empty()) {
    throw base::InputError({scene::error_at(scene.origin, "the initial pose is impossible: " + sentence)});
  }
  return x;
}

statics::StaticState starting_point(const scene::Scene& scene, const build::BuiltModel& built) {
  const model::Model& model = *built.model;
  statics::StaticState start{.x = initial_coordinates(scene, built),
                             .multipliers = Eigen::VectorXd::Zero(built.manifold->n_loop_rows()),
                             .q = Eigen::VectorXd::Zero(model.n_q()),
                             .y = Eigen::VectorXd::Zero(model.n_y())};
  const bool moved = std::any_of(scene.initial.joints.begin(), scene.initial.joints.end(),
                                 [](const auto& entry) { return !entry.value.position.empty(); });
  LedSolids solids(built, scene.solver.tolerance);
  const bool led = moved && solids.any();
  const Eigen::VectorXd x = start.x;
  if (led) start.x = built.manifold->reference();
  built.manifold->configuration(start.x, start.q);
  for (const auto& part : model.substructures) part->start(start.q, start.y);
  if (led && !solids.lead_to(x, start)) {
    throw base::InputError({scene::error_at(
        scene.initial.joints[0].origin,
        "the solids that are fixed to the bodies find no rest at the initial joint positions: give smaller ones")});
  }
  return start;
}

Outcome settle(const scene::Scene& scene, const build::BuiltModel& built, statics::StaticState& state) {
  std::vector<double> u(built.model->controls.size());
  built.model->evaluate_controls(0.0, u);
  statics::SweepOptions options{.from = 0.0, .to = 1.0, .steps = 4};
  options.equilibrium.tolerance = scene.solver.tolerance;
  options.equilibrium.substructures = built.solid_linear;
  statics::Sweep sweep(*built.model, std::vector<double>(u.size(), 0.0), u, options);
  const statics::SweepResult result = sweep.run(state, {});
  if (result.end != statics::SweepResult::End::completed) {
    return {.status = variational::Status::loss_of_equilibrium,
            .sentence = "no static equilibrium under the controls at t = 0: " + result.sentence};
  }
  return {};
}

Eigen::VectorXd initial_rates(const scene::Scene& scene, const build::BuiltModel& built, const Eigen::VectorXd& x) {
  const multibody::TreeManifold& manifold = *built.manifold;
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(manifold.n_v());
  bool any = !scene.initial.bodies.empty();
  for (const auto& entry : scene.initial.joints) any |= !entry.value.velocity.empty();
  if (any) {
    const std::vector<Condition> conditions = InitialConditions(scene, built, x).velocities();
    const Eigen::VectorXd scale = manifold.rate_scale();
    const Eigen::MatrixXd rows = rows_of(conditions, manifold.n_v()) * scale.asDiagonal();
    Eigen::VectorXd wanted(rows.rows());
    for (std::size_t i = 0; i < conditions.size(); ++i) wanted[static_cast<Eigen::Index>(i)] = conditions[i].value;
    const Eigen::VectorXd solution = rows.completeOrthogonalDecomposition().solve(wanted);
    const Eigen::VectorXd reached = rows * solution;
    std::vector<base::Diagnostic> errors;
    for (std::size_t i = 0; i < conditions.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      if (std::abs(reached[at] - wanted[at]) <= contradiction * wanted.lpNorm<Eigen::Infinity>()) continue;
      if (conditions[i].what.empty()) continue;
      errors.push_back(scene::error_at(
          conditions[i].origin,
          base::format(
              "the {} {:.6g} contradicts the joints or the other initial velocities (nearest possible: {:.6g})",
              conditions[i].what, wanted[at], reached[at])));
    }
    if (!errors.empty()) throw base::InputError(std::move(errors));
    rates = scale.cwiseProduct(solution);
  }
  static_cast<void>(wanted_momenta(scene, built));  // says what cannot be given
  return rates;
}

Outcome initial_state(const scene::Scene& scene, const build::BuiltModel& built,
                      const std::optional<results::Checkpoint>& earlier, variational::State& state) {
  const multibody::TreeManifold& manifold = *built.manifold;
  Eigen::VectorXd rates;
  variational::NodeValues values;
  state = {};
  std::vector<double> u(built.model->controls.size());
  built.model->evaluate_controls(scene.dynamics ? 0.5 * scene.dynamics->step : 0.0, u);
  if (earlier) {
    state = state_of(*earlier, scene, *built.model);
    variational::NodeEvaluator nodes(*built.model, "auto", built.solid_linear);
    nodes.evaluate(state, u, u, values);
    rates = values.rate;
  } else {
    statics::StaticState start = starting_point(scene, built);
    if (scene.initial.from.kind == scene::InitialFrom::Kind::static_equilibrium) {
      const Outcome outcome = settle(scene, built, start);
      if (!outcome.completed()) return outcome;
    }
    state.x = std::move(start.x);
    state.q = std::move(start.q);
    state.y = std::move(start.y);
  }
  const Eigen::VectorXd added = initial_rates(scene, built, state.x);
  rates = rates.size() == 0 ? added : Eigen::VectorXd(rates + added);
  manifold.configuration(state.x, state.q);
  Eigen::VectorXd v = values.v.size() > 0 ? values.v : Eigen::VectorXd(Eigen::VectorXd::Zero(built.model->n_q()));
  std::optional<variational::ControlRates> control_rates;
  std::span<const double> du;
  if (scene.dynamics) du = control_rates.emplace(*built.model, scene.dynamics->step).at(0.0, variational::Side::after);
  add_velocities(scene, built, state, added, v);
  for (const auto& part : built.model->substructures) part->follow(du, v);
  const auto frame = manifold.make_frame();
  manifold.update(state.x, state.q, *frame);
  if (!scene.initial.momentum.empty()) rates += rates_of_momentum(built, state.x, wanted_momenta(scene, built));
  v.head(manifold.n_q()).setZero();
  manifold.lift(*frame, rates, v);
  variational::NodeEvaluator nodes(*built.model, "auto", built.solid_linear);
  nodes.momentum_of(state.q, v, u, state.p);
  const bool given_momenta = !scene.initial.momentum.empty() && !built.solids.empty();
  if ((given_momenta || nodes.moves()) && nodes.evaluate(state, u, u, values, du)) {
    rates = values.rate;
    v = values.v;
    // What starts to move at t = 0 has done its work on what keeps its volume before.
    if (nodes.moves()) state.p = values.momentum;
  }
  state.step = 0;
  state.t = 0.0;
  state.increment = (scene.dynamics ? scene.dynamics->step : 0.0) * rates;
  state.multipliers = Eigen::VectorXd::Zero(manifold.n_loop_rows());
  state.advance.resize(0);
  if (!built.solids.empty()) state.advance = (scene.dynamics ? scene.dynamics->step : 0.0) * v;
  state.factor = {};
  return {};
}

}  // namespace muldi::pipeline
