#include "math/sparse_cholesky.hpp"

#include <cholmod.h>

#include <algorithm>

#include "base/error.hpp"
#include "math/sparse_library.hpp"

namespace muldi::math {
namespace {

/// The functions of CHOLMOD that are used.
struct Cholmod {
  decltype(&cholmod_start) start = nullptr;
  decltype(&cholmod_finish) finish = nullptr;
  decltype(&cholmod_analyze) analyze = nullptr;
  decltype(&cholmod_factorize) factorize = nullptr;
  decltype(&cholmod_solve) solve = nullptr;
  decltype(&cholmod_free_factor) free_factor = nullptr;
  decltype(&cholmod_free_dense) free_dense = nullptr;

  Cholmod() {
    const SparseLibrary library("libcholmod.so.3");
    library.find("cholmod_start", start);
    library.find("cholmod_finish", finish);
    library.find("cholmod_analyze", analyze);
    library.find("cholmod_factorize", factorize);
    library.find("cholmod_solve", solve);
    library.find("cholmod_free_factor", free_factor);
    library.find("cholmod_free_dense", free_dense);
  }
};

const Cholmod& cholmod() {
  static const Cholmod functions;
  return functions;
}

/// The upper triangle of the matrix. CHOLMOD takes its input by pointers to what it could change, and does not.
cholmod_sparse view_of(const Eigen::SparseMatrix<double>& matrix) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(matrix.cols());
  view.nzmax = static_cast<std::size_t>(matrix.nonZeros());
  view.p = const_cast<int*>(matrix.outerIndexPtr());
  view.i = const_cast<int*>(matrix.innerIndexPtr());
  view.x = const_cast<double*>(matrix.valuePtr());
  view.stype = 1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

}  // namespace

struct SparseCholesky::Factor {
  cholmod_common common{};
  cholmod_factor* definite = nullptr;
  cholmod_factor* indefinite = nullptr;
  cholmod_factor* current = nullptr;

  Factor() {
    cholmod().start(&common);
    common.print = 0;
    common.try_catch = 1;
  }
  ~Factor() {
    for (cholmod_factor* factor : {definite, indefinite}) {
      if (factor != nullptr) cholmod().free_factor(&factor, &common);
    }
    cholmod().finish(&common);
  }
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;

  void expect_memory() const {
    if (common.status == CHOLMOD_OUT_OF_MEMORY || common.status == CHOLMOD_TOO_LARGE) {
      throw base::EnvironmentError(
          "CHOLMOD's factor does not fit into memory: take fewer cells, or an iterative solver");
    }
  }

  cholmod_factor* analysed(cholmod_sparse& view, bool is_definite) {
    cholmod_factor*& factor = is_definite ? definite : indefinite;
    if (factor != nullptr) return factor;
    common.supernodal = is_definite ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
    factor = cholmod().analyze(&view, &common);
    expect_memory();
    MULDI_EXPECT(factor != nullptr, "CHOLMOD analyses every symmetric matrix");
    return factor;
  }

  bool factorise(cholmod_sparse& view, bool is_definite) {
    SparseLibrary::keep_to_one_thread();
    current = analysed(view, is_definite);
    cholmod().factorize(&view, current, &common);
    expect_memory();
    return common.status == CHOLMOD_OK && current->minor == current->n;
  }
};

SparseCholesky::SparseCholesky() : factor_(std::make_unique<Factor>()) {}
SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

bool SparseCholesky::factorise(const Eigen::SparseMatrix<double>& matrix, bool definite) {
  MULDI_EXPECT(matrix.rows() == matrix.cols() && matrix.isCompressed(), "a square compressed matrix");
  cholmod_sparse view = view_of(matrix);
  return (definite && factor_->factorise(view, true)) || factor_->factorise(view, false);
}

int SparseCholesky::n_negative() const {
  const cholmod_factor& L = *factor_->current;
  if (L.is_ll != 0) return 0;
  const int* start = static_cast<const int*>(L.p);
  const double* values = static_cast<const double*>(L.x);
  return static_cast<int>(std::count_if(start, start + L.n, [&](int first) { return values[first] < 0.0; }));
}

void SparseCholesky::solve(const Eigen::Ref<const Eigen::VectorXd>& b, Eigen::Ref<Eigen::VectorXd> x) const {
  Factor& f = *factor_;
  MULDI_EXPECT(f.current != nullptr && b.size() == x.size(), "there is a factor of the vectors' size");
  cholmod_dense right{};
  right.nrow = right.d = right.nzmax = static_cast<std::size_t>(b.size());
  right.ncol = 1;
  right.x = const_cast<double*>(b.data());
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* found = cholmod().solve(CHOLMOD_A, f.current, &right, &f.common);
  f.expect_memory();
  x = Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(found->x), x.size());
  cholmod().free_dense(&found, &f.common);
}

double SparseCholesky::bytes_of(const Eigen::SparseMatrix<double>& matrix, bool definite) {
  Factor factor;
  cholmod_sparse view = view_of(matrix);
  factor.analysed(view, definite);
  // Rows are stored beside the values of a simplicial factor.
  return factor.common.lnz * (definite ? 8.0 : 12.0);
}

}  // namespace muldi::math
