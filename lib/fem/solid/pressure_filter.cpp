#include "fem/solid/pressure_filter.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "math/sparse_ldlt.hpp"
#include "math/vector_loops.hpp"

namespace muldi::fem {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Square of the force of a pressure pattern, relative to that of a single cell, below which it counts as none.
constexpr double no_force = 1e-8;
constexpr double shift = 1e-10;
constexpr int n_sweeps = 3;

/// Forces of unit pressures on the free nodes: V_e g_e with the other entries zero, [cell][8][3], scaled to length one.
struct UnitForces {
  VectorXd values;
  VectorXd lengths;  // before
};

UnitForces unit_forces(const ElementSet& elements, const SolidUnknowns& unknowns, const VectorXd& volumes) {
  const Eigen::Index n_cells = elements.n_cells();
  UnitForces forces{VectorXd::Zero(24 * n_cells), VectorXd::Zero(n_cells)};
  elements.volumes(elements.reference().data(), nullptr, {.gradient = forces.values.data()});
  for (Eigen::Index cell = 0; cell < n_cells; ++cell) {
    auto of_cell = forces.values.segment<24>(24 * cell);
    of_cell *= volumes[cell];
    const double whole = of_cell.norm();
    for (int a = 0; a < 8; ++a) {
      const int node = elements.cells()[static_cast<std::size_t>(cell)][static_cast<std::size_t>(a)];
      for (int i = 0; i < 3; ++i) {
        if (!unknowns.is_free(node, i)) of_cell[3 * a + i] = 0.0;
      }
    }
    // A cell with hardly a free node is not blown up.
    forces.lengths[cell] = std::max(of_cell.norm(), 1e-2 * whole);
    of_cell /= forces.lengths[cell];
  }
  return forces;
}

/// Cells at every node, ascending.
std::vector<std::vector<int>> cells_of_nodes(const ElementSet& elements) {
  std::vector<std::vector<int>> of(static_cast<std::size_t>(elements.n_nodes()));
  for (int cell = 0; cell < elements.n_cells(); ++cell) {
    for (const int node : elements.cells()[static_cast<std::size_t>(cell)]) {
      of[static_cast<std::size_t>(node)].push_back(cell);
    }
  }
  return of;
}

std::vector<std::pair<int, int>> neighbours(const std::vector<std::vector<int>>& at_node) {
  std::vector<std::pair<int, int>> pairs;
  for (const std::vector<int>& cells : at_node) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      for (std::size_t j = i + 1; j < cells.size(); ++j) pairs.emplace_back(cells[i], cells[j]);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// Products of the forces of all pairs of cells.
void fill_products(const ElementSet& elements, const std::vector<std::vector<int>>& at_node, const UnitForces& forces,
                   math::SymmetricBlockMatrix& G) {
  const auto corner = [&](int cell, int node) {
    const auto& nodes = elements.cells()[static_cast<std::size_t>(cell)];
    return std::find(nodes.begin(), nodes.end(), node) - nodes.begin();
  };
  for (std::size_t node = 0; node < at_node.size(); ++node) {
    for (const int e : at_node[node]) {
      const auto f_e = forces.values.segment<3>(24L * e + 3 * corner(e, static_cast<int>(node)));
      for (const int f : at_node[node]) {
        if (f < e) continue;
        const auto f_f = forces.values.segment<3>(24L * f + 3 * corner(f, static_cast<int>(node)));
        G.values()[static_cast<std::size_t>(G.pattern().slot(e, f))] += f_e.dot(f_f);
      }
    }
  }
}

/// Eigenvectors of G with eigenvalues below `no_force`, by inverse iteration on as many vectors as are needed.
MatrixXd null_vectors(const math::SymmetricBlockMatrix& G, math::SparseLdlt& shifted) {
  const Eigen::Index n = G.n_rows();
  for (Eigen::Index width = std::min<Eigen::Index>(n, 8);; width = std::min(n, 2 * width)) {
    MatrixXd X(n, width);
    for (Eigen::Index i = 0; i < X.size(); ++i) X.data()[i] = math::rough_entry(i);
    for (int sweep = 0; sweep < n_sweeps; ++sweep) {
      X = Eigen::HouseholderQR<MatrixXd>(X).householderQ() * MatrixXd::Identity(n, width);
      shifted.solve_columns(X);
    }
    X = Eigen::HouseholderQR<MatrixXd>(X).householderQ() * MatrixXd::Identity(n, width);
    MatrixXd GX(n, width);
    for (Eigen::Index k = 0; k < width; ++k) G.multiply(X.col(k), GX.col(k));
    const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(X.transpose() * GX);
    const Eigen::Index found = (ritz.eigenvalues().array() < no_force).count();
    if (found < width || width == n) return X * ritz.eigenvectors().leftCols(found);
  }
}

}  // namespace

// Held side faces of a regular box are enough for patterns: across an open face the forces of (-1)^(i+j) f(k) cancel
// too.
PressureFilter::PressureFilter(const ElementSet& elements, const SolidUnknowns& unknowns, const VectorXd& volumes)
    : volumes_(volumes) {
  if (elements.n_cells() > most_cells) return;
  const UnitForces forces = unit_forces(elements, unknowns, volumes);
  const std::vector<std::vector<int>> at_node = cells_of_nodes(elements);
  const math::SymmetricBlockPattern pattern(elements.n_cells(), 1, {}, neighbours(at_node));
  math::SymmetricBlockMatrix G(pattern);
  fill_products(elements, at_node, forces, G);
  const math::LdltAnalysis analysis(pattern);
  math::SparseLdlt factor(analysis);
  const math::LdltOutcome outcome = factor.factorise(G);
  if (outcome.ok && outcome.n_negative == 0 && outcome.smallest_ratio > no_force) return;
  for (int cell = 0; cell < elements.n_cells(); ++cell) {
    G.values()[static_cast<std::size_t>(pattern.slot(cell, cell))] += shift;
  }
  if (!factor.factorise(G).ok) return;
  patterns_ = forces.lengths.cwiseInverse().asDiagonal() * null_vectors(G, factor);
  const MatrixXd gram = patterns_.transpose() * volumes_.asDiagonal() * patterns_;
  const MatrixXd lower = Eigen::LLT<MatrixXd>(gram).matrixL();
  patterns_ = lower.triangularView<Eigen::Lower>().solve(patterns_.transpose()).transpose().eval();
  parts_.setZero(patterns_.cols());
}

void PressureFilter::keep_pressures(Eigen::Ref<VectorXd> p) const {
  if (n_patterns() == 0) return;
  parts_.noalias() = patterns_.transpose() * volumes_.cwiseProduct(p);
  p.noalias() -= patterns_ * parts_;
}

void PressureFilter::keep_rows(Eigen::Ref<VectorXd> rows) const {
  if (n_patterns() == 0) return;
  parts_.noalias() = patterns_.transpose() * rows;
  rows -= volumes_.cwiseProduct(patterns_ * parts_);
}

void PressureFilter::add_patterns(double factor, const VectorXd& p, VectorXd& out) const {
  if (n_patterns() == 0) return;
  parts_.noalias() = patterns_.transpose() * volumes_.cwiseProduct(p);
  out += factor * volumes_.cwiseProduct(patterns_ * parts_);
}

}  // namespace muldi::fem
