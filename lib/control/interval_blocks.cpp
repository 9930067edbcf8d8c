#include "control/interval_blocks.hpp"

#include "control/end_pieces.hpp"

namespace muldi::control {
namespace {

constexpr std::array<double, 2> sign{-1.0, 1.0};

/// Fixed sizes for vectors between two points and for scalars.
template <int m>
using Square = Eigen::Matrix<double, m, m>;
template <int m>
using Vector = Eigen::Matrix<double, m, 1>;
/// Up to so many coordinates of a piece need no allocation.
constexpr int few = 12;
template <int m, int most>
using Wide = Eigen::Matrix<double, m, Eigen::Dynamic,
                           m == 1 && most != Eigen::Dynamic ? Eigen::RowMajor : Eigen::ColMajor, m, most>;
template <int most>
using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most, most>;
template <int most>
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, most, 1>;

/// The blocks of a tangent, by i (force) and j (motion).
template <int m>
struct NodeBlocks {
  std::array<std::array<Square<m>, 2>, 2> B;

  NodeBlocks(const Eigen::MatrixXd& tangent, Eigen::Index size, double h) {
    const auto F_x = tangent.topLeftCorner(size, size);
    const auto F_v = tangent.block(0, size, size, size);
    const auto p_x = tangent.block(size, 0, size, size);
    const auto p_v = tangent.block(size, size, size, size);
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) {
        B[i][j] = 0.25 * h * F_x + 0.5 * sign[j] * F_v + 0.5 * sign[i] * p_x + sign[i] * sign[j] / h * p_v;
      }
    }
  }
};

/// Adds a block on the piece's columns into a full one.
template <class Block>
void scatter(const Block& block, const std::vector<int>& rows, const std::vector<int>& columns, Eigen::MatrixXd& out) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      out(rows[r], columns[c]) += block(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
    }
  }
}
template <class Column>
void scatter_column(const Column& column, const std::vector<int>& rows, int c, Eigen::MatrixXd& out) {
  for (std::size_t r = 0; r < rows.size(); ++r) out(rows[r], c) += column[static_cast<Eigen::Index>(r)];
}
template <class Column>
void scatter_vector(const Column& column, const std::vector<int>& rows, Eigen::VectorXd& out) {
  for (std::size_t r = 0; r < rows.size(); ++r) out[rows[r]] += column[static_cast<Eigen::Index>(r)];
}

/// The choice that a piece's control is, or -1.
int choice_of(const IntervalFrame& frame, int control) {
  return control < 0 ? -1 : frame.choice_of_control[static_cast<std::size_t>(control)];
}

template <int m>
Vector<m> local_rate(const IntervalFrame& frame, const Piece& piece) {
  Vector<m> v = Vector<m>::Zero(piece.size);
  if (piece.rate >= 0) {
    v[0] = (frame.end.theta[piece.rate] - frame.begin.theta[piece.rate]) / frame.h;
  } else if (piece.coordinate != nullptr) {
    v[0] = piece.coordinate->advance(frame.begin.point.q, frame.end.point.q) / frame.h;
  } else {
    piece.apply(frame.v, v);
  }
  return v;
}

/// Calls add.operator()<m, most>() with the sizes of a piece.
template <class Add>
void with_sizes(const Piece& piece, const Add& add) {
  const bool is_small = piece.columns.size() <= few;
  if (piece.size == 3 && is_small) {
    add.template operator()<3, few>();
  } else if (piece.size == 1 && is_small) {
    add.template operator()<1, few>();
  } else {
    add.template operator()<Eigen::Dynamic, Eigen::Dynamic>();
  }
}

}  // namespace

template <int m, int most>
void JacobianSink::add_piece(const Piece& piece, const model::LocalExpansion& expansion) {
  const Eigen::Index size = piece.size;
  const auto k = static_cast<std::size_t>(frame_.k);
  const NodeBlocks<m> blocks(expansion.tangent, size, frame_.h);
  const Wide<m, most> J[2] = {frame_.begin.J[at_], frame_.end.J[at_]};
  Eigen::MatrixXd* const targets[2][2] = {{&out_.diagonal[k], &out_.next[k]},
                                          {&out_.previous[k + 1], &out_.diagonal[k + 1]}};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      const Wide<m, most> BJ = blocks.B[i][j].lazyProduct(J[j]);
      scatter(Block<most>(J[i].transpose().lazyProduct(BJ)), piece.columns, piece.columns, *targets[i][j]);
    }
  }
  for (std::size_t c = 0; c < piece.controls.size(); ++c) {
    const int choice = choice_of(frame_, piece.controls[c]);
    if (choice < 0) continue;
    const double slope = frame_.control_slope[static_cast<std::size_t>(choice)];
    const auto column = expansion.tangent.col(2 * size + static_cast<Eigen::Index>(c));
    for (std::size_t i = 0; i < 2; ++i) {
      const Vector<m> force = slope * (0.5 * frame_.h * column.head(size) + sign[i] * column.tail(size));
      scatter_column(Column<most>(J[i].transpose() * force), piece.columns, choice,
                     i == 0 ? out_.by_w_after[k] : out_.by_w_before[k + 1]);
    }
  }
  if (piece.coordinate != nullptr) add_end_piece(piece, expansion);
  if (frame_.layout.step < 0) return;
  const Vector<m> v = local_rate<m>(frame_, piece);
  const Vector<m> F_v = expansion.tangent.block(0, size, size, size) * v;
  const Vector<m> p_v = expansion.tangent.block(size, size, size, size) * v;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vector<m> force = -0.5 * F_v - sign[i] / frame_.h * p_v;
    scatter_vector(Column<most>(J[i].transpose() * force), piece.columns, out_.by_step[k + i]);
  }
}

