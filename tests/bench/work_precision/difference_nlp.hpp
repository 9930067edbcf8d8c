#pragma once
/// A nonlinear program whose first derivatives are forward differences of its functions: what a user without
/// derivatives would give to the solver.
#include <algorithm>
#include <vector>

#include "control/nlp.hpp"

namespace muldi::bench {

class DifferenceNlp final : public control::Nlp {
 public:
  enum class Columns {
    one_by_one,  ///< as many evaluations as unknowns
    grouped,     ///< columns that share no row together (Curtis, Powell and Reid)
  };

  DifferenceNlp(control::Nlp& exact, Columns columns) : exact_(exact) {
    const auto n = static_cast<std::size_t>(exact.n_variables());
    entries_.resize(n);
    const control::SparsePattern& pattern = exact.jacobian_pattern();
    for (std::size_t k = 0; k < pattern.size(); ++k) {
      entries_[static_cast<std::size_t>(pattern.columns[k])].push_back(static_cast<int>(k));
    }
    group(columns);
  }

  int n_variables() const override { return exact_.n_variables(); }
  int n_constraints() const override { return exact_.n_constraints(); }
  const control::NlpBounds& bounds() const override { return exact_.bounds(); }
  const control::SparsePattern& jacobian_pattern() const override { return exact_.jacobian_pattern(); }
  const control::SparsePattern& hessian_pattern() const override { return exact_.hessian_pattern(); }

  bool move_to(const Eigen::VectorXd& x) override {
    x_ = x;
    return exact_.move_to(x);
  }
  double objective() override { return exact_.objective(); }
  void constraints(Eigen::VectorXd& out) override { exact_.constraints(out); }

  void gradient(Eigen::VectorXd& out) override {
    const double here = exact_.objective();
    out.resize(x_.size());
    Eigen::VectorXd x = x_;
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      const double h = step(j);
      x[j] += h;
      exact_.move_to(x);
      out[j] = (exact_.objective() - here) / h;
      x[j] = x_[j];
    }
    exact_.move_to(x_);
  }

  void jacobian(double* values) override {
    exact_.constraints(here_);
    const control::SparsePattern& pattern = exact_.jacobian_pattern();
    Eigen::VectorXd x = x_;
    for (const std::vector<int>& columns : groups_) {
      for (const int j : columns) x[j] += step(j);
      exact_.move_to(x);
      exact_.constraints(there_);
      for (const int j : columns) {
        for (const int k : entries_[static_cast<std::size_t>(j)]) {
          const int row = pattern.rows[static_cast<std::size_t>(k)];
          values[k] = (there_[row] - here_[row]) / step(j);
        }
        x[j] = x_[j];
      }
    }
    exact_.move_to(x_);
  }

  /// Never asked for: the solver approximates it.
  void hessian(double, const Eigen::VectorXd&, double* values) override {
    std::fill_n(values, hessian_pattern().size(), 0.0);
  }

  std::size_t n_groups() const { return groups_.size(); }

 private:
  double step(Eigen::Index j) const { return 1e-8 * std::max(1.0, std::abs(x_[j])); }

  void group(Columns columns) {
    const control::SparsePattern& pattern = exact_.jacobian_pattern();
    std::vector<std::vector<bool>> taken;  // rows of each group
    for (int j = 0; j < exact_.n_variables(); ++j) {
      const std::vector<int>& mine = entries_[static_cast<std::size_t>(j)];
      std::size_t g = columns == Columns::grouped ? 0 : groups_.size();
      const auto clashes = [&](std::size_t at) {
        return std::any_of(mine.begin(), mine.end(), [&](int k) {
          return taken[at][static_cast<std::size_t>(pattern.rows[static_cast<std::size_t>(k)])];
        });
      };
      while (g < groups_.size() && clashes(g)) ++g;
      if (g == groups_.size()) {
        groups_.emplace_back();
        taken.emplace_back(static_cast<std::size_t>(exact_.n_constraints()), false);
      }
      groups_[g].push_back(j);
      for (const int k : mine) taken[g][static_cast<std::size_t>(pattern.rows[static_cast<std::size_t>(k)])] = true;
    }
  }

  control::Nlp& exact_;
  std::vector<std::vector<int>> entries_;  // of each column, in the pattern
  std::vector<std::vector<int>> groups_;
  Eigen::VectorXd x_;
  Eigen::VectorXd here_;
  Eigen::VectorXd there_;
};

}  // namespace muldi::bench
