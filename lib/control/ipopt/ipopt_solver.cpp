#include "control/ipopt/ipopt_solver.hpp"

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>

namespace muldi::control {
namespace {

using Ipopt::Index;
using Ipopt::Number;
using Clock = std::chrono::steady_clock;

/// Bounds beyond this are none.
constexpr double no_bound = 2e19;

/// Adds the time of a scope to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), begin_(Clock::now()) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double>(Clock::now() - begin_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& sum_;
  Clock::time_point begin_;
};

// The patterns that Ipopt prints with are its own.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
/// Keeps what Ipopt prints.
class TextJournal final : public Ipopt::Journal {
 public:
  TextJournal(std::string& text, Ipopt::EJournalLevel level) : Journal("text", level), text_(text) {}

 protected:
  void PrintImpl(Ipopt::EJournalCategory, Ipopt::EJournalLevel, const char* text) override { text_ += text; }
  void PrintfImpl(Ipopt::EJournalCategory, Ipopt::EJournalLevel, const char* pattern, va_list values) override {
    std::array<char, 1024> line{};
    std::vsnprintf(line.data(), line.size(), pattern, values);
    text_ += line.data();
  }
  void FlushBufferImpl() override {}

 private:
  std::string& text_;
};
#pragma GCC diagnostic pop

void copy_bounds(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper, Number* l, Number* u) {
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    l[i] = std::max(lower[i], -no_bound);
    u[i] = std::min(upper[i], no_bound);
  }
}

// Ipopt gives the functions their parameters.
// NOLINTBEGIN(readability-function-size)
class Adapter final : public Ipopt::TNLP {
 public:
  Adapter(Nlp& nlp, const Eigen::VectorXd& start, const SolveOptions& options, NlpResult& result)
      : nlp_(nlp), start_(start), options_(options), result_(result), x_(start), vector_(start), best_(start) {}

  bool get_nlp_info(Index& n, Index& m, Index& n_jacobian, Index& n_hessian, IndexStyleEnum& style) override {
    n = nlp_.n_variables();
    m = nlp_.n_constraints();
    n_jacobian = static_cast<Index>(nlp_.jacobian_pattern().size());
    n_hessian = static_cast<Index>(nlp_.hessian_pattern().size());
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index, Number* x_l, Number* x_u, Index, Number* g_l, Number* g_u) override {
    const NlpBounds& bounds = nlp_.bounds();
    copy_bounds(bounds.x_lower, bounds.x_upper, x_l, x_u);
    copy_bounds(bounds.c_lower, bounds.c_upper, g_l, g_u);
    return true;
  }
  bool get_starting_point(Index n, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
    std::copy(start_.data(), start_.data() + n, x);
    return true;
  }
  bool eval_f(Index, const Number* x, bool is_new, Number& value) override {
    const Stopwatch watch(result_.function_time);
    if (!move_to(x, is_new)) return false;
    value = nlp_.objective();
    return std::isfinite(value);
  }
  bool eval_grad_f(Index, const Number* x, bool is_new, Number* out) override {
    const Stopwatch watch(result_.function_time);
    if (!move_to(x, is_new)) return false;
    nlp_.gradient(vector_);
    std::copy(vector_.data(), vector_.data() + vector_.size(), out);
    accepted_ = x_;
    return vector_.allFinite();
  }
  bool eval_g(Index, const Number* x, bool is_new, Index m, Number* out) override {
    const Stopwatch watch(result_.function_time);
    if (!move_to(x, is_new)) return false;
    nlp_.constraints(rows_);
    std::copy(rows_.data(), rows_.data() + m, out);
    return rows_.allFinite();
  }
  bool eval_jac_g(Index, const Number* x, bool is_new, Index, Index n_entries, Index* rows, Index* columns,
                  Number* values) override {
    if (values == nullptr) {
      std::copy_n(nlp_.jacobian_pattern().rows.data(), n_entries, rows);
      std::copy_n(nlp_.jacobian_pattern().columns.data(), n_entries, columns);
      return true;
    }
    const Stopwatch watch(result_.function_time);
    if (!move_to(x, is_new)) return false;
    nlp_.jacobian(values);
    return true;
  }
  bool eval_h(Index, const Number* x, bool is_new, Number factor, Index m, const Number* mu, bool, Index n_entries,
              Index* rows, Index* columns, Number* values) override {
    if (values == nullptr) {
      std::copy_n(nlp_.hessian_pattern().rows.data(), n_entries, rows);
      std::copy_n(nlp_.hessian_pattern().columns.data(), n_entries, columns);
      return true;
    }
    const Stopwatch watch(result_.hessian_time);
    if (!move_to(x, is_new)) return false;
    nlp_.hessian(factor, Eigen::Map<const Eigen::VectorXd>(mu, m), values);
    return true;
  }

