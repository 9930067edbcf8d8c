#include "control/end_pieces.hpp"

namespace muldi::control {

EndPiece::EndPiece(const Piece& piece, const model::ChartPoint& point, bool along)
    : piece_(piece), point_(point), D_(part_of(point.D)) {
  piece.coordinate->differentiate(point.q, along ? &point.a : nullptr, at_);
}

Eigen::MatrixXd EndPiece::part_of(const Eigen::MatrixXd& D) const { return D(piece_.entries, piece_.columns); }

Eigen::VectorXd EndPiece::bend() const { return at_.hessian * point_.a(piece_.entries); }

Eigen::MatrixXd EndPiece::J() const { return at_.gradient.transpose() * D_; }

Eigen::MatrixXd EndPiece::A() const { return bend().transpose() * D_ + at_.gradient.transpose() * part_of(point_.A); }

double EndPiece::along() const { return at_.gradient.dot(point_.a(piece_.entries)); }

void EndPiece::add_value(double factor, Eigen::VectorXd& y) const { y(piece_.entries) += factor * at_.gradient; }

void EndPiece::add_curvature(double factor, Eigen::MatrixXd& out) const {
  out(piece_.columns, piece_.columns) += factor * D_.transpose() * at_.hessian * D_;
}

void EndPiece::add_curvature_along(double by_value, double force, Eigen::VectorXd& y, Eigen::MatrixXd& out) const {
  y(piece_.entries) += by_value * at_.gradient + force * bend();
  const Eigen::MatrixXd mixed = force * D_.transpose() * at_.hessian * part_of(point_.A);
  out(piece_.columns, piece_.columns) +=
      D_.transpose() * (by_value * at_.hessian + force * at_.hessian_slope) * D_ + mixed + mixed.transpose();
}

}  // namespace muldi::control
