/// The scene cube_scaling written for deal.II with care: the peer that our times are compared to (built with
/// MULDI_PEERS where libdeal.ii-dev is installed; shares no code with lib/).
///
/// The same equations: one unknown potential a step, variational midpoint rule, Bonet and Wood with the legacy electric
/// law and Kelvin and Voigt's viscosity, eight Gauss points. Assembly by WorkStream on two threads; the loops know
/// which component a shape function belongs to: F, P and the tangent are contracted with scalar gradients once a node,
/// and the 12 x 12 tangent is applied to node pairs. The linear system is solved by GMRES with SSOR on the
/// displacements and ML (Trilinos' algebraic multigrid) on the potential; Newton's method to the same increments as
/// ours.
///
/// Prints one line: assembly in microseconds a cell and core, seconds of the steps, of their assembly and of their
/// solves, iterations, height, processor seconds of the steps.
#include <deal.II/base/multithread_info.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/work_stream.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/block_sparse_matrix.h>
#include <deal.II/lac/block_vector.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_gmres.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>

namespace {

using namespace dealii;
using Clock = std::chrono::steady_clock;

constexpr double mu = 0.233, lambda = 999.8, c1 = 5e-8, c2 = 1e-9, eps0 = 8.8542e-12, rho = 1e-3;
// Those of cube_scaling; the arguments replace them.
double eta = 0.4;
double dt = 1e-4;
int n_steps = 10;
constexpr double volts = 1e5;  // unit of the unknown potentials: the diagonals of both kinds are alike

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Stress, electric displacement, and their derivatives at a point.
struct Law {
  Tensor<2, 3> P;
  Tensor<1, 3> D;
  std::array<std::array<double, 9>, 9> A;  // dP/dF, weighted, with the viscous part by the rate
  std::array<std::array<double, 3>, 9> B;  // dP/dE
  std::array<std::array<double, 3>, 3> C;  // d2Omega/dEdE
};

void evaluate(const Tensor<2, 3>& F, const Tensor<2, 3>& rate, const Tensor<1, 3>& E, bool tangent, Law& law) {
  const double J = determinant(F);
  const Tensor<2, 3> f = invert(F);
  const Tensor<2, 3> ft = transpose(f);
  const double lnJ = std::log(J);
  const Tensor<1, 3> e = ft * E;  // F^-T E
  const Tensor<1, 3> fe = f * e;  // C^-1 E
  const double ee = e * e;
  const Tensor<1, 3> FE = F * E;
  law.P = mu * (F - ft) + lambda * lnJ * ft + 2.0 * c2 * outer_product(FE, E) +
          eps0 * J * (outer_product(e, fe) - 0.5 * ee * ft);
  const Tensor<2, 3> Ci = f * ft;
  law.P += 0.5 * eta * J * (ft * transpose(rate) * ft + rate * Ci);
  law.D = -2.0 * c1 * E - 2.0 * c2 * (transpose(F) * FE) + eps0 * J * fe;
  if (!tangent) return;
  // Derivatives of F^-T, of the viscous stress by the rate, and of the electric part; weights 1/4 dt and 1/2.
  const double ka = 0.25 * dt, kr = 0.5;
  for (int i = 0; i < 3; ++i)
    for (int m = 0; m < 3; ++m)
      for (int j = 0; j < 3; ++j)
        for (int n = 0; n < 3; ++n) {
          const double geometric = f[n][i] * f[m][j];  // -d(F^-T)_im / dF_jn
          const double volumetric = f[m][i] * f[n][j];
          double a = (mu - lambda * lnJ) * geometric + lambda * volumetric;
          if (i == j) {
            a += 2.0 * c2 * E[m] * E[n];
            if (m == n) a += mu;
          }
          a += eps0 * J *
               (volumetric * (-0.5 * ee) + 0.5 * ee * geometric + f[n][j] * e[i] * fe[m] + f[m][i] * e[j] * fe[n] -
                e[j] * f[n][i] * fe[m] - e[i] * f[m][j] * fe[n] - e[i] * e[j] * Ci[m][n]);
          double v = 0.5 * eta * J * geometric;
          if (i == j) v += 0.5 * eta * J * Ci[m][n];
          law.A[3 * i + m][3 * j + n] = ka * a + kr * v;
        }
  for (int i = 0; i < 3; ++i)
    for (int m = 0; m < 3; ++m)
      for (int k = 0; k < 3; ++k) {
        law.B[3 * i + m][k] = 2.0 * c2 * (F[i][k] * E[m] + (m == k ? FE[i] : 0.0)) +
                              eps0 * J * (f[k][i] * fe[m] + e[i] * Ci[m][k] - fe[k] * f[m][i]);
      }
  const Tensor<2, 3> Cg = transpose(F) * F;
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) law.C[k][l] = (k == l ? 2.0 * c1 : 0.0) + 2.0 * c2 * Cg[k][l] - eps0 * J * Ci[k][l];
}

