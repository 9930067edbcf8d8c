#pragma once
/// Rotations that carry a factor along with a solid: its matrix in the frame of the factorisation serves as long as the
/// solid is strained little more than then, however far the bodies have turned (performance 6).
///
/// A node turns by R_0 exp(sum_k w_k log(R_0^T R_k)) with the rotations R_k of the bodies that the solid is tied to (of
/// ground: none) and the fixed weights w_k of TieWeights. A tied node turns with its
/// body, a prescribed one not at all, so that what is not free stays so in the turned frame.
#include <Eigen/Core>
#include <vector>

#include "fem/solid/tie_weights.hpp"

namespace muldi::fem {

class Turning {
 public:
  /// `data` must outlive the object.
  explicit Turning(const SolidDescription& data);

  /// The bodies' directors in q are those of the factorisation.
  void keep(const Eigen::VectorXd& q);
  /// Turns with the bodies from where they were kept.
  void turn_to(const Eigen::VectorXd& q);
  /// False where no body has turned; then nothing below changes anything.
  bool is_turned() const { return turned_; }

  /// Rotates vectors of the nodes into the frame of the factor, and from there into that of the present.
  void back(Eigen::Ref<Eigen::VectorXd> x) const;
  void forth(Eigen::Ref<Eigen::VectorXd> x) const;
  /// The rotation of a body since the factorisation.
  const Eigen::Matrix3d& of_host(int host) const { return rotations_[static_cast<std::size_t>(host)]; }

 private:
  const SolidDescription* data_;
  TieWeights weights_;                      // a frame for each group of nodes
  std::vector<Eigen::Matrix3d> kept_;       // directors of the hosts at the factorisation
  std::vector<Eigen::Matrix3d> rotations_;  // of the anchors since then
  std::vector<Eigen::Vector3d> logs_;       // relative to the first
  std::vector<Eigen::Matrix3d> frames_;
  bool turned_ = false;
};

}  // namespace muldi::fem
