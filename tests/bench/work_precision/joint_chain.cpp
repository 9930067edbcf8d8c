#include "bench/work_precision/joint_chain.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

namespace muldi::bench {

using Eigen::Matrix3d;
using Eigen::Vector3d;

JointChain::JointChain(std::vector<ChainLink> links, std::vector<ChainMuscle> muscles)
    : links_(std::move(links)), muscles_(std::move(muscles)) {}

void JointChain::move(const Coordinates& x, const Coordinates& v, Motions& at) const {
  Motion ground{.A = Matrix3d::Identity(),
                .pivot = Vector3d::Zero(),
                .axis = Vector3d::Zero(),
                .omega = Vector3d::Zero(),
                .alpha = Vector3d::Zero(),
                .pivot_velocity = Vector3d::Zero(),
                .pivot_acceleration = Vector3d::Zero()};
  const Motion* before = &ground;
  for (int i = 0; i < static_cast<int>(links_.size()); ++i) {
    Motion& now = at[static_cast<std::size_t>(i)];
    const Matrix3d B = before->A * links_[static_cast<std::size_t>(i)].place;
    const double c = std::cos(x[i]);
    const double s = std::sin(x[i]);
    now.A.col(0) = c * B.col(0) + s * B.col(1);
    now.A.col(1) = c * B.col(1) - s * B.col(0);
    now.A.col(2) = B.col(2);
    now.axis = B.col(2);
    now.omega = before->omega + v[i] * now.axis;
    now.alpha = before->alpha + v[i] * before->omega.cross(now.axis);
    const Vector3d r =
        i == 0 ? Vector3d::Zero() : Vector3d(before->A * links_[static_cast<std::size_t>(i) - 1].next_joint);
    const Vector3d turn = before->omega.cross(r);
    now.pivot = before->pivot + r;
    now.pivot_velocity = before->pivot_velocity + turn;
    now.pivot_acceleration = before->pivot_acceleration + before->alpha.cross(r) + before->omega.cross(turn);
    before = &now;
  }
}

void JointChain::add_body(int i, const Motions& at, Matrix& M, Coordinates& h) const {
  const ChainLink& link = links_[static_cast<std::size_t>(i)];
  const Motion& own = at[static_cast<std::size_t>(i)];
  const Vector3d r = own.A * link.centre;
  const Vector3d place = own.pivot + r;
  const Vector3d acceleration = own.pivot_acceleration + own.alpha.cross(r) + own.omega.cross(own.omega.cross(r));
  const Matrix3d inertia = own.A * link.inertia.asDiagonal() * own.A.transpose();
  const Vector3d force = -link.mass * acceleration;
  const Vector3d moment = -(inertia * own.alpha + own.omega.cross(inertia * own.omega));
  std::array<Vector3d, most_coordinates> by{};
  for (int j = 0; j <= i; ++j) {
    const Motion& joint = at[static_cast<std::size_t>(j)];
    by[static_cast<std::size_t>(j)] = joint.axis.cross(place - joint.pivot);
    h[j] += by[static_cast<std::size_t>(j)].dot(force) + joint.axis.dot(moment);
    const Vector3d spin = inertia * joint.axis;
    for (int k = 0; k <= j; ++k) {
      M(j, k) += link.mass * by[static_cast<std::size_t>(j)].dot(by[static_cast<std::size_t>(k)]) +
                 spin.dot(at[static_cast<std::size_t>(k)].axis);
    }
  }
}

void JointChain::add_muscle(const ChainMuscle& muscle, const Motions& at, const Coordinates& v, Matrix& M,
                            Coordinates& h) const {
  const int i = muscle.joint;
  const Motion& own = at[static_cast<std::size_t>(i)];
  const Motion* before = i == 0 ? nullptr : &at[static_cast<std::size_t>(i) - 1];
  const Vector3d from = before == nullptr ? muscle.from : Vector3d(before->A * muscle.from);
  const Vector3d to = own.A * muscle.to;
  // The midpoint, a mass; the link before carries one end of it, the link beyond the other.
  const Vector3d zero = Vector3d::Zero();
  const Vector3d& omega = before == nullptr ? zero : before->omega;
  const Vector3d& alpha = before == nullptr ? zero : before->alpha;
  const Vector3d from_acceleration = alpha.cross(from) + omega.cross(omega.cross(from));
  const Vector3d to_acceleration = own.alpha.cross(to) + own.omega.cross(own.omega.cross(to));
  const Vector3d force = -muscle.law.mass * (own.pivot_acceleration + 0.5 * (from_acceleration + to_acceleration));
  const Vector3d middle = own.pivot + 0.5 * (from + to);
  std::array<Vector3d, most_coordinates> by{};
  for (int j = 0; j <= i; ++j) {
    const Motion& joint = at[static_cast<std::size_t>(j)];
    Vector3d& mine = by[static_cast<std::size_t>(j)];
    mine = j < i ? Vector3d(joint.axis.cross(middle - joint.pivot)) : Vector3d(0.5 * joint.axis.cross(to));
    h[j] += mine.dot(force);
    for (int k = 0; k <= j; ++k) M(j, k) += muscle.law.mass * mine.dot(by[static_cast<std::size_t>(k)]);
  }
  // The axial motion, a function of the own angle alone.
  const Vector3d line = to - from;
  const double z = line.norm();
  const Vector3d slope = own.axis.cross(to);
  const double g = line.dot(slope) / z;
  const double zd = g * v[i];
  const double centripetal = line.dot(own.axis.cross(slope)) * v[i] * v[i];
  const double zdd = (slope.squaredNorm() * v[i] * v[i] - zd * zd + centripetal) / z;
  const double inertia = muscle.law.inertia(z);
  M(i, i) += inertia * g * g;
  h[i] += g * (muscle.law.force(z, zd) - inertia * zdd);
}

void JointChain::assemble(const Coordinates& x, const Coordinates& v, Matrix& M, Coordinates& h) const {
  Motions at;
  move(x, v, at);
  M.setZero(x.size(), x.size());
  h.setZero(x.size());
  for (int i = 0; i < static_cast<int>(links_.size()); ++i) add_body(i, at, M, h);
  for (const ChainMuscle& muscle : muscles_) add_muscle(muscle, at, v, M, h);
}

void JointChain::acceleration(const Coordinates& x, const Coordinates& v, Coordinates& a) const {
  Matrix M;
  assemble(x, v, M, a);
  M.llt().solveInPlace(a);
}

double JointChain::kinetic(const Coordinates& x, const Coordinates& v) const {
  Matrix M;
  Coordinates h;
  assemble(x, v, M, h);
  const Coordinates momentum = M.selfadjointView<Eigen::Lower>() * v;
  return 0.5 * v.dot(momentum);
}

double JointChain::potential(const Coordinates& x) const {
  Motions at;
  double sum = 0.0;
  for (const double sign : {1.0, -1.0}) {
    move(sign > 0.0 ? x : start(), Coordinates::Zero(x.size()), at);
    for (const ChainMuscle& muscle : muscles_) {
      const auto i = static_cast<std::size_t>(muscle.joint);
      const Vector3d from = muscle.joint == 0 ? muscle.from : Vector3d(at[i - 1].A * muscle.from);
      sum += sign * muscle.law.potential((at[i].A * muscle.to - from).norm());
    }
  }
  return sum;
}

}  // namespace muldi::bench
