#include "multibody/joint.hpp"

#include <cmath>
#include <numbers>

#include "math/rotation.hpp"

namespace muldi::multibody {
namespace {

double nearest_turn(double angle, double near) {
  constexpr double turn = 2.0 * std::numbers::pi;
  return angle + turn * std::round((near - angle) / turn);
}

double angle_of(const Motion& motion, const Eigen::Matrix3d& rotation) {
  double sine = 0.0;
  double cosine = 0.0;
  for (const TriadProduct& term : motion.sine) sine += term.sign * rotation(term.a, term.b);
  for (const TriadProduct& term : motion.cosine) cosine += term.sign * rotation(term.a, term.b);
  return std::atan2(sine, cosine);
}

}  // namespace

void Joint::align(const Pose& a, const Pose& b, const Eigen::Matrix3d& triad) {
  triad_a = a.orientation.transpose() * triad;
  triad_b = b.orientation.transpose() * triad;
  offset = triad.transpose() * (b.point(rho_b) - a.point(rho_a));
}

RelativePose relative_pose(const Joint& joint, const double* coordinates) {
  RelativePose relative{.translation = joint.offset};
  for (const Motion& motion : joint.pattern.motions) {
    switch (motion.kind) {
      case Motion::Kind::slide:
        relative.translation[motion.axis] += *coordinates;
        break;
      case Motion::Kind::rotation_a:
      case Motion::Kind::rotation_b:
        relative.rotation = relative.rotation * math::axis_rotation(motion.axis, *coordinates);
        break;
      case Motion::Kind::ball:
        relative.rotation = relative.rotation * math::quaternion_matrix(coordinates);
        break;
    }
    coordinates += motion.n_coordinates();
  }
  return relative;
}

Pose pose_of_b(const Joint& joint, const RelativePose& relative, const Pose& a) {
  const Eigen::Matrix3d e_a = a.orientation * joint.triad_a;
  Pose b;
  b.orientation = e_a * relative.rotation * joint.triad_b.transpose();
  b.position = a.point(joint.rho_a) + e_a * relative.translation - b.orientation * joint.rho_b;
  return b;
}

Pose pose_of_a(const Joint& joint, const RelativePose& relative, const Pose& b) {
  const Eigen::Matrix3d e_a = b.orientation * joint.triad_b * relative.rotation.transpose();
  Pose a;
  a.orientation = e_a * joint.triad_a.transpose();
  a.position = b.point(joint.rho_b) - e_a * relative.translation - a.orientation * joint.rho_a;
  return a;
}

RelativePose measure(const Joint& joint, const Pose& a, const Pose& b) {
  const Eigen::Matrix3d e_a = a.orientation * joint.triad_a;
  return {.translation = e_a.transpose() * (b.point(joint.rho_b) - a.point(joint.rho_a)),
          .rotation = e_a.transpose() * b.orientation * joint.triad_b};
}

void coordinates_of(const Joint& joint, const RelativePose& relative, const double* near, double* coordinates) {
  for (const Motion& motion : joint.pattern.motions) {
    switch (motion.kind) {
      case Motion::Kind::slide:
        *coordinates = relative.translation[motion.axis] - joint.offset[motion.axis];
        break;
      case Motion::Kind::rotation_a:
      case Motion::Kind::rotation_b:
        *coordinates = nearest_turn(angle_of(motion, relative.rotation), *near);
        break;
      case Motion::Kind::ball:
        math::matrix_quaternion(relative.rotation, coordinates);
        break;
    }
    coordinates += motion.n_coordinates();
    near += motion.n_coordinates();
  }
}

void reported_coordinates(const Joint& joint, const double* coordinates, double* reported) {
  for (const Motion& motion : joint.pattern.motions) {
    if (motion.kind == Motion::Kind::ball) {
      Eigen::Map<Eigen::Vector3d>(reported, 3) = math::quaternion_log(coordinates);
    } else {
      *reported = *coordinates;
    }
    coordinates += motion.n_coordinates();
    reported += motion.n_rates();
  }
}

void stored_coordinates(const Joint& joint, const double* reported, double* coordinates) {
  for (const Motion& motion : joint.pattern.motions) {
    if (motion.kind == Motion::Kind::ball) {
      math::quaternion_exp(Eigen::Map<const Eigen::Vector3d>(reported, 3), coordinates);
    } else {
      *coordinates = *reported;
    }
    coordinates += motion.n_coordinates();
    reported += motion.n_rates();
  }
}

void advance_coordinates(const Joint& joint, const double* coordinates, const double* rates, double* coordinates_new) {
  for (const Motion& motion : joint.pattern.motions) {
    if (motion.kind == Motion::Kind::ball) {
      math::quaternion_advance(coordinates, Eigen::Map<const Eigen::Vector3d>(rates, 3), coordinates_new);
    } else {
      *coordinates_new = *coordinates + *rates;
    }
    coordinates += motion.n_coordinates();
    coordinates_new += motion.n_coordinates();
    rates += motion.n_rates();
  }
}

void coordinate_difference(const Joint& joint, const double* from, const double* to, double* rates) {
  for (const Motion& motion : joint.pattern.motions) {
    if (motion.kind == Motion::Kind::ball) {
      Eigen::Map<Eigen::Vector3d>(rates, 3) = math::quaternion_difference(from, to);
    } else {
      *rates = *to - *from;
    }
    from += motion.n_coordinates();
    to += motion.n_coordinates();
    rates += motion.n_rates();
  }
}

model::LinearPoint body_point(int body, const Eigen::Vector3d& local) {
  if (body == ground) return model::LinearPoint::constant(local);
  model::LinearPoint point = body_direction(body, local);
  point.add(body, 12 * body, 1.0);
  return point;
}

model::LinearPoint body_direction(int body, const Eigen::Vector3d& local) {
  if (body == ground) return model::LinearPoint::constant(local);
  model::LinearPoint direction;
  for (int k = 0; k < 3; ++k) direction.add(body, 12 * body + 3 + 3 * k, local[k]);
  return direction;
}

std::vector<model::Bilinear> constraint_rows(const Joint& joint, double length) {
  const auto e_a = [&](int k) { return body_direction(joint.body_a, joint.triad_a.col(k)); };
  const auto e_b = [&](int k) { return body_direction(joint.body_b, joint.triad_b.col(k)); };
  const model::LinearPoint p = body_point(joint.body_b, joint.rho_b) - body_point(joint.body_a, joint.rho_a);
  std::vector<model::Bilinear> rows;
  for (const Constraint& constraint : joint.pattern.constraints) {
    switch (constraint.kind) {
      case Constraint::Kind::coincident:
        // Along the joint's axes, not the world's: of a planar loop that is turned in space the same rows are
        // redundant.
        for (int k = 0; k < 3; ++k) rows.push_back({.a = e_a(k), .b = p, .scale = 1.0 / length});
        break;
      case Constraint::Kind::no_slide:
        rows.push_back({.a = e_a(constraint.a), .b = p, .scale = 1.0 / length});
        break;
      case Constraint::Kind::perpendicular:
        rows.push_back({.a = e_a(constraint.a), .b = e_b(constraint.b)});
        break;
    }
  }
  return rows;
}

}  // namespace muldi::multibody
