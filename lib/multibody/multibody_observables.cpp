#include "multibody/multibody_observables.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace muldi::multibody {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d angular_velocity(const Eigen::VectorXd& q, const Eigen::VectorXd& v, int body) {
  Vector3d omega = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const int first = 12 * body + 3 + 3 * k;
    omega += 0.5 * Vector3d(q.segment<3>(first)).cross(Vector3d(v.segment<3>(first)));
  }
  return omega;
}

Pose pose_at(const Eigen::VectorXd& q, int body) {
  if (body == ground) return {};
  return {.position = q.segment<3>(12 * body), .orientation = Eigen::Map<const Matrix3d>(q.data() + 12 * body + 3)};
}

void write(const Vector3d& value, std::span<double> out) { std::copy(value.data(), value.data() + 3, out.begin()); }

}  // namespace

std::vector<model::Observable> body_observables(const std::string& name, int body) {
  namespace dim = base::dimension;
  const std::string path = "bodies/" + name + "/";
  return {
      {path + "position",
       {3},
       dim::length,
       "centre of mass, world axes",
       [body](const model::NodeView& at, std::span<double> out) { write(at.q.segment<3>(12 * body), out); }},
      {path + "orientation",
       {3, 3},
       dim::none,
       "directors as columns",
       [body](const model::NodeView& at, std::span<double> out) {
         const Matrix3d rows = pose_at(at.q, body).orientation.transpose();  // row-major output
         std::copy(rows.data(), rows.data() + 9, out.begin());
       }},
      {path + "velocity",
       {3},
       dim::velocity,
       "of the centre of mass, world axes",
       [body](const model::NodeView& at, std::span<double> out) { write(at.v.segment<3>(12 * body), out); },
       true},
      {path + "angular_velocity",
       {3},
       dim::angular_velocity,
       "world axes",
       [body](const model::NodeView& at, std::span<double> out) { write(angular_velocity(at.q, at.v, body), out); },
       true},
  };
}

model::Observable point_observable(const std::string& label, int body, const Vector3d& local) {
  return {"points/" + label,
          {3},
          base::dimension::length,
          "position of the point, world axes",
          [body, local](const model::NodeView& at, std::span<double> out) {
            write(pose_at(at.q, body).point(local), out);
          }};
}

JointRecords::JointRecords(const TreeManifold& manifold)
    : manifold_(manifold),
      tree_(manifold.tree()),
      link_of_joint_(tree_.joints.size(), -1),
      wrenches_(6, static_cast<Eigen::Index>(tree_.links.size())),
      force_(manifold.n_q()) {
  for (std::size_t l = 0; l < tree_.links.size(); ++l) {
    link_of_joint_[static_cast<std::size_t>(tree_.links[l].joint)] = static_cast<int>(l);
  }
  frame_.links.resize(tree_.links.size());
  frame_.twists = wrenches_;
}

std::vector<model::Observable> JointRecords::observables() {
  namespace dim = base::dimension;
  std::vector<model::Observable> all;
  for (int j = 0; j < tree_.n_user_joints(); ++j) {
    const Joint& joint = tree_.joints[static_cast<std::size_t>(j)];
    const std::string path = "joints/" + joint.name + "/";
    const auto n = static_cast<std::size_t>(joint.pattern.n_rates());
    if (n > 0) {
      const bool slides = joint.pattern.motions.front().kind == Motion::Kind::slide;
      const bool mixed = slides && joint.pattern.motions.back().kind != Motion::Kind::slide;
      const base::Dimension unit = slides && !mixed ? dim::length : dim::angle;
      const std::string kinds = mixed ? " (lengths, then angles)" : "";
      all.push_back({path + "coordinate",
                     {n},
                     unit,
                     "joint coordinates, zero in the scene pose" + kinds,
                     [this, j](const model::NodeView& at, std::span<double> out) { coordinate(j, at, out); }});
      all.push_back({path + "velocity",
                     {n},
                     unit / dim::time,
                     "rates of the joint coordinates" + kinds,
                     [this, j](const model::NodeView& at, std::span<double> out) { velocity(j, at, out); },
                     true});
    }
    all.push_back({path + "reaction",
                   {6},
                   dim::force,
                   "force, and moment (force times length) on `to` about its connector, world axes",
                   [this, j](const model::NodeView& at, std::span<double> out) { reaction(j, at, out); }});
  }
  return all;
}