void JacobianSink::add_end_piece(const Piece& piece, const model::LocalExpansion& expansion) {
  const auto k = static_cast<std::size_t>(frame_.k);
  const std::array<const DynamicsNode*, 2> nodes{&frame_.begin, &frame_.end};
  for (std::size_t i = 0; i < 2; ++i) {
    EndPiece(piece, nodes[i]->point, false).add_curvature(0.5 * frame_.h * expansion.force, out_.diagonal[k + i]);
    if (frame_.layout.step < 0) continue;
    scatter_vector(0.5 * expansion.force * nodes[i]->J[at_].row(0), piece.columns, out_.by_step[k + i]);
  }
}

void JacobianSink::add(const model::LocalForms&, const model::LocalExpansion& expansion) {
  const Piece& piece = frame_.list.pieces[at_];
  with_sizes(piece, [&]<int m, int most>() { add_piece<m, most>(piece, expansion); });
  ++at_;
}

template <int m, int most>
struct HessianSink::Local {
  Vector<m> a;
  Vector<m> b;
  Vector<m> v;
  std::array<Wide<m, most>, 2> J;
  std::array<Wide<m, most>, 2> A;
};

template <int m, int most>
HessianSink::Local<m, most> HessianSink::local(const Piece& piece) const {
  Local<m, most> at{.a = Vector<m>::Zero(piece.size),
                    .b = Vector<m>::Zero(piece.size),
                    .v = local_rate<m>(frame_, piece),
                    .J = {frame_.begin.J[at_], frame_.end.J[at_]},
                    .A = {frame_.begin.A[at_], frame_.end.A[at_]}};
  if (piece.rate >= 0) {
    at.a[0] = 0.5 * (adjoint_.m_begin[piece.rate] + adjoint_.m_end[piece.rate]);
    at.b[0] = (adjoint_.m_end[piece.rate] - adjoint_.m_begin[piece.rate]) / frame_.h;
  } else if (piece.coordinate != nullptr) {
    const double begin = EndPiece(piece, frame_.begin.point, true).along();
    const double end = EndPiece(piece, frame_.end.point, true).along();
    at.a[0] = 0.5 * (begin + end);
    at.b[0] = (end - begin) / frame_.h;
  } else {
    piece.apply(adjoint_.a, at.a);
    piece.apply(adjoint_.b, at.b);
  }
  return at;
}

template <int m, int most>
void HessianSink::add_piece(const Piece& piece, const model::LocalExpansion& expansion) {
  const Eigen::Index size = piece.size;
  const auto k = static_cast<std::size_t>(frame_.k);
  const double h = frame_.h;
  const Eigen::MatrixXd& T = expansion.tangent;
  const Eigen::MatrixXd& H = *expansion.hessian;
  const Local<m, most> at = local<m, most>(piece);
  if (piece.coordinate != nullptr) add_end_piece(piece, expansion, at.a[0]);
  if (piece.is_linear()) {
    // Gradients of Psi by xi and xi', and of Phi by xi_0, xi_1.
    const Vector<m> by_x =
        T.topLeftCorner(size, size).transpose() * at.a + T.block(size, 0, size, size).transpose() * at.b;
    const Vector<m> by_v =
        T.block(0, size, size, size).transpose() * at.a + T.block(size, size, size, size).transpose() * at.b;
    for (std::size_t i = 0; i < 2; ++i) {
      piece.add_transposed(Vector<m>(0.5 * h * by_x + sign[i] * by_v), out_.y[k + i]);
    }
  }
  const NodeBlocks<m> blocks(T, size, h);
  const Square<m> H_xx = H.topLeftCorner(size, size);
  const Square<m> H_xv = H.block(0, size, size, size);
  const Square<m> H_vv = H.block(size, size, size, size);
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const Square<m> qq =
          0.25 * h * H_xx + 0.5 * sign[j] * H_xv + 0.5 * sign[i] * H_xv.transpose() + sign[i] * sign[j] / h * H_vv;
      const Wide<m, most> X = qq.lazyProduct(at.J[j]) + blocks.B[j][i].transpose().lazyProduct(at.A[j]);
      const Wide<m, most> Y = blocks.B[i][j].lazyProduct(at.J[j]);
      const Block<most> block = at.J[i].transpose().lazyProduct(X) + at.A[i].transpose().lazyProduct(Y);
      scatter(block, piece.columns, piece.columns, i == j ? out_.diagonal[k + i] : out_.below[k]);
    }
  }
  add_controls(piece, expansion, at);
  if (frame_.layout.step >= 0) add_step(piece, expansion, at);
}