  bool intermediate_callback(Ipopt::AlgorithmMode mode, Index iteration, Number objective, Number infeasibility,
                             Number dual, Number barrier, Number step, Number regularisation, Number alpha_dual,
                             Number alpha_primal, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    const bool restoration = mode == Ipopt::RestorationPhaseMode;
    result_.iterations = iteration;
    if (!restoration && accepted_.size() > 0) keep(objective, infeasibility);
    if (options_.progress) {
      options_.progress({.iteration = iteration,
                         .restoration = restoration,
                         .objective = objective,
                         .infeasibility = infeasibility,
                         .dual_infeasibility = dual,
                         .barrier = barrier,
                         .step_size = step,
                         .primal_step = alpha_primal,
                         .dual_step = alpha_dual,
                         .regularisation = regularisation});
    }
    return !options_.interrupted || !options_.interrupted();
  }

  void finalize_solution(Ipopt::SolverReturn status, Index n, const Number* x, const Number*, const Number*, Index,
                         const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    const bool solved =
        status == Ipopt::SUCCESS || status == Ipopt::STOP_AT_ACCEPTABLE_POINT || status == Ipopt::FEASIBLE_POINT_FOUND;
    const bool keeps_best = status == Ipopt::USER_REQUESTED_STOP || status == Ipopt::MAXITER_EXCEEDED;
    result_.x = !solved && keeps_best ? best_ : Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(x, n));
  }

  const Eigen::VectorXd& best() const { return best_; }

 private:
  bool move_to(const Number* x, bool is_new) {
    if (!is_new && moved_) return valid_;
    x_ = Eigen::Map<const Eigen::VectorXd>(x, x_.size());
    moved_ = true;
    return valid_ = x_.allFinite() && nlp_.move_to(x_);
  }

  /// Feasible iterates by their objective, others by their infeasibility.
  void keep(double objective, double infeasibility) {
    const double threshold = 10.0 * options_.tolerance;
    const bool feasible = infeasibility <= threshold;
    const bool better = feasible ? !(best_infeasibility_ <= threshold) || objective <= best_objective_
                                 : infeasibility < best_infeasibility_;
    if (!better) return;
    best_ = accepted_;
    best_objective_ = objective;
    best_infeasibility_ = infeasibility;
  }

  Nlp& nlp_;
  const Eigen::VectorXd& start_;
  const SolveOptions& options_;
  NlpResult& result_;
  Eigen::VectorXd x_;
  Eigen::VectorXd vector_;
  Eigen::VectorXd rows_;
  Eigen::VectorXd accepted_;
  Eigen::VectorXd best_;
  double best_objective_ = infinity;
  double best_infeasibility_ = infinity;
  bool moved_ = false;
  bool valid_ = false;
};

// NOLINTEND(readability-function-size)

