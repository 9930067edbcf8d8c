#include "multibody/tree_manifold.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "multibody/projected_solvers.hpp"
#include "multibody/tree_chart.hpp"

namespace muldi::multibody {
namespace {

/// Pivots of B below this fraction of the largest belong to rows that depend on others (numerics, 1.9).
constexpr double rank_tolerance = 1e-10;
/// Pivots are angles or sizes of the scene. A largest one below this is round-off: the loop joins what the tree holds
/// together already.
constexpr double smallest_pivot = 1e-4;

/// Director orthonormality of one body (numerics, 1.6).
void add_director_rows(int body, std::vector<model::Bilinear>& rows) {
  const auto d = [&](int k) { return body_direction(body, Eigen::Vector3d::Unit(k)); };
  for (int k = 0; k < 3; ++k) rows.push_back({.a = d(k), .b = d(k), .constant = 1.0, .scale = 0.5});
  for (int k = 0; k < 3; ++k) rows.push_back({.a = d(k), .b = d((k + 1) % 3)});
}

const TreeFrame& tree_frame(const model::Frame& frame) { return static_cast<const TreeFrame&>(frame); }

/// Configuration of the bodies, for the gradients of the loop rows.
void write_poses(const KinematicTree& tree, const TreeFrame& frame) {
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const int first = 12 * tree.links[l].body;
    frame.q.segment<3>(first) = frame.links[l].pose.position;
    Eigen::Map<Eigen::Matrix3d>(frame.q.data() + first + 3) = frame.links[l].pose.orientation;
  }
}

Pose pose_of(const Eigen::VectorXd& q, int body) {
  if (body == ground) return {};
  return {.position = q.segment<3>(12 * body),
          .orientation = Eigen::Map<const Eigen::Matrix3d>(q.data() + 12 * body + 3)};
}

}  // namespace

TreeManifold::TreeManifold(KinematicTree tree, const std::vector<Pose>& poses, std::vector<double> plain, double length)
    : tree_(std::move(tree)), n_plain_(static_cast<int>(plain.size())), length_(length) {
  for (std::size_t j = static_cast<std::size_t>(tree_.n_user_joints()); j < tree_.joints.size(); ++j) {
    Joint& joint = tree_.joints[j];
    joint.align({}, poses[static_cast<std::size_t>(joint.body_b)], Eigen::Matrix3d::Identity());
  }
  reference_ = Eigen::VectorXd::Zero(n_x());
  for (const TreeLink& link : tree_.links) {
    Eigen::VectorXd zero = Eigen::VectorXd::Zero(6);
    stored_coordinates(tree_.joint(link), zero.data(), reference_.data() + link.first_coordinate);
  }
  for (int k = 0; k < n_plain_; ++k) reference_[tree_.n_coordinates + k] = plain[static_cast<std::size_t>(k)];

  for (int body = 0; body < tree_.n_bodies; ++body) add_director_rows(body, tree_rows_);
  for (const TreeLink& link : tree_.links) {
    for (const model::Bilinear& row : constraint_rows(tree_.joint(link), length_)) tree_rows_.push_back(row);
  }
  for (const int cut : tree_.cut_joints) {
    for (const model::Bilinear& row : constraint_rows(tree_.joints[static_cast<std::size_t>(cut)], length_)) {
      rows_.push_back(row);
      row_joint_.push_back(cut);
    }
  }
  if (rows_.empty()) return;
  scale_ = rate_scale();
  n_c_ = rank_in_scene_pose();
}

int TreeManifold::rank_in_scene_pose() const {
  if (n_v() == 0) return 0;
  Eigen::VectorXd q(n_q());
  configuration(reference_, q);
  const auto frame = make_frame();
  update(reference_, q, *frame);
  auto& at = static_cast<TreeFrame&>(*frame);
  decompose_loop_rows(at);
  const auto pivots = at.loop_pivots.matrixQR().diagonal().cwiseAbs();
  const double largest = std::max(pivots[0], smallest_pivot);
  int rank = 0;
  while (rank < pivots.size() && pivots[rank] > rank_tolerance * largest) ++rank;
  return rank;
}