struct Scratch {
  FEValues<3> values;
  std::array<double, 32> old_values{}, new_values{};
  std::vector<types::global_dof_index> dofs;
  Scratch(const FiniteElement<3>& fe, const Quadrature<3>& quadrature)
      : values(fe, quadrature, update_values | update_gradients | update_JxW_values), dofs(32) {}
  Scratch(const Scratch& other) : Scratch(other.values.get_fe(), other.values.get_quadrature()) {}
};

struct Copy {
  FullMatrix<double> matrix = FullMatrix<double>(32, 32);
  Vector<double> rhs = Vector<double>(32);
  Vector<double> momentum = Vector<double>(32);  // to the next node
  std::vector<types::global_dof_index> dofs = std::vector<types::global_dof_index>(32);
};

class Peer {
 public:
  explicit Peer(unsigned n) : fe_(FE_Q<3>(1), 3, FE_Q<3>(1), 1), dofs_(mesh_), quadrature_(2) {
    GridGenerator::subdivided_hyper_cube(mesh_, n, -1.0, 1.0);
    dofs_.distribute_dofs(fe_);
    DoFRenumbering::Cuthill_McKee(dofs_);
    DoFRenumbering::component_wise(dofs_, std::vector<unsigned>{0, 0, 0, 1});
    sizes_ = DoFTools::count_dofs_per_fe_block(dofs_, std::vector<unsigned>{0, 0, 0, 1});
    for (unsigned i = 0; i < 32; ++i) {
      const auto [component, node] = fe_.system_to_component_index(i);
      local_[node][component] = i;
    }
    constrain();
    BlockDynamicSparsityPattern dynamic(sizes_, sizes_);
    DoFTools::make_sparsity_pattern(dofs_, dynamic, constraints_, true);
    pattern_.copy_from(dynamic);
    matrix_.reinit(pattern_);
    for (BlockVector<double>* v : {&q0_, &q1_, &p_, &p_next_, &rhs_, &step_, &advance_}) v->reinit(sizes_);
    start();
  }

  void assemble(bool tangent) {
    matrix_ = 0.0;
    rhs_ = 0.0;
    p_next_ = 0.0;
    WorkStream::run(
        dofs_.begin_active(), dofs_.end(),
        [&](const auto& cell, Scratch& scratch, Copy& copy) { local(cell, scratch, copy, tangent); },
        [&](const Copy& copy) {
          if (tangent) {
            constraints_.distribute_local_to_global(copy.matrix, copy.rhs, copy.dofs, matrix_, rhs_);
          } else {
            constraints_.distribute_local_to_global(copy.rhs, copy.dofs, rhs_);
          }
          for (unsigned i = 0; i < 32; ++i) p_next_[copy.dofs[i]] += copy.momentum[i];
        },
        Scratch(fe_, quadrature_), Copy());
    for (types::global_dof_index i = 0; i < sizes_[0]; ++i) {
      if (!constraints_.is_constrained(i)) rhs_[i] += p_[i];
    }
  }

  void run() {
    for (int step = 0; step < n_steps; ++step) {
      q1_ = q0_;
      q1_ += advance_;
      for (types::global_dof_index i = 0; i < potentials_.size(); ++i) q1_.block(1)[i] = potentials_[i];
      for (int iteration = 0; iteration < 10; ++iteration) {
        auto start = Clock::now();
        assemble(true);
        assembly_seconds_ += since(start);
        ++newton_;
        start = Clock::now();
        solve();
        solve_seconds_ += since(start);
        step_.block(1) *= volts;
        q1_ += step_;
        const double size = step_.block(0).linfty_norm() / (2.0 * std::sqrt(3.0));
        if (std::max(size, step_.block(1).linfty_norm() / 20e3) <= 1e-10) break;
      }
      const auto start = Clock::now();
      assemble(false);
      assembly_seconds_ += since(start);
      p_ = p_next_;
      advance_.block(0) = q1_.block(0);
      advance_.block(0) -= q0_.block(0);
      q0_ = q1_;
      potentials_ = q1_.block(1);
    }
  }

  double assembly_seconds() const { return assembly_seconds_; }
  double solve_seconds() const { return solve_seconds_; }
  int newton() const { return newton_; }
  int gmres() const { return gmres_; }
  unsigned n_cells() const { return mesh_.n_active_cells(); }
  double height() const {
    double above = 0.0, below = 0.0;
    for (const auto& cell : dofs_.active_cell_iterators()) {
      for (unsigned v = 0; v < 8; ++v) {
        const Point<3>& X = cell->vertex(v);
        if (X.distance(Point<3>(-1, 1, 0)) < 1e-9) above = 1.0 + q0_[cell->vertex_dof_index(v, 1)];
        if (X.distance(Point<3>(-1, -1, 0)) < 1e-9) below = -1.0 + q0_[cell->vertex_dof_index(v, 1)];
      }
    }
    return above - below;
  }

