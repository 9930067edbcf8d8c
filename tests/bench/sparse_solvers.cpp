/// Direct and iterative solvers of finite-element matrices beside CHOLMOD (supernodal) and UMFPACK of the system.
///
/// Direct: trilinear cells with potential, bulk modulus 1000 times the shear modulus, quasi-definite; CHOLMOD, which
/// knows definite matrices only, gets the one with the other sign of the permittivity. The rivals use the BLAS that the
/// system has chosen (reference BLAS where none was) and all their defaults; CHOLMOD's OpenMP is switched off, which
/// makes it faster. Iterative: mass of a step in which waves cross several cells.
#include <cholmod.h>
#include <umfpack.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "base/parallel.hpp"
#include "bench/bench_report.hpp"
#include "math/coupled_preconditioner.hpp"
#include "math/krylov.hpp"
#include "math/sparse_kernels.hpp"
#include "math/sparse_ldlt.hpp"
#include "math/sparse_lu.hpp"
#include "support/box_matrix.hpp"

namespace {

using namespace muldi;

struct DirectCase {
  const char* name;
  std::array<int, 3> cells;
  int fixed_ends;
  int repeats;
  bool rivals;
  double factor_bound_ms;
  double solve_bound_ms;
};

double once(auto&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double timed(int repeats, auto&& work) {
  return 1e3 * (repeats > 1 ? bench::median_seconds(repeats, work) : once(work));
}

/// Triad of three long vectors on one thread, GB/s.
double triad_rate() {
  const Eigen::Index n = 10'000'000;
  Eigen::VectorXd a = Eigen::VectorXd::Ones(n);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(n);
  const Eigen::VectorXd c = Eigen::VectorXd::Ones(n);
  const double seconds = bench::median_seconds(7, [&] { a = b + 0.5 * c; });
  return 24.0 * static_cast<double>(n) * 1e-9 / seconds + (a(0) > 10.0 ? 1.0 : 0.0);
}

void run_cholmod(bench::BenchReport& report, const DirectCase& c, const test::BoxProblem& problem,
                 const math::SymmetricBlockPattern& pattern) {
  test::BoxProblem definite = problem;
  definite.potential_sign = 1.0;
  Eigen::SparseMatrix<double> matrix = test::free_part(test::box_matrix(definite, pattern), test::box_mask(problem));
  matrix = Eigen::SparseMatrix<double>(matrix.triangularView<Eigen::Lower>());
  cholmod_common common;
  cholmod_start(&common);
  common.supernodal = CHOLMOD_SUPERNODAL;
  const std::size_t n = static_cast<std::size_t>(matrix.rows());
  cholmod_sparse view{n,
                      n,
                      static_cast<std::size_t>(matrix.nonZeros()),
                      matrix.outerIndexPtr(),
                      matrix.innerIndexPtr(),
                      nullptr,
                      matrix.valuePtr(),
                      nullptr,
                      -1,
                      CHOLMOD_INT,
                      CHOLMOD_REAL,
                      CHOLMOD_DOUBLE,
                      1,
                      1};
  cholmod_factor* factor = cholmod_analyze(&view, &common);
  cholmod_dense* b = cholmod_ones(n, 1, CHOLMOD_REAL, &common);
  const double factor_ms = timed(c.repeats, [&] { cholmod_factorize(&view, factor, &common); });
  const double solve_ms = timed(c.repeats, [&] {
    cholmod_dense* x = cholmod_solve(CHOLMOD_A, factor, b, &common);
    cholmod_free_dense(&x, &common);
  });
  const std::string name = c.name;
  report.add({name + ", CHOLMOD supernodal, factor", factor_ms, "ms"});
  report.add({name + ", CHOLMOD supernodal, solve", solve_ms, "ms"});
  cholmod_free_dense(&b, &common);
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
}

void run_umfpack(bench::BenchReport& report, const DirectCase& c, const math::SymmetricBlockMatrix& matrix,
                 const math::NodeMask& mask) {
  const Eigen::SparseMatrix<double> full = test::free_part(matrix, mask);
  math::SparseLu lu;
  lu.factorise(full);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(full.rows());
  Eigen::VectorXd x(b.size());
  report.add(
      {std::string(c.name) + ", UMFPACK, factor", timed(std::min(c.repeats, 5), [&] { lu.factorise(full); }), "ms"});
  report.add({std::string(c.name) + ", UMFPACK, solve", timed(std::min(c.repeats, 5), [&] { lu.solve(b, x); }), "ms"});
}

void run_direct(bench::BenchReport& report, const DirectCase& c, double triad) {
  test::BoxProblem problem;
  problem.cells = c.cells;
  problem.fixed_ends = c.fixed_ends;
  problem.bulk_modulus = 1000.0;
  const math::SymmetricBlockPattern pattern = test::box_pattern(problem);
  const math::NodeMask mask = test::box_mask(problem);
  const math::SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  const std::string name = c.name;
  std::optional<math::LdltAnalysis> analysis;
  report.add({name + ", own, analyse", 1e3 * once([&] { analysis.emplace(pattern, mask); }), "ms"});
  math::SparseLdlt factor(*analysis);
  math::SparseLdlt single(*analysis, math::FactorStorage::single_precision);
  const double factor_ms = timed(c.repeats, [&] { factor.factorise(matrix); });
  Eigen::VectorXd x = Eigen::VectorXd::Ones(pattern.n_rows());
  const double solve_ms = timed(c.repeats, [&] { factor.solve(x.setOnes()); });
  const double bytes = static_cast<double>(analysis->size().factor_bytes);
  report.add({name + ", own, factor", factor_ms, "ms", c.factor_bound_ms});
  report.add({name + ", own, factor rate", 1e-6 * analysis->size().flops / factor_ms, "GFlop/s"});
  report.add({name + ", own, solve", solve_ms, "ms", c.solve_bound_ms});
  report.add({name + ", own, solve rate over triad", 2e-6 * bytes / solve_ms / triad, "1"});
  report.add({name + ", own, memory of the factor", bytes / 1048576.0, "MiB"});
  report.add({name + ", own, work space", static_cast<double>(analysis->size().work_bytes) / 1048576.0, "MiB"});
  if (c.rivals) {
    single.factorise(matrix);
    report.add({name + ", own, solve with single-precision storage",
                timed(c.repeats, [&] { single.solve(x.setOnes()); }), "ms"});
    Eigen::MatrixXd many = Eigen::MatrixXd::Ones(pattern.n_rows(), 16);
    report.add(
        {name + ", own, solve one of 16 columns", timed(c.repeats, [&] { factor.solve_columns(many); }) / 16.0, "ms"});
    run_cholmod(report, c, problem, pattern);
    run_umfpack(report, c, matrix, mask);
  }
}

/// Waves cross about five cells in a step: node-block Jacobi would need some 100 iterations.
void run_iterative(bench::BenchReport& report, int n, double sign, double bound) {
  test::BoxProblem problem;
  problem.cells = {n, n, n};
  problem.bulk_modulus = 1000.0;
  problem.mass = 500.0;
  problem.potential_sign = sign;
  const math::SymmetricBlockPattern pattern = test::box_pattern(problem);
  math::SymmetricBlockMatrix matrix = test::box_matrix(problem, pattern);
  matrix.constrain(test::box_mask(problem));
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(pattern.n_rows(), 0.0, 500.0).array().sin();
  Eigen::VectorXd x(b.size());
  for (const int threads : {1, 2}) {
    base::set_threads(threads);
    const std::string name = "cube " + std::to_string(n) + (sign > 0.0 ? ", definite, " : ", quasi-definite, ") +
                             std::to_string(threads) + (threads == 1 ? " thread, " : " threads, ");
    math::CoupledPreconditioner preconditioner(pattern, {.least = 6, .largest = 6});
    report.add({name + "set-up", once([&] { preconditioner.update(matrix); }), "s"});
    report.add({name + "new values", once([&] { preconditioner.update(matrix); }), "s"});
    const auto a = [&](const Eigen::VectorXd& u, Eigen::VectorXd& v) { matrix.multiply(u, v); };
    const auto p = [&](const Eigen::VectorXd& u, Eigen::VectorXd& v) {
      preconditioner.apply(u, v, sign > 0.0 ? math::PotentialSign::positive : math::PotentialSign::of_the_matrix);
    };
    math::ConjugateGradients cg;
    math::FlexibleGmres gmres;
    for (const double tolerance : {1e-6, 1e-10}) {
      math::KrylovOutcome outcome;
      const math::KrylovLimits limits{tolerance, 0.0, 300};
      const double seconds = bench::median_seconds(3, [&] {
        x.setZero();
        outcome = sign > 0.0 ? cg.solve(a, p, b, x, limits) : gmres.solve(a, p, b, x, limits);
      });
      const std::string row = name + (sign > 0.0 ? "CG to " : "GMRES to ") + (tolerance > 1e-8 ? "1e-6" : "1e-10");
      report.add({row + (outcome.converged() ? "" : " (NOT CONVERGED)"), seconds, "s",
                  threads == 2 && tolerance > 1e-8 ? bound : std::nan("")});
      report.add({row + ", iterations", static_cast<double>(outcome.iterations), "1"});
    }
    report.add({name + "product", 1e3 * bench::median_seconds(5, [&] { matrix.multiply(b, x); }), "ms"});
    report.add({name + "preconditioner", 1e3 * bench::median_seconds(5, [&] { p(b, x); }), "ms"});
  }
  base::set_threads(1);
}

}  // namespace

int main(int, char** argv) {
  // CHOLMOD starts four threads whatever the machine has, unless the limit is set before its library is loaded.
  if (std::getenv("OMP_THREAD_LIMIT") == nullptr) {
    setenv("OMP_THREAD_LIMIT", "1", 1);
    execv("/proc/self/exe", argv);
  }
  bench::BenchReport report("sparse_solvers");
  const double triad = triad_rate();
  report.add({"triad, 1 thread", triad, "GB/s"});
  const double none = std::nan("");
  for (const DirectCase& c : {DirectCase{"muscle 2x2x23", {2, 2, 23}, 2, 101, true, 0.5, 0.04},
                              DirectCase{"muscle 4x4x18", {4, 4, 18}, 2, 51, true, 2.8, 0.14},
                              DirectCase{"muscle 4x4x32", {4, 4, 32}, 2, 51, true, 6.0, 0.22},
                              DirectCase{"cube 8", {8, 8, 8}, 1, 21, true, 8.0, 0.24},
                              DirectCase{"cube 16", {16, 16, 16}, 1, 3, true, 345.0, 12.0},
                              DirectCase{"cube 32", {32, 32, 32}, 1, 1, false, none, none}}) {
    run_direct(report, c, triad);
  }
  for (const double sign : {1.0, -1.0}) {
    run_iterative(report, 32, sign, sign > 0.0 ? 0.16 : none);
    run_iterative(report, 64, sign, sign > 0.0 ? 1.45 : none);
  }
  report.print();
}
