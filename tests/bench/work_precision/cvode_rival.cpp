#include "bench/work_precision/cvode_rival.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <array>
#include <memory>

#include "base/error.hpp"

namespace muldi::bench {
namespace {

int right_hand_side(realtype, N_Vector y, N_Vector dy, void* given) {
  const auto& system = *static_cast<const MinimalSystem*>(given);
  const auto n = N_VGetLength(y) / 2;
  const double* from = N_VGetArrayPointer(y);
  double* to = N_VGetArrayPointer(dy);
  const Coordinates x = Eigen::Map<const Coordinates>(from, n);
  const Coordinates v = Eigen::Map<const Coordinates>(from + n, n);
  Coordinates a;
  system.acceleration(x, v, a);
  Eigen::Map<Coordinates>(to, n) = v;
  Eigen::Map<Coordinates>(to + n, n) = a;
  return a.allFinite() ? 0 : 1;
}

void check(int code) { MULDI_EXPECT(code >= 0, "CVODE accepts its options"); }

/// Everything that one integration owns.
class Solver {
 public:
  Solver(const MinimalSystem& system, CvodeMethod method, double tolerance) : n_(system.n()) {
    check(SUNContext_Create(nullptr, &context_));
    y_ = N_VNew_Serial(2 * n_, context_);
    N_VConst(0.0, y_);
    Eigen::Map<Coordinates>(N_VGetArrayPointer(y_), n_) = system.start();
    memory_ = CVodeCreate(method == CvodeMethod::bdf ? CV_BDF : CV_ADAMS, context_);
    check(CVodeInit(memory_, right_hand_side, 0.0, y_));
    check(CVodeSStolerances(memory_, tolerance, tolerance));
    check(CVodeSetUserData(memory_, const_cast<MinimalSystem*>(&system)));
    check(CVodeSetMaxNumSteps(memory_, 10'000'000));
    if (method == CvodeMethod::bdf) {
      matrix_ = SUNDenseMatrix(2 * n_, 2 * n_, context_);
      linear_ = SUNLinSol_Dense(y_, matrix_, context_);
      check(CVodeSetLinearSolver(memory_, linear_, matrix_));
    } else {
      nonlinear_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
      check(CVodeSetNonlinearSolver(memory_, nonlinear_));
    }
  }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;
  ~Solver() {
    CVodeFree(&memory_);
    if (linear_ != nullptr) SUNLinSolFree(linear_);
    if (nonlinear_ != nullptr) SUNNonlinSolFree(nonlinear_);
    if (matrix_ != nullptr) SUNMatDestroy(matrix_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }

  bool advance_to(double t) {
    realtype reached = 0.0;
    return CVode(memory_, t, y_, &reached, CV_NORMAL) >= 0;
  }
  Coordinates x() const { return Eigen::Map<const Coordinates>(N_VGetArrayPointer(y_), n_); }
  Coordinates v() const { return Eigen::Map<const Coordinates>(N_VGetArrayPointer(y_) + n_, n_); }

 private:
  sunindextype n_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  void* memory_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  SUNNonlinearSolver nonlinear_ = nullptr;
};

}  // namespace

Samples integrate_with_cvode(const MinimalSystem& system, CvodeMethod method, double tolerance, const Grid& grid) {
  Solver solver(system, method, tolerance);
  Samples samples;
  const long n_samples = std::lround(grid.end / grid.sample);
  for (long i = 1; i <= n_samples; ++i) {
    samples.completed = solver.advance_to(static_cast<double>(i) * grid.sample);
    if (!samples.completed) break;
    samples.x.push_back(solver.x());
    samples.v.push_back(solver.v());
  }
  return samples;
}

std::string cvode_version() {
  std::array<char, 64> text{};
  SUNDIALSGetVersion(text.data(), static_cast<int>(text.size()));
  return std::string("SUNDIALS ") + text.data();
}

std::string name_of(CvodeMethod method) { return method == CvodeMethod::bdf ? "CVODE BDF" : "CVODE Adams"; }

std::string options_of(CvodeMethod method) {
  const std::string common =
      "joint coordinates, the same hand-written equations of motion; variable step and order, relative and absolute "
      "tolerance equal (rad or mm, and per ms), interpolation to the samples (CV_NORMAL), serial vectors; ";
  return common + (method == CvodeMethod::bdf
                       ? "CV_BDF to order 5, Newton, dense solver, its own difference Jacobian; the rest by default"
                       : "CV_ADAMS to order 12, functional iteration without acceleration; the rest by default");
}

}  // namespace muldi::bench