 private:
  void constrain() {
    for (const auto& cell : dofs_.active_cell_iterators()) {
      for (unsigned v = 0; v < 8; ++v) {
        const Point<3>& X = cell->vertex(v);
        for (unsigned i = 0; i < 3; ++i) {
          if (X[i] < -1 + 1e-9) constraints_.add_line(cell->vertex_dof_index(v, i));
        }
        const bool upper = X[1] > 1 - 1e-9 && X[0] < -1e-9;
        if (upper || X[1] < -1 + 1e-9) {
          const auto dof = cell->vertex_dof_index(v, 3);
          constraints_.add_line(dof);
          if (upper) electrode_.push_back(dof);
        }
      }
    }
    constraints_.close();
  }

  /// Potentials in equilibrium at rest.
  void start() {
    for (const auto dof : electrode_) q1_[dof] = 20e3;
    q0_ = q1_;
    for (int iteration = 0; iteration < 6; ++iteration) {
      assemble(true);
      solve();
      q1_.block(1).add(volts, step_.block(1));
    }
    q0_.block(1) = q1_.block(1);
    potentials_ = q1_.block(1);
    p_ = 0.0;
    newton_ = gmres_ = 0;
  }

  void local(const typename DoFHandler<3>::active_cell_iterator& cell, Scratch& scratch, Copy& copy, bool tangent) {
    scratch.values.reinit(cell);
    cell->get_dof_indices(copy.dofs);
    copy.matrix = 0.0;
    copy.rhs = 0.0;
    copy.momentum = 0.0;
    std::array<std::array<double, 4>, 8> mid{}, velocity{};
    for (unsigned a = 0; a < 8; ++a) {
      for (unsigned i = 0; i < 4; ++i) {
        const auto dof = copy.dofs[local_[a][i]];
        mid[a][i] = i < 3 ? 0.5 * (q0_[dof] + q1_[dof]) : q1_[dof];
        velocity[a][i] = i < 3 ? (q1_[dof] - q0_[dof]) / dt : 0.0;
      }
    }
    Law law;
    for (unsigned q = 0; q < quadrature_.size(); ++q) {
      std::array<Tensor<1, 3>, 8> dN;
      std::array<double, 8> N{};
      Tensor<2, 3> F = unit_symmetric_tensor<3>();
      Tensor<2, 3> rate;
      Tensor<1, 3> E, v;
      for (unsigned a = 0; a < 8; ++a) {
        dN[a] = scratch.values.shape_grad(local_[a][0], q);
        N[a] = scratch.values.shape_value(local_[a][0], q);
        for (unsigned i = 0; i < 3; ++i) {
          F[i] += mid[a][i] * dN[a];
          rate[i] += velocity[a][i] * dN[a];
          v[i] += velocity[a][i] * N[a];
        }
        E -= mid[a][3] * dN[a];
      }
      const double w = scratch.values.JxW(q);
      evaluate(F, rate, E, tangent, law);
      for (unsigned a = 0; a < 8; ++a) {
        const Tensor<1, 3> force = law.P * dN[a];
        for (unsigned i = 0; i < 3; ++i) {
          // p_n - M v - dt/2 f = 0; p_{n+1} = M v - dt/2 f.
          copy.rhs[local_[a][i]] -= w * (rho * v[i] * N[a] + 0.5 * dt * force[i]);
          copy.momentum[local_[a][i]] += w * (rho * v[i] * N[a] - 0.5 * dt * force[i]);
        }
        copy.rhs[local_[a][3]] -= volts * dt * w * (law.D * dN[a]);
      }
      if (tangent) add_tangent(law, dN, N, w, copy.matrix);
    }
  }

