#include "pipeline/joint_momenta.hpp"

#include "base/error.hpp"

namespace muldi::pipeline {

Eigen::VectorXd wanted_momenta(const scene::Scene& scene, const build::BuiltModel& built) {
  Eigen::VectorXd m = Eigen::VectorXd::Zero(built.manifold->n_v());
  for (const auto& entry : scene.initial.momentum) {
    const auto* link = built.link_of_joint(static_cast<std::size_t>(scene.joints.index(entry.name)));
    if (link == nullptr) {
      throw base::InputError(
          {scene::error_at(entry.origin, "this joint closes a loop; give the momentum of another joint of the loop")});
    }
    for (std::size_t k = 0; k < entry.value.values.size(); ++k) {
      m[link->first_rate + static_cast<int>(k)] = entry.value.values[k];
    }
  }
  return m;
}

Eigen::VectorXd rates_of_momentum(const build::BuiltModel& built, const Eigen::VectorXd& x, const Eigen::VectorXd& m) {
  const multibody::TreeManifold& manifold = *built.manifold;
  Eigen::VectorXd q(manifold.n_q());
  manifold.configuration(x, q);
  const auto frame = manifold.make_frame();
  manifold.update(x, q, *frame);
  manifold.choose_loop_rows(*frame);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(manifold.n_q());
  std::vector<double> u(built.model->controls.size());
  built.model->evaluate_controls(0.0, u);
  math::BlockMatrix M(*built.model->pattern);
  built.model->tangent({.q0 = q, .q1 = q, .q = q, .v = zero, .u = u}, model::TangentWeights::mass(), M);
  const auto solver = manifold.make_solver(*built.model->pattern, "auto");
  Eigen::VectorXd rates = Eigen::VectorXd::Zero(manifold.n_v());
  Eigen::VectorXd mu = Eigen::VectorXd::Zero(manifold.n_c());
  if (solver->factorise(*frame, *frame, M)) solver->solve(m, Eigen::VectorXd::Zero(manifold.n_c()), rates, mu);
  return rates;
}

}  // namespace muldi::pipeline
