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
/// What acts on bonded nodes acts on those that they are fixed to.
struct UnitForces {
  struct OnNode {
    int cell = 0;
    Eigen::Vector3d force = {};
  };
  std::vector<std::vector<OnNode>> at_node;  // by cell, ascending
  VectorXd lengths;                          // before
};

UnitForces unit_forces(const ElementSet& elements, const SolidUnknowns& unknowns, const Bonds& bonds) {
  const int n_cells = elements.n_cells();
  UnitForces forces{std::vector<std::vector<UnitForces::OnNode>>(static_cast<std::size_t>(elements.n_nodes())),
                    VectorXd::Zero(n_cells)};
  VectorXd gradients = VectorXd::Zero(24L * n_cells);
  elements.volumes(elements.reference().data(), nullptr, {.gradient = gradients.data()});
  std::vector<std::pair<int, Eigen::Vector3d>> of_cell;
  for (int cell = 0; cell < n_cells; ++cell) {
    of_cell.clear();
    const double whole = elements.cell_volumes()[cell] * gradients.segment<24>(24L * cell).norm();
    for (int a = 0; a < 8; ++a) {
      const Eigen::Vector3d force = elements.cell_volumes()[cell] * gradients.segment<3>(24L * cell + 3L * a);
      const auto stays = bonds.terms(elements.cells()[static_cast<std::size_t>(cell)][static_cast<std::size_t>(a)]);
      for (std::size_t k = 0; k < stays.nodes.size(); ++k) {
        auto at = std::find_if(of_cell.begin(), of_cell.end(), [&](auto& one) { return one.first == stays.nodes[k]; });
        if (at == of_cell.end()) at = of_cell.insert(at, {stays.nodes[k], Eigen::Vector3d::Zero()});
        at->second += stays.of_position[k] * force;
      }
    }
    double squares = 0.0;
    for (auto& [node, force] : of_cell) {
      for (int i = 0; i < 3; ++i) {
        if (!unknowns.is_free(node, i)) force[i] = 0.0;
      }
      squares += force.squaredNorm();
    }
    // A cell with hardly a free node is not blown up.
    forces.lengths[cell] = std::max(std::sqrt(squares), 1e-2 * whole);
    for (const auto& [node, force] : of_cell) {
      forces.at_node[static_cast<std::size_t>(node)].push_back({cell, force / forces.lengths[cell]});
    }
  }
  return forces;
}

std::vector<std::pair<int, int>> neighbours(const UnitForces& forces) {
  std::vector<std::pair<int, int>> pairs;
  for (const auto& at_node : forces.at_node) {
    for (std::size_t i = 0; i < at_node.size(); ++i) {
      for (std::size_t j = i + 1; j < at_node.size(); ++j) pairs.emplace_back(at_node[i].cell, at_node[j].cell);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// Products of the forces of all pairs of cells.
void fill_products(const UnitForces& forces, math::SymmetricBlockMatrix& G) {
  for (const auto& at_node : forces.at_node) {
    for (const UnitForces::OnNode& e : at_node) {
      for (const UnitForces::OnNode& f : at_node) {
        if (f.cell < e.cell) continue;
        G.values()[static_cast<std::size_t>(G.pattern().slot(e.cell, f.cell))] += e.force.dot(f.force);
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
PressureFilter::PressureFilter(const ElementSet& elements, const SolidUnknowns& unknowns, const Bonds& bonds)
    : volumes_(elements.cell_volumes()) {
  if (elements.n_cells() > most_cells) return;
  const UnitForces forces = unit_forces(elements, unknowns, bonds);
  const math::SymmetricBlockPattern pattern(elements.n_cells(), 1, {}, neighbours(forces));
  math::SymmetricBlockMatrix G(pattern);
  fill_products(forces, G);
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