void set_status(Ipopt::ApplicationReturnStatus status, NlpResult& result) {
  using S = SolveStatus;
  const auto set = [&](S ours, const char* sentence) {
    result.status = ours;
    result.sentence = sentence;
  };
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Feasible_Point_Found:
      return set(S::optimal, "solved to the tolerance");
    case Ipopt::Solved_To_Acceptable_Level:
      return set(S::acceptable, "solved to a looser tolerance; the last digits could not be reached");
    case Ipopt::Infeasible_Problem_Detected:
      return set(S::infeasible, "no motion near the guess fulfils all conditions: the violation has a minimum there");
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return set(S::failed, "the steps became too small to go on");
    case Ipopt::Diverging_Iterates:
      return set(S::failed, "the iterates grow without bound");
    case Ipopt::User_Requested_Stop:
      return set(S::interrupted, "interrupted; the best iterate so far is kept");
    case Ipopt::Maximum_Iterations_Exceeded:
    case Ipopt::Maximum_CpuTime_Exceeded:
      return set(S::iteration_limit, "the limit of iterations is reached; the best iterate so far is kept");
    case Ipopt::Restoration_Failed:
      return set(S::infeasible, "the search for a motion that fulfils the conditions failed");
    case Ipopt::Not_Enough_Degrees_Of_Freedom:
      return set(S::failed, "more conditions than freedoms");
    case Ipopt::Invalid_Number_Detected:
      return set(S::failed, "the functions could not be evaluated at the guess");
    case Ipopt::Insufficient_Memory:
      return set(S::failed, "not enough memory");
    default:
      return set(S::failed, "the solver stopped with an error of its own");
  }
}

void set_options(Ipopt::OptionsList& list, const SolveOptions& options) {
  list.SetStringValue("sb", "yes");
  list.SetIntegerValue("print_level", 0);
  list.SetStringValue("linear_solver", "mumps");
  list.SetIntegerValue("mumps_pivot_order", 2);
  list.SetNumericValue("tol", options.tolerance);
  list.SetIntegerValue("max_iter", options.max_iterations);
  list.SetStringValue("mu_strategy", "adaptive");
  list.SetNumericValue("bound_relax_factor", 0.0);
  // Unknowns, rows and the objective are scaled by the transcription.
  list.SetStringValue("nlp_scaling_method", "none");
  if (options.approximate_hessian) list.SetStringValue("hessian_approximation", "limited-memory");
  if (!options.check_derivatives) return;
  list.SetStringValue("derivative_test", "second-order");
  list.SetNumericValue("point_perturbation_radius", 0.0);
  list.SetNumericValue("derivative_test_tol", 1e-5);
}

/// "... detected 3 error(s)." in what the check prints.
int count_errors(const std::string& text) {
  if (text.find("No errors detected") != std::string::npos) return 0;
  const std::size_t at = text.find("detected ");
  return at == std::string::npos ? -1 : std::atoi(text.c_str() + at + 9);
}

}  // namespace

NlpResult solve_with_ipopt(Nlp& nlp, const Eigen::VectorXd& start, const SolveOptions& options) {
  NlpResult result;
  result.x = start;
  try {
    Ipopt::SmartPtr<Ipopt::IpoptApplication> solver = new Ipopt::IpoptApplication(false);
    solver->RethrowNonIpoptException(true);
    std::string log;
    if (options.check_derivatives) {
      solver->Jnlst()->AddJournal(Ipopt::SmartPtr<Ipopt::Journal>(new TextJournal(log, Ipopt::J_WARNING)));
    }
    set_options(*solver->Options(), options);
    if (solver->Initialize("") != Ipopt::Solve_Succeeded) {
      result.sentence = "the solver does not accept its options";
      return result;
    }
    Ipopt::SmartPtr<Adapter> adapter = new Adapter(nlp, start, options, result);
    set_status(solver->OptimizeTNLP(Ipopt::SmartPtr<Ipopt::TNLP>(Ipopt::GetRawPtr(adapter))), result);
    if (options.check_derivatives) {
      result.derivative_errors = count_errors(log);
      result.derivative_log = log;
    }
  } catch (const std::exception& error) {
    result.sentence = std::string("the solver failed: ") + error.what();
  }
  return result;
}

}  // namespace muldi::control

extern "C" const muldi::control::NlpSolver muldi_solve_nlp = &muldi::control::solve_with_ipopt;
