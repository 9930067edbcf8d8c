#include "control/cut_coordinate.hpp"

#include <set>

namespace muldi::control {

CutCoordinate::CutCoordinate(const model::EndCoordinate& coordinate, const model::Chart& chart)
    : piece_{.entries = coordinate.unknowns(), .coordinate = &coordinate, .size = 1} {
  std::set<int> columns;
  for (const int dof : piece_.entries) {
    const std::vector<int>& of_dof = chart.columns_of(dof);
    columns.insert(of_dof.begin(), of_dof.end());
  }
  piece_.columns = {columns.begin(), columns.end()};
}

Eigen::RowVectorXd CutCoordinate::gradient(const model::ChartPoint& at) const {
  Eigen::RowVectorXd out = Eigen::RowVectorXd::Zero(at.D.cols());
  out(piece_.columns) = EndPiece(piece_, at, false).J().row(0);
  return out;
}

void CutCoordinate::add_hessian(double factor, const model::ChartPoint& at, Eigen::VectorXd& y,
                                Eigen::MatrixXd& H) const {
  const EndPiece piece(piece_, at, false);
  piece.add_value(factor, y);
  piece.add_curvature(factor, H);
}

}  // namespace muldi::control
