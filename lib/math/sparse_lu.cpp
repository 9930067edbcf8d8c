#include "math/sparse_lu.hpp"

#include <umfpack.h>

#include <algorithm>
#include <array>
#include <new>
#include <numeric>
#include <vector>

#include "base/error.hpp"
#include "math/sparse_library.hpp"

namespace muldi::math {
namespace {

/// The functions of UMFPACK that are used.
struct Umfpack {
  decltype(&umfpack_di_defaults) defaults = nullptr;
  decltype(&umfpack_di_symbolic) symbolic = nullptr;
  decltype(&umfpack_di_numeric) numeric = nullptr;
  decltype(&umfpack_di_solve) solve = nullptr;
  decltype(&umfpack_di_get_determinant) determinant = nullptr;
  decltype(&umfpack_di_free_symbolic) free_symbolic = nullptr;
  decltype(&umfpack_di_free_numeric) free_numeric = nullptr;

  Umfpack() {
    const SparseLibrary library("libumfpack.so.5");
    library.find("umfpack_di_defaults", defaults);
    library.find("umfpack_di_symbolic", symbolic);
    library.find("umfpack_di_numeric", numeric);
    library.find("umfpack_di_solve", solve);
    library.find("umfpack_di_get_determinant", determinant);
    library.find("umfpack_di_free_symbolic", free_symbolic);
    library.find("umfpack_di_free_numeric", free_numeric);
  }
};

const Umfpack& umfpack() {
  static const Umfpack functions;
  return functions;
}

/// Calls visit(row, column, value) for every entry of both triangles.
template <class Visit>
void for_each_entry(const SymmetricBlockMatrix& matrix, Visit&& visit) {
  const SymmetricBlockPattern& pattern = matrix.pattern();
  const int b = matrix.block_size();
  const double* value = matrix.values().data();
  for (int i = 0; i < pattern.n_nodes(); ++i) {
    for (int slot = pattern.row_start()[static_cast<std::size_t>(i)];
         slot < pattern.row_start()[static_cast<std::size_t>(i) + 1]; ++slot) {
      const int j = pattern.columns()[static_cast<std::size_t>(slot)];
      for (int r = 0; r < b; ++r) {
        for (int c = 0; c < b; ++c, ++value) {
          visit(i * b + r, j * b + c, *value);
          if (i != j) visit(j * b + c, i * b + r, *value);
        }
      }
    }
  }
}

}  // namespace

Eigen::SparseMatrix<double> full_matrix(const SymmetricBlockMatrix& matrix) {
  const int n = static_cast<int>(matrix.n_rows());
  Eigen::SparseMatrix<double> full(n, n);
  Eigen::VectorXi counts = Eigen::VectorXi::Zero(n);
  for_each_entry(matrix, [&](int, int column, double) { ++counts(column); });
  full.resizeNonZeros(counts.sum());
  full.outerIndexPtr()[0] = 0;
  std::partial_sum(counts.begin(), counts.end(), full.outerIndexPtr() + 1);
  std::vector<int> next(full.outerIndexPtr(), full.outerIndexPtr() + n);
  for_each_entry(matrix, [&](int row, int column, double value) {
    const int place = next[static_cast<std::size_t>(column)]++;
    full.innerIndexPtr()[place] = row;
    full.valuePtr()[place] = value;
  });
  return full;
}

void refill(Eigen::SparseMatrix<double>& full, const SymmetricBlockMatrix& matrix) {
  MULDI_EXPECT(full.cols() == matrix.n_rows() && full.isCompressed(), "what full_matrix made of this pattern");
  // Visits come to every column in the order of full_matrix; the column starts serve as counters and are moved back.
  int* next = full.outerIndexPtr();
  for_each_entry(matrix, [&](int, int column, double value) { full.valuePtr()[next[column]++] = value; });
  for (Eigen::Index i = full.cols(); i > 0; --i) next[i] = next[i - 1];
  next[0] = 0;
}

struct SparseLu::Factor {
  Eigen::SparseMatrix<double> matrix;
  void* symbolic = nullptr;
  void* numeric = nullptr;
  std::array<double, UMFPACK_CONTROL> control{};
  std::array<double, UMFPACK_INFO> info{};