Eigen::VectorXd TreeManifold::rate_scale() const {
  Eigen::VectorXd scale = Eigen::VectorXd::Constant(n_v(), length_);
  for (const TreeLink& link : tree_.links) {
    int k = link.first_rate;
    for (const Motion& motion : tree_.joint(link).pattern.motions) {
      for (int i = 0; i < motion.n_rates(); ++i, ++k) {
        if (motion.kind != Motion::Kind::slide) scale[k] = 1.0;
      }
    }
  }
  for (int k = 0; k < n_plain_; ++k) {
    const double size = std::abs(reference_[tree_.n_coordinates + k]);
    if (size > 0.0) scale[tree_.n_rates + k] = size;
  }
  return scale;
}

void TreeManifold::configuration(const Eigen::VectorXd& x, Eigen::VectorXd& q) const {
  for (const TreeLink& link : tree_.links) {
    const Joint& joint = tree_.joint(link);
    const RelativePose relative = relative_pose(joint, x.data() + link.first_coordinate);
    const Pose parent = pose_of(q, link.parent);
    const Pose pose = link.reversed ? pose_of_a(joint, relative, parent) : pose_of_b(joint, relative, parent);
    q.segment<3>(12 * link.body) = pose.position;
    Eigen::Map<Eigen::Matrix3d>(q.data() + 12 * link.body + 3) = pose.orientation;
  }
  q.tail(n_plain_) = x.tail(n_plain_);
}

void TreeManifold::retract(const Eigen::VectorXd& x, const Eigen::VectorXd& w, Eigen::VectorXd& x_new) const {
  for (const TreeLink& link : tree_.links) {
    advance_coordinates(tree_.joint(link), x.data() + link.first_coordinate, w.data() + link.first_rate,
                        x_new.data() + link.first_coordinate);
  }
  x_new.tail(n_plain_) = x.tail(n_plain_) + w.tail(n_plain_);
}

void TreeManifold::difference(const Eigen::VectorXd& x_from, const Eigen::VectorXd& x_to, Eigen::VectorXd& w) const {
  for (const TreeLink& link : tree_.links) {
    coordinate_difference(tree_.joint(link), x_from.data() + link.first_coordinate, x_to.data() + link.first_coordinate,
                          w.data() + link.first_rate);
  }
  w.tail(n_plain_) = x_to.tail(n_plain_) - x_from.tail(n_plain_);
}

std::unique_ptr<model::Chart> TreeManifold::make_chart() const { return std::make_unique<TreeChart>(*this); }

std::unique_ptr<model::Frame> TreeManifold::make_frame() const {
  auto frame = std::make_unique<TreeFrame>();
  frame->links.resize(tree_.links.size());
  frame->twists = Twists::Zero(6, static_cast<Eigen::Index>(tree_.links.size()));
  if (!rows_.empty()) {
    frame->q = Eigen::VectorXd::Zero(n_q());
    frame->gradient = Eigen::VectorXd::Zero(n_q());
    frame->row = Eigen::VectorXd::Zero(n_v());
    frame->all_rows = Eigen::MatrixXd::Zero(n_loop_rows(), n_v());
    frame->loop_pivots = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(n_loop_rows(), n_v());
    frame->workspace = Eigen::VectorXd::Zero(n_c());
    frame->loop_basis = Eigen::MatrixXd::Zero(n_loop_rows(), n_c());
    frame->loop_rows = Eigen::MatrixXd::Zero(n_c(), n_v());
    frame->other_rows = frame->loop_rows;
    frame->loop_product = Eigen::PartialPivLU<Eigen::MatrixXd>(n_c());
  }
  return frame;
}

void TreeManifold::update(const Eigen::VectorXd&, const Eigen::VectorXd& q, model::Frame& frame) const {
  update_frame(tree_, q, static_cast<TreeFrame&>(frame));
}

