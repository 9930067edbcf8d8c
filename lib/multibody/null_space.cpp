#include "multibody/null_space.hpp"

#include <Eigen/Geometry>

namespace muldi::multibody {
namespace {

using Eigen::Vector3d;

Pose pose_in(const Eigen::VectorXd& q, int body) {
  if (body == ground) return {};
  Pose pose;
  pose.position = q.segment<3>(12 * body);
  for (int k = 0; k < 3; ++k) pose.orientation.col(k) = q.segment<3>(12 * body + 3 + 3 * k);
  return pose;
}

/// Calls visit(column, u, omega, carrier) for every rate of the joint: u is the direction of sliding (zero for
/// rotations), omega that of turning, carrier the body that the vector is fixed in.
template <class Visit>
void for_each_rate(const Joint& joint, const Eigen::Matrix3d& e_a, const Eigen::Matrix3d& e_b, Visit visit) {
  int column = 0;
  for (const Motion& motion : joint.pattern.motions) {
    switch (motion.kind) {
      case Motion::Kind::slide:
        visit(column++, true, Vector3d(e_a.col(motion.axis)), joint.body_a);
        break;
      case Motion::Kind::rotation_a:
        visit(column++, false, Vector3d(e_a.col(motion.axis)), joint.body_a);
        break;
      case Motion::Kind::rotation_b:
        visit(column++, false, Vector3d(e_b.col(motion.axis)), joint.body_b);
        break;
      case Motion::Kind::ball:
        for (int k = 0; k < 3; ++k) visit(column++, false, Vector3d(e_a.col(k)), joint.body_a);
        break;
    }
  }
}

const LinkFrame* parent_frame(const KinematicTree& tree, const TreeFrame& frame, const TreeLink& link) {
  if (link.parent == ground) return nullptr;
  return &frame.links[static_cast<std::size_t>(tree.link_of_body[static_cast<std::size_t>(link.parent)])];
}

}  // namespace

void update_frame(const KinematicTree& tree, const Eigen::VectorXd& q, TreeFrame& frame) {
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const TreeLink& link = tree.links[l];
    const Joint& joint = tree.joint(link);
    LinkFrame& at = frame.links[l];
    at.pose = pose_in(q, link.body);
    const Pose parent = pose_in(q, link.parent);
    const Pose& a = link.reversed ? at.pose : parent;
    const Pose& b = link.reversed ? parent : at.pose;
    at.arm = at.pose.position - parent.position;
    // Body B turns about its own connector; a reversed A turns about the same point of B (numerics 1.7, with the sign
    // of the joint's own coordinate kept).
    const Vector3d pivot = b.point(joint.rho_b);
    at.lever = pivot - at.pose.position;
    const double sign = link.reversed ? -1.0 : 1.0;
    const Eigen::Matrix3d e_a = a.orientation * joint.triad_a;
    const Eigen::Matrix3d e_b = b.orientation * joint.triad_b;
    for_each_rate(joint, e_a, e_b, [&](int column, bool slides, const Vector3d& axis, int) {
      auto t = at.columns.col(column);
      t.head<3>() = slides ? Vector3d(sign * axis) : Vector3d(sign * at.lever.cross(axis));
      t.tail<3>() = slides ? Vector3d::Zero().eval() : Vector3d(sign * axis);
    });
  }
}

void twists_of(const KinematicTree& tree, const TreeFrame& frame, const Eigen::VectorXd& w, Twists& twists) {
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const TreeLink& link = tree.links[l];
    const LinkFrame& at = frame.links[l];
    Vector6 t = Vector6::Zero();
    if (link.parent != ground) {
      const auto parent = twists.col(tree.link_of_body[static_cast<std::size_t>(link.parent)]);
      t = parent;
      t.head<3>() += parent.tail<3>().cross(at.arm);
    }
    const int n = tree.joint(link).pattern.n_rates();
    for (int k = 0; k < n; ++k) t += w[link.first_rate + k] * at.columns.col(k);
    twists.col(static_cast<Eigen::Index>(l)) = t;
  }
}