  void add_tangent(const Law& law, const std::array<Tensor<1, 3>, 8>& dN, const std::array<double, 8>& N, double w,
                   FullMatrix<double>& K) const {
    for (unsigned b = 0; b < 8; ++b) {
      // Half-contracted with the gradient of b.
      std::array<std::array<double, 3>, 9> Ab{};
      std::array<double, 9> Bb{};
      Tensor<1, 3> Cb;
      for (unsigned im = 0; im < 9; ++im) {
        for (unsigned j = 0; j < 3; ++j) {
          Ab[im][j] =
              w * (law.A[im][3 * j] * dN[b][0] + law.A[im][3 * j + 1] * dN[b][1] + law.A[im][3 * j + 2] * dN[b][2]);
        }
        Bb[im] = -0.5 * volts * dt * w * (law.B[im][0] * dN[b][0] + law.B[im][1] * dN[b][1] + law.B[im][2] * dN[b][2]);
      }
      for (unsigned k = 0; k < 3; ++k) {
        Cb[k] = volts * volts * dt * w * (law.C[k][0] * dN[b][0] + law.C[k][1] * dN[b][1] + law.C[k][2] * dN[b][2]);
      }
      for (unsigned a = 0; a < 8; ++a) {
        const double mass = w * rho / dt * N[a] * N[b];
        for (unsigned i = 0; i < 3; ++i) {
          for (unsigned j = 0; j < 3; ++j) {
            K(local_[a][i], local_[b][j]) += dN[a][0] * Ab[3 * i][j] + dN[a][1] * Ab[3 * i + 1][j] +
                                             dN[a][2] * Ab[3 * i + 2][j] + (i == j ? mass : 0.0);
          }
          const double coupling = dN[a][0] * Bb[3 * i] + dN[a][1] * Bb[3 * i + 1] + dN[a][2] * Bb[3 * i + 2];
          K(local_[a][i], local_[b][3]) += coupling;
          K(local_[b][3], local_[a][i]) += coupling;
        }
        K(local_[a][3], local_[b][3]) += dN[a] * Cb;
      }
    }
  }

  /// Block diagonal: SSOR and ML.
  struct Preconditioner {
    const PreconditionSSOR<SparseMatrix<double>>& u;
    const TrilinosWrappers::PreconditionAMG& phi;
    void vmult(BlockVector<double>& z, const BlockVector<double>& r) const {
      u.vmult(z.block(0), r.block(0));
      phi.vmult(z.block(1), r.block(1));
    }
  };

  void solve() {
    PreconditionSSOR<SparseMatrix<double>> ssor;
    ssor.initialize(matrix_.block(0, 0), 1.2);
    if (!amg_) {
      trilinos_.reinit(matrix_.block(1, 1));
      amg_ = std::make_unique<TrilinosWrappers::PreconditionAMG>();
      TrilinosWrappers::PreconditionAMG::AdditionalData data;
      data.elliptic = true;
      amg_->initialize(trilinos_, data);
    }
    SolverControl control(2000, 1e-6 * rhs_.l2_norm());
    SolverGMRES<BlockVector<double>> gmres(control, SolverGMRES<BlockVector<double>>::AdditionalData(40));
    step_ = 0.0;
    gmres.solve(matrix_, step_, rhs_, Preconditioner{ssor, *amg_});
    constraints_.set_zero(step_);
    gmres_ += static_cast<int>(control.last_step());
  }

  Triangulation<3> mesh_;
  FESystem<3> fe_;
  DoFHandler<3> dofs_;
  QGauss<3> quadrature_;
  AffineConstraints<double> constraints_;
  std::vector<types::global_dof_index> sizes_, electrode_;
  std::array<std::array<unsigned, 4>, 8> local_{};
  BlockSparsityPattern pattern_;
  BlockSparseMatrix<double> matrix_;
  BlockVector<double> q0_, q1_, p_, p_next_, rhs_, step_, advance_;
  Vector<double> potentials_;
  TrilinosWrappers::SparseMatrix trilinos_;
  std::unique_ptr<TrilinosWrappers::PreconditionAMG> amg_;
  double assembly_seconds_ = 0.0, solve_seconds_ = 0.0;
  int newton_ = 0, gmres_ = 0;
};

}  // namespace

/// Arguments: cells a side, threads, step (ms), steps, viscosity; those that are left out are those of cube_scaling.
int main(int argc, char** argv) {
  const Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned n = argc > 1 ? static_cast<unsigned>(std::atoi(argv[1])) : 32;
  const unsigned threads = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 2;
  if (argc > 3) dt = std::atof(argv[3]);
  if (argc > 4) n_steps = std::atoi(argv[4]);
  if (argc > 5) eta = std::atof(argv[5]);
  MultithreadInfo::set_thread_limit(1);
  Peer peer(n);
  std::array<double, 3> times{};
  for (double& seconds : times) {
    const auto start = Clock::now();
    peer.assemble(true);
    seconds = since(start);
  }
  const double assembly = std::min({times[0], times[1], times[2]}) / peer.n_cells();
  MultithreadInfo::set_thread_limit(threads);
  const auto start = Clock::now();
  const std::clock_t processor = std::clock();
  peer.run();
  const double used = static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
  std::printf("%.6g %.6g %.6g %.6g %d %d %.12g %.6g\n", 1e6 * assembly, since(start), peer.assembly_seconds(),
              peer.solve_seconds(), peer.newton(), peer.gmres(), peer.height(), used);
}
