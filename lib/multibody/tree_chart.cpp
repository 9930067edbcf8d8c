#include "multibody/tree_chart.hpp"

#include <algorithm>

#include "math/rotation.hpp"
#include "multibody/tree_manifold.hpp"

namespace muldi::multibody {
namespace {

using Along = math::Dual<double>;

template <class S>
Vector3s<S> velocity(const ChartKinematics<S>& at, const MotionGroup& group, std::size_t rate, const Vector3s<S>& x) {
  if (group.slides()) return at.axis[rate];
  return cross<S>(at.axis[rate], x - at.pivot[rate]);
}

}  // namespace

TreeChart::TreeChart(const TreeManifold& manifold)
    : manifold_(manifold), tree_(manifold.tree()), link_of_body_(manifold.tree().link_of_body) {
  list_motions();
  resize(here_);
  resize(along_);
  weights_.force.resize(tree_.links.size());
  weights_.moment.resize(tree_.links.size());
  weights_along_.force.resize(tree_.links.size());
  weights_along_.moment.resize(tree_.links.size());
  set_reference(manifold.reference());
}

void TreeChart::list_motions() {
  is_coordinate_.assign(static_cast<std::size_t>(manifold_.n_v()), true);
  for (std::size_t l = 0; l < tree_.links.size(); ++l) {
    const TreeLink& link = tree_.links[l];
    const double sign = link.reversed ? -1.0 : 1.0;
    std::vector<MotionGroup> slides;
    std::vector<MotionGroup> turns;
    int coordinate = link.first_coordinate;
    int rate = link.first_rate;
    for (const Motion& motion : tree_.joint(link).pattern.motions) {
      const MotionGroup group{.kind = motion.kind,
                              .axis = motion.axis,
                              .coordinate = coordinate,
                              .rate = rate,
                              .sign = sign,
                              .link = static_cast<int>(l)};
      (group.slides() ? slides : turns).push_back(group);
      for (int k = 0; k < group.size() && motion.kind == Motion::Kind::ball; ++k) {
        is_coordinate_[static_cast<std::size_t>(rate + k)] = false;
      }
      coordinate += motion.n_coordinates();
      rate += motion.n_rates();
    }
    // Slides are along axes of A: they come first, and last where A hangs on B.
    std::vector<MotionGroup> ordered = slides;
    ordered.insert(ordered.end(), turns.begin(), turns.end());
    if (link.reversed) std::reverse(ordered.begin(), ordered.end());
    std::vector<int> own;
    for (const MotionGroup& group : ordered) {
      own.push_back(static_cast<int>(groups_.size()));
      groups_.push_back(group);
    }
    std::vector<int> path;
    if (link.parent != ground) {
      path = path_of_link_[static_cast<std::size_t>(tree_.link_of_body[static_cast<std::size_t>(link.parent)])];
    }
    path.insert(path.end(), own.begin(), own.end());
    std::vector<int> columns;
    for (const int g : path) {
      const MotionGroup& group = groups_[static_cast<std::size_t>(g)];
      for (int k = 0; k < group.size(); ++k) columns.push_back(group.rate + k);
    }
    std::sort(columns.begin(), columns.end());
    groups_of_link_.push_back(std::move(own));
    path_of_link_.push_back(std::move(path));
    columns_of_link_.push_back(std::move(columns));
  }
  for (int k = 0; k < manifold_.n_plain(); ++k) columns_of_plain_.push_back({tree_.n_rates + k});
}

template <class S>
void TreeChart::resize(ChartKinematics<S>& at) const {
  at.position.resize(tree_.links.size());
  at.orientation.resize(tree_.links.size());
  at.axis.resize(static_cast<std::size_t>(tree_.n_rates));
  at.pivot.resize(static_cast<std::size_t>(tree_.n_rates));
  at.axis_slope.resize(groups_.size());
}

void TreeChart::set_reference(const Eigen::VectorXd& x) {
  reference_ = Eigen::VectorXd::Zero(manifold_.n_x());
  ball_reference_.assign(groups_.size(), Eigen::Matrix3d::Identity());
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (groups_[g].kind != Motion::Kind::ball) continue;
    reference_.segment<4>(groups_[g].coordinate) = x.segment<4>(groups_[g].coordinate);
    ball_reference_[g] = math::quaternion_matrix(reference_.data() + groups_[g].coordinate);
  }
}