template <int m, int most>
void HessianSink::add_controls(const Piece& piece, const model::LocalExpansion& expansion, const Local<m, most>& at) {
  const Eigen::Index size = piece.size;
  const auto k = static_cast<std::size_t>(frame_.k);
  const double h = frame_.h;
  const Eigen::MatrixXd& T = expansion.tangent;
  const Eigen::MatrixXd& H = *expansion.hessian;
  for (std::size_t c = 0; c < piece.controls.size(); ++c) {
    const int choice = choice_of(frame_, piece.controls[c]);
    if (choice < 0) continue;
    const double slope = frame_.control_slope[static_cast<std::size_t>(choice)];
    const auto column = 2 * size + static_cast<Eigen::Index>(c);
    for (std::size_t i = 0; i < 2; ++i) {
      const Vector<m> q_s = slope * (0.5 * h * H.col(column).head(size) + sign[i] * H.col(column).segment(size, size));
      const Vector<m> a_s = slope * (0.5 * h * T.col(column).head(size) + sign[i] * T.col(column).tail(size));
      const Column<most> by_theta = at.J[i].transpose() * q_s + at.A[i].transpose() * a_s;
      Eigen::MatrixXd& target = i == 0 ? out_.w_begin[k] : out_.w_end[k];
      for (std::size_t r = 0; r < piece.columns.size(); ++r) {
        target(choice, piece.columns[r]) += by_theta[static_cast<Eigen::Index>(r)];
      }
    }
    for (std::size_t d = 0; d < piece.controls.size(); ++d) {
      const int other = choice_of(frame_, piece.controls[d]);
      if (other < 0) continue;
      out_.ww[k](choice, other) += h * slope * frame_.control_slope[static_cast<std::size_t>(other)] *
                                   H(column, 2 * size + static_cast<Eigen::Index>(d));
    }
    out_.step_w[k][choice] +=
        slope * (at.a.dot(T.col(column).head(size)) - H.col(column).segment(size, size).dot(at.v));
  }
}

template <int m, int most>
void HessianSink::add_step(const Piece& piece, const model::LocalExpansion& expansion, const Local<m, most>& at) {
  const Eigen::Index size = piece.size;
  const auto k = static_cast<std::size_t>(frame_.k);
  const double h = frame_.h;
  const Eigen::MatrixXd& T = expansion.tangent;
  const Eigen::MatrixXd& H = *expansion.hessian;
  const Vector<m> p_v_b = T.block(size, size, size, size).transpose() * at.b;
  const Vector<m> F_x_a = T.topLeftCorner(size, size).transpose() * at.a;
  const Vector<m> F_v = T.block(0, size, size, size) * at.v;
  const Vector<m> p_v = T.block(size, size, size, size) * at.v;
  const Vector<m> xv = H.block(0, size, size, size) * at.v;
  const Vector<m> vv = H.block(size, size, size, size) * at.v;
  for (std::size_t i = 0; i < 2; ++i) {
    const Vector<m> q_h = 0.5 * F_x_a - 0.5 * xv - sign[i] / h * (vv + p_v_b);
    const Vector<m> a_h = -0.5 * F_v - sign[i] / h * p_v;
    scatter_vector(Column<most>(at.J[i].transpose() * q_h + at.A[i].transpose() * a_h), piece.columns,
                   out_.step_theta[k + i]);
  }
  out_.step_step += (at.v.dot(vv) + 2.0 * p_v_b.dot(at.v)) / h;
}

void HessianSink::add_end_piece(const Piece& piece, const model::LocalExpansion& expansion, double along) {
  const auto k = static_cast<std::size_t>(frame_.k);
  const double by_value = expansion.tangent(0, 0) * along;
  const double by_rate = expansion.tangent(0, 1) * along;
  const std::array<const DynamicsNode*, 2> nodes{&frame_.begin, &frame_.end};
  for (std::size_t i = 0; i < 2; ++i) {
    const EndPiece at_node(piece, nodes[i]->point, true);
    at_node.add_curvature_along(0.5 * frame_.h * by_value + sign[i] * by_rate, 0.5 * frame_.h * expansion.force,
                                out_.y[k + i], out_.diagonal[k + i]);
    if (frame_.layout.step < 0) continue;
    scatter_vector(0.5 * expansion.force * nodes[i]->A[at_].row(0), piece.columns, out_.step_theta[k + i]);
  }
}

void HessianSink::add(const model::LocalForms&, const model::LocalExpansion& expansion) {
  const Piece& piece = frame_.list.pieces[at_];
  with_sizes(piece, [&]<int m, int most>() { add_piece<m, most>(piece, expansion); });
  ++at_;
}

}  // namespace muldi::control
