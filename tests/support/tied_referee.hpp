#pragma once
/// The coupled step with multipliers instead of elimination (numerics 1.9): solids that know nothing of bodies, held to
/// them by rows x_c - A q = 0, in one dense Newton iteration with differences for its matrix.
#include "support/tied_system.hpp"

namespace muldi::test {

class TiedReferee {
 public:
  /// One solid, displacements or pressures, potentials prescribed or free; no loops.
  TiedReferee(const TiedSystem& system, double dt);

  /// One step on from the state of the system with ties.
  void advance(variational::State& state, const std::vector<double>& u);
  /// Forces of the ties on the nodes at the begin of the last step, in the order of the ties.
  const Eigen::Matrix3Xd& forces() const { return forces_; }

 private:
  Eigen::VectorXd residual(const variational::State& state, const std::vector<double>& u, const Eigen::VectorXd& z);
  void spread(const variational::State& state, const std::vector<double>& u, const Eigen::VectorXd& z);

  std::vector<fem::Tie> ties_;
  Eigen::Index host_ = 0;  // first entry of the only host
  std::unique_ptr<model::Model> model_;
  double dt_;
  std::vector<Eigen::Index> free_q_;
  std::vector<Eigen::Index> free_y_;
  std::unique_ptr<model::Frame> frame_;
  model::IntervalForces at_;
  Eigen::VectorXd x_, q_, y_, lambda_, momentum_;
  Eigen::Matrix3Xd forces_;
};

}  // namespace muldi::test