void TreeChart::coordinates(const Eigen::VectorXd& x, Eigen::VectorXd& theta) const {
  theta.resize(manifold_.n_v());
  manifold_.difference(reference_, x, theta);
}

void TreeChart::stored(const Eigen::VectorXd& theta, Eigen::VectorXd& x) const {
  x.resize(manifold_.n_x());
  manifold_.retract(reference_, theta, x);
}

const std::vector<int>& TreeChart::columns_of(int dof) const {
  if (dof >= 12 * tree_.n_bodies) return columns_of_plain_[static_cast<std::size_t>(dof - 12 * tree_.n_bodies)];
  return columns_of_link_[static_cast<std::size_t>(link_of_body_[static_cast<std::size_t>(dof / 12)])];
}

template <class S, class Value>
void TreeChart::place_group(const MotionGroup& group, const Value& value, Matrix3s<S>& E,
                            ChartKinematics<S>& at) const {
  const auto first = static_cast<std::size_t>(group.rate);
  if (group.kind != Motion::Kind::ball) {
    at.axis[first] = S(group.sign) * Vector3s<S>(E.col(group.axis));
    if (!group.slides()) turn_about(E, group.axis, S(group.sign * value(group.rate)));
    return;
  }
  const auto g = static_cast<std::size_t>(&group - groups_.data());
  Vector3s<S> v;
  for (int k = 0; k < 3; ++k) v[k] = group.sign * value(group.rate + k);
  const RotationVector<S> turned(v);
  if (group.sign < 0.0) E = apply(E, Eigen::Matrix3d(ball_reference_[g].transpose()));
  for (std::size_t a = 0; a < 3; ++a) {
    at.axis[first + a] = S(group.sign) * Vector3s<S>(E * turned.rates.col(static_cast<Eigen::Index>(a)));
  }
  const auto slopes = rotation_rate_slopes(v);
  for (std::size_t k = 0; k < slopes.size(); ++k) at.axis_slope[g][k] = E * slopes[k];
  E = Matrix3s<S>(E * turned.rotation);
  if (group.sign > 0.0) E = apply(E, ball_reference_[g]);
}

template <class S, class Value>
void TreeChart::place(const Value& value, ChartKinematics<S>& at) const {
  for (std::size_t l = 0; l < tree_.links.size(); ++l) {
    const TreeLink& link = tree_.links[l];
    const Joint& joint = tree_.joint(link);
    Matrix3s<S> parent = Matrix3s<S>::Identity();
    Vector3s<S> origin = Vector3s<S>::Zero();
    if (link.parent != ground) {
      const auto p = static_cast<std::size_t>(tree_.link_of_body[static_cast<std::size_t>(link.parent)]);
      parent = at.orientation[p];
      origin = at.position[p];
    }
    Matrix3s<S> E = apply(parent, link.reversed ? joint.triad_b : joint.triad_a);
    Vector3s<S> slide = Vector3s<S>::Zero();  // along the columns of e^A
    for (int k = 0; k < 3; ++k) slide[k] = S(joint.offset[k]);
    const Matrix3s<S> begin = E;
    for (const int g : groups_of_link_[l]) {
      const MotionGroup& group = groups_[static_cast<std::size_t>(g)];
      place_group(group, value, E, at);
      if (group.slides()) slide[group.axis] += value(group.rate);
    }
    at.orientation[l] = apply(E, Eigen::Matrix3d((link.reversed ? joint.triad_a : joint.triad_b).transpose()));
    Vector3s<S> pivot;
    if (link.reversed) {
      pivot = origin + apply(parent, joint.rho_b);
      at.position[l] = pivot - E * slide - apply(at.orientation[l], joint.rho_a);
    } else {
      pivot = origin + apply(parent, joint.rho_a) + begin * slide;
      at.position[l] = pivot - apply(at.orientation[l], joint.rho_b);
    }
    for (const int g : groups_of_link_[l]) {
      const MotionGroup& group = groups_[static_cast<std::size_t>(g)];
      for (int k = 0; k < group.size(); ++k) at.pivot[static_cast<std::size_t>(group.rate + k)] = pivot;
    }
  }
}

