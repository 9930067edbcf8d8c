/// A nearly incompressible block in deal.II: trilinear displacements with one pressure and one dilatation a cell, both
/// eliminated (mean dilatation, Q1-P0), mechanics alone. The rival of our formulation II in statics, built with
/// MULDI_PEERS where libdeal.ii-dev is installed; it shares no code with lib/.
///
/// Block of edge 10 on its clamped lower face, a dead traction on its upper face, which stays in the middle:
/// neo-Hookean mu/2 (J^-2/3 tr C - 3) with kappa/2 (v/V - 1)^2 of the mean dilatation v/V of each cell. Full Newton,
/// tangent of the condensed form, UMFPACK; one thread.
///
/// Arguments: cells a side, load steps, traction (MPa), mu (MPa), kappa (MPa). Prints: the horizontal displacement of
/// the corner (10, 10, 10), Newton iterations, processor seconds.
#include <deal.II/base/multithread_info.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace {

using namespace dealii;

struct Given {
  unsigned cells = 8;
  int steps = 10;
  double traction = 0.01;
  double mu = 0.233;
  double kappa = 1000.0;
};

class Block {
 public:
  explicit Block(const Given& given)
      : given_(given), fe_(FE_Q<3>(1), 3), dofs_(mesh_), quadrature_(2), face_quadrature_(2) {
    GridGenerator::subdivided_hyper_cube(mesh_, given.cells, 0.0, 10.0);
    dofs_.distribute_dofs(fe_);
    for (const auto& cell : dofs_.active_cell_iterators()) {
      for (unsigned v = 0; v < 8; ++v) {
        for (unsigned i = 0; i < 3; ++i) {
          if (cell->vertex(v)[2] < 1e-9) constraints_.add_line(cell->vertex_dof_index(v, i));
        }
      }
    }
    constraints_.close();
    DynamicSparsityPattern dynamic(dofs_.n_dofs());
    DoFTools::make_sparsity_pattern(dofs_, dynamic, constraints_, false);
    pattern_.copy_from(dynamic);
    matrix_.reinit(pattern_);
    for (Vector<double>* v : {&u_, &rhs_, &step_}) v->reinit(dofs_.n_dofs());
    for (unsigned i = 0; i < 24; ++i) {
      const auto [component, node] = fe_.system_to_component_index(i);
      local_[node][component] = i;
    }
  }

  bool run() {
    for (int load = 1; load <= given_.steps; ++load) {
      double size = 1.0;
      for (int i = 0; i < 30 && size > 1e-10; ++i) {
        assemble(given_.traction * load / given_.steps);
        SparseDirectUMFPACK solver;
        solver.initialize(matrix_);
        solver.vmult(step_, rhs_);
        constraints_.set_zero(step_);
        u_ += step_;
        size = step_.linfty_norm() / (10.0 * std::sqrt(3.0));
        ++newton_;
      }
      if (!(size <= 1e-10)) return false;
    }
    return true;
  }

  int newton() const { return newton_; }
  double displacement() const {
    for (const auto& cell : dofs_.active_cell_iterators()) {
      for (unsigned v = 0; v < 8; ++v) {
        if (cell->vertex(v).distance(Point<3>(10, 10, 10)) < 1e-9) return u_[cell->vertex_dof_index(v, 0)];
      }
    }
    return std::nan("");
  }

 private:
  void assemble(double traction) {
    matrix_ = 0.0;
    rhs_ = 0.0;
    FEValues<3> values(fe_, quadrature_, update_gradients | update_JxW_values);
    FEFaceValues<3> face_values(fe_, face_quadrature_, update_values | update_JxW_values);
    FullMatrix<double> K(24, 24);
    Vector<double> r(24);
    std::vector<types::global_dof_index> dofs(24);
    for (const auto& cell : dofs_.active_cell_iterators()) {
      values.reinit(cell);
      cell->get_dof_indices(dofs);
      K = 0.0;
      r = 0.0;
      add_cell(values, dofs, K, r);
      for (const unsigned f : cell->face_indices()) {
        if (!cell->face(f)->at_boundary() || cell->face(f)->center()[2] < 10.0 - 1e-9) continue;
        face_values.reinit(cell, f);
        for (unsigned q = 0; q < face_quadrature_.size(); ++q) {
          for (unsigned a = 0; a < 8; ++a) {
            r[local_[a][0]] += traction * face_values.shape_value(local_[a][0], q) * face_values.JxW(q);
          }
        }
      }
      constraints_.distribute_local_to_global(K, r, dofs, matrix_, rhs_);
    }
  }