  Factor() { umfpack().defaults(control.data()); }
  ~Factor() {
    umfpack().free_numeric(&numeric);
    umfpack().free_symbolic(&symbolic);
  }
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;

  bool has_pattern_of(const Eigen::SparseMatrix<double>& other) const {
    return symbolic != nullptr && matrix.rows() == other.rows() && matrix.nonZeros() == other.nonZeros() &&
           std::equal(other.outerIndexPtr(), other.outerIndexPtr() + other.cols() + 1, matrix.outerIndexPtr()) &&
           std::equal(other.innerIndexPtr(), other.innerIndexPtr() + other.nonZeros(), matrix.innerIndexPtr());
  }
};

SparseLu::SparseLu() : factor_(std::make_unique<Factor>()) {}
SparseLu::~SparseLu() = default;
SparseLu::SparseLu(SparseLu&&) noexcept = default;
SparseLu& SparseLu::operator=(SparseLu&&) noexcept = default;

LuOutcome SparseLu::factorise(const Eigen::SparseMatrix<double>& matrix) {
  MULDI_EXPECT(matrix.rows() == matrix.cols() && matrix.isCompressed(), "a square compressed matrix");
  Factor& f = *factor_;
  umfpack().free_numeric(&f.numeric);
  SparseLibrary::keep_to_one_thread();
  const bool known = f.has_pattern_of(matrix);
  f.matrix = matrix;
  const int n = static_cast<int>(matrix.cols());
  const int* start = f.matrix.outerIndexPtr();
  const int* rows = f.matrix.innerIndexPtr();
  const double* values = f.matrix.valuePtr();
  int status = UMFPACK_OK;
  if (!known) {
    umfpack().free_symbolic(&f.symbolic);
    status = umfpack().symbolic(n, n, start, rows, values, &f.symbolic, f.control.data(), f.info.data());
  }
  if (status == UMFPACK_OK) {
    status = umfpack().numeric(start, rows, values, f.symbolic, &f.numeric, f.control.data(), f.info.data());
  }
  reciprocal_condition_ = status == UMFPACK_OK ? f.info[UMFPACK_RCOND] : 0.0;
  if (status == UMFPACK_OK) return LuOutcome::ok;
  umfpack().free_numeric(&f.numeric);
  if (status == UMFPACK_WARNING_singular_matrix) return LuOutcome::singular;
  MULDI_EXPECT(status == UMFPACK_ERROR_out_of_memory, "UMFPACK accepts every square matrix with ascending rows");
  return LuOutcome::out_of_memory;
}

int SparseLu::determinant_sign() const {
  double mantissa = 0.0;
  double exponent = 0.0;
  umfpack().determinant(&mantissa, &exponent, factor_->numeric, factor_->info.data());
  return mantissa > 0.0 ? 1 : mantissa < 0.0 ? -1 : 0;
}

void SparseLu::solve(const Eigen::Ref<const Eigen::VectorXd>& b, Eigen::Ref<Eigen::VectorXd> x) const {
  const Factor& f = *factor_;
  MULDI_EXPECT(f.numeric != nullptr, "there is a factor");
  MULDI_EXPECT(b.size() == f.matrix.rows() && x.size() == b.size() && x.data() != b.data(),
               "vectors of the matrix' size");
  const int status = umfpack().solve(UMFPACK_A, f.matrix.outerIndexPtr(), f.matrix.innerIndexPtr(), f.matrix.valuePtr(),
                                     x.data(), b.data(), f.numeric, f.control.data(), nullptr);
  if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
  MULDI_EXPECT(status == UMFPACK_OK || status == UMFPACK_WARNING_singular_matrix, "UMFPACK solves with its factor");
}

}  // namespace muldi::math