void lift_twists(const KinematicTree& tree, const TreeFrame& frame, const Twists& twists, Eigen::VectorXd& dq) {
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const auto t = twists.col(static_cast<Eigen::Index>(l));
    const int first = 12 * tree.links[l].body;
    dq.segment<3>(first) = t.head<3>();
    for (int k = 0; k < 3; ++k) {
      dq.segment<3>(first + 3 + 3 * k) = t.tail<3>().cross(frame.links[l].pose.orientation.col(k));
    }
  }
}

void wrenches_of(const KinematicTree& tree, const TreeFrame& frame, const Eigen::VectorXd& f, Twists& wrenches) {
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    auto wrench = wrenches.col(static_cast<Eigen::Index>(l));
    const int first = 12 * tree.links[l].body;
    wrench.head<3>() = f.segment<3>(first);
    Vector3d moment = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      moment += frame.links[l].pose.orientation.col(k).cross(f.segment<3>(first + 3 + 3 * k));
    }
    wrench.tail<3>() = moment;
  }
}

void accumulate_wrenches(const KinematicTree& tree, const TreeFrame& frame, Twists& wrenches) {
  for (std::size_t l = tree.links.size(); l-- > 0;) {
    const TreeLink& link = tree.links[l];
    if (link.parent == ground) continue;
    const Vector6 wrench = wrenches.col(static_cast<Eigen::Index>(l));
    auto parent = wrenches.col(tree.link_of_body[static_cast<std::size_t>(link.parent)]);
    parent += wrench;
    parent.tail<3>() += frame.links[l].arm.cross(wrench.head<3>());
  }
}

void joint_forces_of(const KinematicTree& tree, const TreeFrame& frame, const Twists& accumulated, Eigen::VectorXd& r) {
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const TreeLink& link = tree.links[l];
    const int n = tree.joint(link).pattern.n_rates();
    for (int k = 0; k < n; ++k) {
      r[link.first_rate + k] = frame.links[l].columns.col(k).dot(accumulated.col(static_cast<Eigen::Index>(l)));
    }
  }
}

namespace {

/// f += the force F at the centre of mass and the moment M: T_int^T f is the wrench (F, M).
void add_wrench(int body, const Eigen::Matrix3d& directors, const Vector3d& F, const Vector3d& M, Eigen::VectorXd& f) {
  f.segment<3>(12 * body) += F;
  for (int k = 0; k < 3; ++k) f.segment<3>(12 * body + 3 + 3 * k) += 0.5 * M.cross(directors.col(k));
}

}  // namespace

void add_drive_forces(const KinematicTree& tree, const TreeFrame& frame, double factor, const Eigen::VectorXd& on_rates,
                      Eigen::VectorXd& f) {
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const TreeLink& link = tree.links[l];
    const LinkFrame& at = frame.links[l];
    const Joint& joint = tree.joint(link);
    if (on_rates.segment(link.first_rate, joint.pattern.n_rates()).isZero(0.0)) continue;
    Vector3d F = Vector3d::Zero();
    Vector3d M = Vector3d::Zero();
    int column = 0;
    for (const Motion& motion : joint.pattern.motions) {
      for (int i = 0; i < motion.n_rates(); ++i, ++column) {
        const double Q = factor * on_rates[link.first_rate + column];
        if (motion.kind == Motion::Kind::slide) {
          F += Q * at.columns.col(column).head<3>();
        } else {
          M += Q * at.columns.col(column).tail<3>();
        }
      }
    }
    add_wrench(link.body, at.pose.orientation, F, M + at.lever.cross(F), f);
    const LinkFrame* parent = parent_frame(tree, frame, link);
    if (parent == nullptr) continue;
    add_wrench(link.parent, parent->pose.orientation, -F, -M - (at.arm + at.lever).cross(F), f);
  }
}