  void add_cell(const FEValues<3>& values, const std::vector<types::global_dof_index>& dofs, FullMatrix<double>& K,
                Vector<double>& r) const {
    std::array<Tensor<2, 3>, 8> F, inverse;
    std::array<double, 8> J{};
    double volume = 0.0;
    double deformed = 0.0;
    for (unsigned q = 0; q < 8; ++q) {
      F[q] = unit_symmetric_tensor<3>();
      for (unsigned a = 0; a < 8; ++a) {
        const Tensor<1, 3> dN = values.shape_grad(local_[a][0], q);
        for (unsigned i = 0; i < 3; ++i) F[q][i] += u_[dofs[local_[a][i]]] * dN;
      }
      J[q] = determinant(F[q]);
      inverse[q] = invert(F[q]);
      volume += values.JxW(q);
      deformed += J[q] * values.JxW(q);
    }
    const double pressure = given_.kappa * (deformed / volume - 1.0);
    std::array<double, 24> dv{};  // derivatives of the deformed volume
    for (unsigned q = 0; q < 8; ++q) add_point(values, q, F[q], inverse[q], J[q], pressure, dv, K, r);
    for (unsigned i = 0; i < 24; ++i) {
      r[i] -= pressure * dv[i];
      for (unsigned j = 0; j < 24; ++j) K(i, j) += given_.kappa / volume * dv[i] * dv[j];
    }
  }

  /// In spatial gradients g = F^-T dN: the isochoric stress, its tangent and that of the pressure.
  void add_point(const FEValues<3>& values, unsigned q, const Tensor<2, 3>& F, const Tensor<2, 3>& inverse, double J,
                 double pressure, std::array<double, 24>& dv, FullMatrix<double>& K, Vector<double>& r) const {
    const double w = values.JxW(q);
    const double m = given_.mu * std::pow(J, -2.0 / 3.0);
    const double trace = scalar_product(F, F) / 3.0;
    std::array<Tensor<1, 3>, 8> dN, g, h;  // h: rows of P_iso dN
    for (unsigned a = 0; a < 8; ++a) {
      dN[a] = values.shape_grad(local_[a][0], q);
      g[a] = transpose(inverse) * dN[a];
      h[a] = F * dN[a];
      const Tensor<1, 3> force = m * (h[a] - trace * g[a]);
      for (unsigned i = 0; i < 3; ++i) {
        r[local_[a][i]] -= w * force[i];
        dv[local_[a][i]] += w * J * g[a][i];
      }
    }
    const double c1 = 2.0 / 3.0 * m;
    const double jp = J * pressure;
    for (unsigned a = 0; a < 8; ++a) {
      for (unsigned b = 0; b < 8; ++b) {
        const double plain = m * (dN[a] * dN[b]);
        for (unsigned i = 0; i < 3; ++i) {
          for (unsigned j = 0; j < 3; ++j) {
            // d/dF_j. of m (F - t F^-T) contracted with dN_a, dN_b; and of p J F^-T.
            double k = -c1 * (h[a][i] * g[b][j] + g[a][i] * h[b][j]) + c1 * trace * g[a][i] * g[b][j] +
                       m * trace * g[b][i] * g[a][j] + jp * (g[a][i] * g[b][j] - g[b][i] * g[a][j]);
            if (i == j) k += plain;
            K(local_[a][i], local_[b][j]) += w * k;
          }
        }
      }
    }
  }

  Given given_;
  Triangulation<3> mesh_;
  FESystem<3> fe_;
  DoFHandler<3> dofs_;
  QGauss<3> quadrature_;
  QGauss<2> face_quadrature_;
  AffineConstraints<double> constraints_;
  std::array<std::array<unsigned, 3>, 8> local_{};
  SparsityPattern pattern_;
  SparseMatrix<double> matrix_;
  Vector<double> u_, rhs_, step_;
  int newton_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  MultithreadInfo::set_thread_limit(1);
  Given given;
  if (argc > 1) given.cells = static_cast<unsigned>(std::atoi(argv[1]));
  if (argc > 2) given.steps = std::atoi(argv[2]);
  if (argc > 3) given.traction = std::atof(argv[3]);
  if (argc > 4) given.mu = std::atof(argv[4]);
  if (argc > 5) given.kappa = std::atof(argv[5]);
  const std::clock_t start = std::clock();
  Block block(given);
  const bool converged = block.run();
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  std::printf("%.12g %d %.6g\n", converged ? block.displacement() : std::nan(""), block.newton(), seconds);
}