void TreeManifold::decompose_loop_rows(TreeFrame& frame) const {
  write_poses(tree_, frame);
  for (int i = 0; i < n_loop_rows(); ++i) {
    frame.gradient.setZero();
    rows_[static_cast<std::size_t>(i)].add_gradient(frame.q, 1.0, frame.gradient);
    project(frame, frame.gradient, frame.row);
    frame.all_rows.row(i) = frame.row.cwiseProduct(scale_).transpose();
  }
  frame.loop_pivots.compute(frame.all_rows);
}

model::LoopRank TreeManifold::choose_loop_rows(model::Frame& frame) const {
  if (rows_.empty() || n_v() == 0) return {};
  auto& at = static_cast<TreeFrame&>(frame);
  decompose_loop_rows(at);
  const Eigen::MatrixXd& qr = at.loop_pivots.matrixQR();
  const Eigen::Index n_rows = qr.rows();
  // Z: the first columns of Q; applied one by one, as Eigen's blocks of reflectors ask for memory.
  at.loop_basis.setIdentity();
  for (Eigen::Index k = n_c_ - 1; k >= 0; --k) {
    at.loop_basis.bottomRightCorner(n_rows - k, n_c_ - k)
        .applyHouseholderOnTheLeft(qr.col(k).tail(n_rows - k - 1), at.loop_pivots.hCoeffs()[k], at.workspace.data());
  }
  // Z^T B: the first rows of R.
  at.loop_rows.setZero();
  for (Eigen::Index j = 0; j < qr.cols(); ++j) {
    const Eigen::Index rate = at.loop_pivots.colsPermutation().indices()[j];
    const Eigen::Index n = std::min<Eigen::Index>(j + 1, n_c_);
    at.loop_rows.col(rate).head(n) = qr.col(j).head(n) / scale_[rate];
  }
  model::LoopRank rank;
  const double largest = std::abs(qr(0, 0));
  if (n_c_ > 0) rank.regularity = largest > 0.0 ? std::abs(qr(n_c_ - 1, n_c_ - 1)) / largest : 0.0;
  if (n_c_ < std::min(n_rows, qr.cols())) rank.excess = std::abs(qr(n_c_, n_c_));
  return rank;
}

const Eigen::MatrixXd& TreeManifold::loop_basis(const model::Frame& frame) const {
  return tree_frame(frame).loop_basis;
}

void TreeManifold::project(const model::Frame& frame, const Eigen::VectorXd& f, Eigen::VectorXd& r) const {
  const TreeFrame& at = tree_frame(frame);
  wrenches_of(tree_, at, f, at.twists);
  accumulate_wrenches(tree_, at, at.twists);
  joint_forces_of(tree_, at, at.twists, r);
  r.tail(n_plain_) = f.tail(n_plain_);
}

void TreeManifold::lift(const model::Frame& frame, const Eigen::VectorXd& w, Eigen::VectorXd& dq) const {
  const TreeFrame& at = tree_frame(frame);
  twists_of(tree_, at, w, at.twists);
  lift_twists(tree_, at, at.twists, dq);
  dq.tail(n_plain_) = w.tail(n_plain_);
}

void TreeManifold::add_forces_on_rates(const model::Frame& frame, double factor, const Eigen::VectorXd& on_rates,
                                       Eigen::VectorXd& f) const {
  add_drive_forces(tree_, tree_frame(frame), factor, on_rates, f);
  f.segment(12 * tree_.n_bodies, n_plain_) += factor * on_rates.tail(n_plain_);
}

void TreeManifold::constraints(const Eigen::VectorXd& q, Eigen::VectorXd& g) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) g[static_cast<Eigen::Index>(i)] = rows_[i].value(q);
}

void TreeManifold::add_constraint_forces(const Eigen::VectorXd& q, double factor, const Eigen::VectorXd& lambda,
                                         Eigen::VectorXd& f) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    rows_[i].add_gradient(q, factor * lambda[static_cast<Eigen::Index>(i)], f);
  }
}

double TreeManifold::violation(const Eigen::VectorXd& q) const {
  double largest = 0.0;
  for (const auto* rows : {&tree_rows_, &rows_}) {
    for (const model::Bilinear& row : *rows) largest = std::max(largest, std::abs(row.value(q)));
  }
  return largest;
}