void JointRecords::coordinate(int j, const model::NodeView& at, std::span<double> out) const {
  const Joint& joint = tree_.joints[static_cast<std::size_t>(j)];
  const int link = link_of_joint_[static_cast<std::size_t>(j)];
  if (link >= 0) {
    reported_coordinates(joint, at.x.data() + tree_.links[static_cast<std::size_t>(link)].first_coordinate, out.data());
    return;
  }
  // The previous row tells the turn on which a loop-closing joint is.
  std::array<double, 7> near{};
  std::array<double, 7> now{};
  stored_coordinates(joint, out.data(), near.data());
  const RelativePose relative = measure(joint, pose_at(at.q, joint.body_a), pose_at(at.q, joint.body_b));
  coordinates_of(joint, relative, near.data(), now.data());
  reported_coordinates(joint, now.data(), out.data());
}

void JointRecords::velocity(int j, const model::NodeView& at, std::span<double> out) const {
  const Joint& joint = tree_.joints[static_cast<std::size_t>(j)];
  const int link = link_of_joint_[static_cast<std::size_t>(j)];
  if (link < 0) {
    cut_velocity(joint, at, out);
    return;
  }
  const double* const rates = at.rate.data() + tree_.links[static_cast<std::size_t>(link)].first_rate;
  std::copy(rates, rates + joint.pattern.n_rates(), out.begin());
}

void JointRecords::cut_velocity(const Joint& joint, const model::NodeView& at, std::span<double> out) const {
  std::size_t k = 0;
  for (const Motion& motion : joint.pattern.motions) {
    if (motion.kind != Motion::Kind::ball) {
      out[k++] = JointCoordinate(joint, motion).rate(at.q, at.v);
      continue;
    }
    const Vector3d of_a = joint.body_a == ground ? Vector3d::Zero() : angular_velocity(at.q, at.v, joint.body_a);
    const Vector3d of_b = joint.body_b == ground ? Vector3d::Zero() : angular_velocity(at.q, at.v, joint.body_b);
    const Matrix3d e_a = pose_at(at.q, joint.body_a).orientation * joint.triad_a;
    write(e_a.transpose() * (of_b - of_a), out.subspan(k));
    k += 3;
  }
}

void JointRecords::refresh(const model::NodeView& at) {
  if (serial_ == at.serial) return;
  serial_ = at.serial;
  update_frame(tree_, at.q, frame_);
  // Without the loop-closing joints, the constraint forces of a subtree are those of the one joint that carries it.
  force_ = at.constraint_force;
  manifold_.add_constraint_forces(at.q, 1.0, at.multipliers, force_);
  wrenches_of(tree_, frame_, force_, wrenches_);
  accumulate_wrenches(tree_, frame_, wrenches_);
}

JointRecords::Wrench JointRecords::tree_wrench(int l) const {
  const TreeLink& link = tree_.links[static_cast<std::size_t>(l)];
  const LinkFrame& frame = frame_.links[static_cast<std::size_t>(l)];
  Wrench wrench = wrenches_.col(l);
  wrench.tail<3>() -= frame.lever.cross(Vector3d(wrench.head<3>()));  // about the connector of `to`
  return link.reversed ? Wrench(-wrench) : wrench;
}

JointRecords::Wrench JointRecords::cut_wrench(int j, const model::NodeView& at) const {
  const Joint& joint = tree_.joints[static_cast<std::size_t>(j)];
  Wrench wrench = Wrench::Zero();
  Eigen::VectorXd force = Eigen::VectorXd::Zero(at.q.size());
  for (std::size_t i = 0; i < manifold_.loop_rows().size(); ++i) {
    if (manifold_.loop_row_joint()[i] != j) continue;
    manifold_.loop_rows()[i].add_gradient(at.q, -at.multipliers[static_cast<Eigen::Index>(i)], force);
  }
  const bool on_ground = joint.body_b == ground;
  const int body = on_ground ? joint.body_a : joint.body_b;
  const Pose pose = pose_at(at.q, body);
  wrench.head<3>() = force.segment<3>(12 * body);
  for (int k = 0; k < 3; ++k) {
    wrench.tail<3>() += Vector3d(pose.orientation.col(k)).cross(Vector3d(force.segment<3>(12 * body + 3 + 3 * k)));
  }
  const Vector3d connector = pose_at(at.q, joint.body_b).point(joint.rho_b);
  wrench.tail<3>() -= (connector - pose.position).cross(Vector3d(wrench.head<3>()));
  return on_ground ? Wrench(-wrench) : wrench;
}

void JointRecords::reaction(int j, const model::NodeView& at, std::span<double> out) {
  refresh(at);
  const int link = link_of_joint_[static_cast<std::size_t>(j)];
  const Wrench wrench = link >= 0 ? tree_wrench(link) : cut_wrench(j, at);
  std::copy(wrench.data(), wrench.data() + 6, out.begin());
}

}  // namespace muldi::multibody