void TreeChart::prepare(model::ChartPoint& out) const {
  if (out.D.rows() == manifold_.n_q() && out.D.cols() == manifold_.n_v()) return;
  out.q = out.a = Eigen::VectorXd::Zero(manifold_.n_q());
  out.D = out.A = Eigen::MatrixXd::Zero(manifold_.n_q(), manifold_.n_v());
}

void TreeChart::evaluate(const Eigen::VectorXd& theta, model::ChartPoint& out) {
  prepare(out);
  place<double>([&](int k) { return theta[k]; }, here_);
  for (std::size_t l = 0; l < tree_.links.size(); ++l) {
    const int first = 12 * tree_.links[l].body;
    out.q.segment<3>(first) = here_.position[l];
    Eigen::Map<Eigen::Matrix3d>(out.q.data() + first + 3) = here_.orientation[l];
    for (const int g : path_of_link_[l]) {
      const MotionGroup& group = groups_[static_cast<std::size_t>(g)];
      for (int k = group.rate; k < group.rate + group.size(); ++k) {
        const auto rate = static_cast<std::size_t>(k);
        out.D.col(k).segment<3>(first) = velocity<double>(here_, group, rate, here_.position[l]);
        if (group.slides()) continue;
        for (int d = 0; d < 3; ++d) {
          out.D.col(k).segment<3>(first + 3 + 3 * d) =
              cross<double>(here_.axis[rate], Eigen::Vector3d(here_.orientation[l].col(d)));
        }
      }
    }
  }
  for (int k = 0; k < manifold_.n_plain(); ++k) {
    out.q[12 * tree_.n_bodies + k] = theta[tree_.n_rates + k];
    out.D(12 * tree_.n_bodies + k, tree_.n_rates + k) = 1.0;
  }
}

void TreeChart::evaluate_along(const Eigen::VectorXd& theta, const Eigen::VectorXd& mu, model::ChartPoint& out) {
  prepare(out);
  place<Along>([&](int k) { return Along(theta[k], mu[k]); }, along_);
  const auto write = [&](int at, int k, const Vector3s<Along>& v) {
    for (int r = 0; r < 3; ++r) {
      out.D(at + r, k) = v[r].value;
      out.A(at + r, k) = v[r].slope;
    }
  };
  for (std::size_t l = 0; l < tree_.links.size(); ++l) {
    const int first = 12 * tree_.links[l].body;
    for (int r = 0; r < 3; ++r) {
      out.q[first + r] = along_.position[l][r].value;
      out.a[first + r] = along_.position[l][r].slope;
      for (int d = 0; d < 3; ++d) {
        out.q[first + 3 + 3 * d + r] = along_.orientation[l](r, d).value;
        out.a[first + 3 + 3 * d + r] = along_.orientation[l](r, d).slope;
      }
    }
    for (const int g : path_of_link_[l]) {
      const MotionGroup& group = groups_[static_cast<std::size_t>(g)];
      for (int k = group.rate; k < group.rate + group.size(); ++k) {
        const auto rate = static_cast<std::size_t>(k);
        write(first, k, velocity<Along>(along_, group, rate, along_.position[l]));
        if (group.slides()) continue;
        for (int d = 0; d < 3; ++d) {
          write(first + 3 + 3 * d, k, cross<Along>(along_.axis[rate], Vector3s<Along>(along_.orientation[l].col(d))));
        }
      }
    }
  }
  for (int k = 0; k < manifold_.n_plain(); ++k) {
    const int dof = 12 * tree_.n_bodies + k;
    out.q[dof] = theta[tree_.n_rates + k];
    out.a[dof] = mu[tree_.n_rates + k];
    out.D(dof, tree_.n_rates + k) = 1.0;
  }
}