void TreeManifold::project_tangent(const model::Frame& left, const model::Frame& right, const math::BlockMatrix& K,
                                   Eigen::MatrixXd& A) const {
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(n_v());
  Eigen::VectorXd dq(n_q());
  Eigen::VectorXd df(n_q());
  Eigen::VectorXd column(n_v());
  for (int k = 0; k < n_v(); ++k) {
    unit[k] = 1.0;
    lift(right, unit, dq);
    unit[k] = 0.0;
    K.multiply(dq, df);
    project(left, df, column);
    A.col(k) = column;
  }
}

void TreeManifold::project_constraints(const model::Frame& frame, const Eigen::MatrixXd& Z, Eigen::MatrixXd& B) const {
  if (Z.cols() == 0) return;
  const TreeFrame& at = tree_frame(frame);
  write_poses(tree_, at);
  for (Eigen::Index k = 0; k < Z.cols(); ++k) {
    at.gradient.setZero();
    for (Eigen::Index i = 0; i < Z.rows(); ++i) {
      if (Z(i, k) != 0.0) rows_[static_cast<std::size_t>(i)].add_gradient(at.q, Z(i, k), at.gradient);
    }
    project(frame, at.gradient, at.row);
    B.row(k) = at.row.transpose();
  }
}

void TreeManifold::add_curvature(const model::Frame& frame, const Eigen::VectorXd& f, const Eigen::VectorXd& lambda,
                                 Eigen::MatrixXd& A) const {
  const TreeFrame& at = tree_frame(frame);
  const auto n_links = static_cast<Eigen::Index>(tree_.links.size());
  Twists accumulated(6, n_links);
  wrenches_of(tree_, at, f, accumulated);
  accumulate_wrenches(tree_, at, accumulated);
  Twists twists(6, n_links);
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(n_v());
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(n_v());
  Eigen::VectorXd dq = Eigen::VectorXd::Zero(n_q());
  Eigen::VectorXd df(n_q());
  for (int k = 0; k < tree_.n_rates; ++k) {
    unit[k] = 1.0;
    twists_of(tree_, at, unit, twists);
    unit[k] = 0.0;
    projection_rate(tree_, at, twists, {f, accumulated}, rate);
    A.col(k) -= rate;
    if (rows_.empty()) continue;
    lift_twists(tree_, at, twists, dq);
    df.setZero();
    for (std::size_t i = 0; i < rows_.size(); ++i)
      rows_[i].add_hessian_times(dq, lambda[static_cast<Eigen::Index>(i)], df);
    project(frame, df, rate);
    A.col(k) += rate;
    rate.setZero();
  }
}

std::unique_ptr<model::ProjectedSolver> TreeManifold::make_solver(const math::BlockPattern& pattern,
                                                                  const std::string& kind) const {
  return make_projected_solver(*this, pattern, kind);
}

bool TreeManifold::loops_cross(const model::Frame& from, const model::Frame& to) const {
  if (n_c_ == 0) return false;
  const TreeFrame& begin = tree_frame(from);
  project_constraints(to, begin.loop_basis, begin.other_rows);
  begin.loop_product.compute(begin.loop_rows.lazyProduct(begin.other_rows.transpose()));
  return begin.loop_product.determinant() < 0.0;
}

model::Turn TreeManifold::largest_turn(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to) const {
  // |d_i' - d_i|^2 summed over the directors is 8 sin^2(angle/2).
  double largest = 0.0;
  model::Turn turn;
  for (int body = 0; body < tree_.n_bodies; ++body) {
    const double squares = (q_to.segment<9>(12 * body + 3) - q_from.segment<9>(12 * body + 3)).squaredNorm();
    if (squares <= largest) continue;
    largest = squares;
    turn.node = body;
  }
  turn.angle = 2.0 * std::asin(std::min(1.0, std::sqrt(largest / 8.0)));
  return turn;
}

}  // namespace muldi::multibody
