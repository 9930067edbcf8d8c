#pragma once
/// The null-space matrix of a whole tree in factored form, T = T_int T_ext (numerics, 1.6, 1.7): never a matrix
/// product, but the recursion t_B = T_a t_A + T_b w over the links, with twists t = (v, omega) of the bodies.
#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/QR>
#include <vector>

#include "model/manifold.hpp"
#include "multibody/kinematic_tree.hpp"

namespace muldi::multibody {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Twists = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Data of one link at one configuration.
struct LinkFrame {
  Pose pose;                                      ///< of the body
  Eigen::Vector3d arm = Eigen::Vector3d::Zero();  ///< body minus parent position: T_a = [1 -hat(arm); 0 1]
  Eigen::Vector3d lever =
      Eigen::Vector3d::Zero();  ///< from the body that hangs to the point that turns with zero slide rate
  Eigen::Matrix<double, 6, 6> columns = Eigen::Matrix<double, 6, 6>::Zero();  ///< T_b in the first n_rates columns
};

/// T(q) of a TreeManifold; scratch twists are part of it, so projections allocate nothing.
struct TreeFrame : model::Frame {
  std::vector<LinkFrame> links;                               ///< as KinematicTree::links
  mutable Twists twists;                                      ///< (6, n_links) scratch
  mutable Eigen::VectorXd q;                                  ///< (n_q) scratch of the loop rows, empty without loops
  mutable Eigen::VectorXd gradient;                           ///< (n_q)
  mutable Eigen::VectorXd row;                                ///< (n_v)
  Eigen::MatrixXd all_rows;                                   ///< (n_loop_rows, n_v) B in natural increments
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> loop_pivots;    ///< of all_rows
  Eigen::VectorXd workspace;                                  ///< (n_c)
  Eigen::MatrixXd loop_basis;                                 ///< (n_loop_rows, n_c) Z, once chosen
  Eigen::MatrixXd loop_rows;                                  ///< (n_c, n_v) Z^T B, once chosen
  mutable Eigen::MatrixXd other_rows;                         ///< (n_c, n_v) Z^T B at another frame
  mutable Eigen::PartialPivLU<Eigen::MatrixXd> loop_product;  ///< of the rows at two frames
};

/// Recomputes the frame from the poses in q (directors at 12 body + 3).
void update_frame(const KinematicTree& tree, const Eigen::VectorXd& q, TreeFrame& frame);

/// Twists of all links (columns) for minimal velocities w.
void twists_of(const KinematicTree& tree, const TreeFrame& frame, const Eigen::VectorXd& w, Twists& twists);
/// dq = T_int t for all bodies.
void lift_twists(const KinematicTree& tree, const TreeFrame& frame, const Twists& twists, Eigen::VectorXd& dq);
/// Wrenches T_int^T f of all links, about their centres of mass.
void wrenches_of(const KinematicTree& tree, const TreeFrame& frame, const Eigen::VectorXd& f, Twists& wrenches);
/// Adds every link's wrench to its parent, leaves first, so that column l holds the wrench of the subtree of l.
void accumulate_wrenches(const KinematicTree& tree, const TreeFrame& frame, Twists& wrenches);
/// r = T_b^T W with accumulated wrenches.
void joint_forces_of(const KinematicTree& tree, const TreeFrame& frame, const Twists& accumulated, Eigen::VectorXd& r);

/// f += factor times the forces of joint drives `on_rates` (n_rates): of slides along their axes through the pivot, of
/// rotations moments about their axes, on the body of each link and opposite ones on its parent. As every joint's axes
/// of rotation are perpendicular to each other, T^T f = factor on_rates.
void add_drive_forces(const KinematicTree& tree, const TreeFrame& frame, double factor, const Eigen::VectorXd& on_rates,
                      Eigen::VectorXd& f);

/// A force f (n_q) that is kept while the configuration moves, with the accumulated wrenches of it.
struct FrozenForce {
  const Eigen::VectorXd& f;
  const Twists& accumulated;
};

/// d(T(q)^T f)/dt along the velocity whose twists are given, with f frozen.
void projection_rate(const KinematicTree& tree, const TreeFrame& frame, const Twists& twists, const FrozenForce& force,
                     Eigen::VectorXd& rate);

}  // namespace muldi::multibody