template <class S, class Weight>
void TreeChart::accumulate(const ChartKinematics<S>& at, const Weight& weight, SubtreeWeights<S>& sums) const {
  for (std::size_t l = tree_.links.size(); l-- > 0;) {
    const int first = 12 * tree_.links[l].body;
    Vector3s<S>& F = sums.force[l];
    Matrix3s<S>& N = sums.moment[l];
    for (int r = 0; r < 3; ++r) {
      F[r] = weight(first + r);
      const S z_1 = weight(first + 3 + r);
      const S z_2 = weight(first + 6 + r);
      const S z_3 = weight(first + 9 + r);
      for (int c = 0; c < 3; ++c) {
        N(r, c) = F[r] * at.position[l][c] + z_1 * at.orientation[l](c, 0) + z_2 * at.orientation[l](c, 1) +
                  z_3 * at.orientation[l](c, 2);
      }
    }
  }
  for (std::size_t l = tree_.links.size(); l-- > 0;) {
    if (tree_.links[l].parent == ground) continue;
    const auto p = static_cast<std::size_t>(tree_.link_of_body[static_cast<std::size_t>(tree_.links[l].parent)]);
    sums.force[p] += sums.force[l];
    sums.moment[p] += sums.moment[l];
  }
}

template <class S, class Number>
void TreeChart::add_second(const ChartKinematics<S>& at, const SubtreeWeights<S>& sums, const Number& number,
                           Eigen::Ref<Eigen::MatrixXd> H) const {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const MotionGroup& group = groups_[g];
    const auto l = static_cast<std::size_t>(group.link);
    const auto first = static_cast<std::size_t>(group.rate);
    Matrix3s<S> N;
    if (!group.slides()) N = moment_about(at.pivot[first], sums.force[l], sums.moment[l]);
    for (int k = 0; k < group.size(); ++k) {
      const int column = group.rate + k;
      const Vector3s<S>& axis = at.axis[static_cast<std::size_t>(column)];
      const Vector3s<S> response = group.slides() ? cross<S>(axis, sums.force[l]) : response_to_turn(N, axis);
      for (const int other : path_of_link_[l]) {
        if (other == static_cast<int>(g)) break;
        const MotionGroup& before = groups_[static_cast<std::size_t>(other)];
        for (int j = before.rate; j < before.rate + before.size() && !before.slides(); ++j) {
          const double value = number(dot(at.axis[static_cast<std::size_t>(j)], response));
          H(j, column) += value;
          H(column, j) += value;
        }
      }
      for (int j = 0; j < group.size() && !group.slides(); ++j) {
        S value = dot(at.axis[first + static_cast<std::size_t>(j)], response);
        if (group.kind == Motion::Kind::ball) {
          const Vector3s<S> turning(N(2, 1) - N(1, 2), N(0, 2) - N(2, 0), N(1, 0) - N(0, 1));
          value += dot(at.axis_slope[g][static_cast<std::size_t>(3 * j + k)], turning);
        }
        H(group.rate + j, column) += number(value);
      }
    }
  }
}

void TreeChart::add_curvature(const Eigen::VectorXd& y, Eigen::Ref<Eigen::MatrixXd> H) {
  accumulate(
      here_, [&](int dof) { return y[dof]; }, weights_);
  add_second(
      here_, weights_, [](double value) { return value; }, H);
}

void TreeChart::add_curvature_along(const Eigen::VectorXd& y, const Eigen::VectorXd& b, Eigen::Ref<Eigen::MatrixXd> H) {
  // The slope of z . q along mu with z = b + eps y is y . q + b . a.
  accumulate(
      along_, [&](int dof) { return Along(b[dof], y[dof]); }, weights_along_);
  add_second(
      along_, weights_along_, [](const Along& value) { return value.slope; }, H);
}

}  // namespace muldi::multibody