namespace {

/// Rates of the plain wrenches T_int^T f, f frozen: the directors turn.
void wrench_rates(const KinematicTree& tree, const TreeFrame& frame, const Twists& twists, const Eigen::VectorXd& f,
                  Twists& change) {
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const Vector3d omega = twists.col(static_cast<Eigen::Index>(l)).tail<3>();
    const int first = 12 * tree.links[l].body;
    Vector3d moment = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      moment += omega.cross(frame.links[l].pose.orientation.col(k)).cross(f.segment<3>(first + 3 + 3 * k));
    }
    change.col(static_cast<Eigen::Index>(l)) << Vector3d::Zero(), moment;
  }
}

/// A link and its parent in motion.
struct MovingLink {
  const TreeLink& link;
  const LinkFrame& at;
  Pose parent;
  Vector6 twist;
  Vector6 parent_twist;

  /// Rate of LinkFrame::lever: the pivot rides on body B, the lever starts at the link's own body.
  Vector3d lever_rate() const {
    const Vector6& twist_b = link.reversed ? parent_twist : twist;
    const Vector3d& b_position = link.reversed ? parent.position : at.pose.position;
    const Vector3d pivot = at.pose.position + at.lever;
    return twist_b.head<3>() + twist_b.tail<3>().cross(pivot - b_position) - twist.head<3>();
  }
};

/// Rate of S^T W of one link, W and its rate given.
void joint_force_rate(const Joint& joint, const MovingLink& moving, const Vector6& wrench, const Vector6& wrench_rate,
                      Eigen::VectorXd& rate) {
  const TreeLink& link = moving.link;
  const LinkFrame& at = moving.at;
  const Pose& a = link.reversed ? at.pose : moving.parent;
  const Pose& b = link.reversed ? moving.parent : at.pose;
  const Vector3d lever_rate = moving.lever_rate();
  const double sign = link.reversed ? -1.0 : 1.0;
  for_each_rate(joint, a.orientation * joint.triad_a, b.orientation * joint.triad_b,
                [&](int k, bool slides, const Vector3d& axis, int carrier) {
                  const Vector3d omega = (carrier == link.body ? moving.twist : moving.parent_twist).tail<3>();
                  const Vector3d axis_rate = omega.cross(axis);
                  double value = at.columns.col(k).dot(wrench_rate);
                  if (slides) {
                    value += sign * axis_rate.dot(wrench.head<3>());
                  } else {
                    value += sign * (lever_rate.cross(axis) + at.lever.cross(axis_rate)).dot(wrench.head<3>());
                    value += sign * axis_rate.dot(wrench.tail<3>());
                  }
                  rate[link.first_rate + k] = value;
                });
}

}  // namespace

void projection_rate(const KinematicTree& tree, const TreeFrame& frame, const Twists& twists, const FrozenForce& force,
                     Eigen::VectorXd& rate) {
  Twists& change = frame.twists;  // rate of the accumulated wrenches
  wrench_rates(tree, frame, twists, force.f, change);
  for (std::size_t l = tree.links.size(); l-- > 0;) {
    const TreeLink& link = tree.links[l];
    const auto column = static_cast<Eigen::Index>(l);
    MovingLink moving{link, frame.links[l], {}, twists.col(column), Vector6::Zero()};
    const LinkFrame* parent = parent_frame(tree, frame, link);
    const int parent_column = parent == nullptr ? -1 : tree.link_of_body[static_cast<std::size_t>(link.parent)];
    if (parent != nullptr) {
      moving.parent = parent->pose;
      moving.parent_twist = twists.col(parent_column);
    }
    const Vector6 wrench = force.accumulated.col(column);
    const Vector6 wrench_rate = change.col(column);
    joint_force_rate(tree.joint(link), moving, wrench, wrench_rate, rate);
    if (parent == nullptr) continue;
    auto up = change.col(parent_column);
    up += wrench_rate;
    up.tail<3>() += moving.at.arm.cross(wrench_rate.head<3>());
    up.tail<3>() += (moving.twist.head<3>() - moving.parent_twist.head<3>()).cross(wrench.head<3>());
  }
}

}  // namespace muldi::multibody
