/// Work against precision of optimal control: exact derivatives, a limited-memory Hessian, differences.
#include <cmath>
#include <cstring>

#include "bench/scene_runs.hpp"
#include "bench/work_precision/difference_nlp.hpp"
#include "bench/work_precision/work_report.hpp"
#include "control/nlp_solver.hpp"
#include "control/transcription.hpp"
#include "pipeline/optimal_guess.hpp"
#include "pipeline/optimal_problem.hpp"

namespace {

using namespace muldi;

enum class Derivatives { exact, approximate_hessian, grouped_differences, plain_differences };

constexpr Derivatives all_derivatives[] = {Derivatives::exact, Derivatives::approximate_hessian,
                                           Derivatives::grouped_differences, Derivatives::plain_differences};

std::string name_of(Derivatives derivatives) {
  switch (derivatives) {
    case Derivatives::exact:
      return "muldi-sim";
    case Derivatives::approximate_hessian:
      return "limited-memory Hessian";
    case Derivatives::grouped_differences:
      return "grouped differences, limited-memory Hessian";
    case Derivatives::plain_differences:
      return "plain differences, limited-memory Hessian";
  }
  return "";
}

struct Case {
  std::string name;
  std::string file;
  std::vector<std::string> overrides;
  double independent = std::nan("");  ///< sum of the squared fields, (kV/mm)^2
};

/// The iterates of one solve.
struct Trace {
  struct Row {
    double seconds = 0.0;
    double objective = 0.0;
    double infeasibility = 0.0;
  };
  std::vector<Row> rows = {};
  control::NlpResult result = {};
  double objective = std::nan("");  ///< of the result, in the user's scale
  double sum_squared_field = std::nan("");
  double seconds = 0.0;
};

class Problem {
 public:
  explicit Problem(const Case& one)
      : scene_(scene::read_scene(bench::scene_path(one.file), one.overrides)), built_(build::build_model(scene_)) {
    variational::State start;
    const pipeline::Outcome outcome = pipeline::initial_state(scene_, built_, {}, start);
    MULDI_EXPECT(outcome.completed(), "the problem has an initial state");
    problem_.emplace(pipeline::build_optimal_problem(scene_, built_, start.x));
    guess_ = pipeline::make_guess(scene_, built_, problem_->problem, 0);
  }

  /// Solves the last stage from the scene's guess, at most `limit` seconds; the transcription counts.
  Trace solve(Derivatives derivatives, double tolerance, double limit) {
    Trace trace;
    std::string why_not;
    const control::NlpSolver solver = control::open_nlp_solver(why_not);
    MULDI_EXPECT(solver != nullptr, "Ipopt is there");
    const double start = bench::processor_seconds();
    control::Transcription exact(problem_->problem, problem_->stages.back(), guess_);
    std::optional<bench::DifferenceNlp> differences;
    if (derivatives == Derivatives::grouped_differences || derivatives == Derivatives::plain_differences) {
      using Columns = bench::DifferenceNlp::Columns;
      differences.emplace(exact,
                          derivatives == Derivatives::grouped_differences ? Columns::grouped : Columns::one_by_one);
    }
    control::SolveOptions options{.max_iterations = 20000, .tolerance = tolerance};
    options.approximate_hessian = derivatives != Derivatives::exact;
    options.interrupted = [&] { return bench::processor_seconds() - start > limit; };
    options.progress = [&](const control::Iterate& iterate) {
      trace.rows.push_back({.seconds = bench::processor_seconds() - start,
                            .objective = iterate.objective / exact.objective_factor(),
                            .infeasibility = iterate.infeasibility});
    };
    control::Nlp& nlp = differences ? static_cast<control::Nlp&>(*differences) : exact;
    trace.result = solver(nlp, exact.unknowns_of(guess_), options);
    trace.seconds = bench::processor_seconds() - start;
    if (exact.move_to(trace.result.x)) trace.objective = exact.objective() / exact.objective_factor();
    trace.sum_squared_field = pipeline::sum_of_squared_fields(scene_, built_, exact.trajectory_of(trace.result.x));
    n_variables_ = exact.n_variables();
    n_constraints_ = exact.n_constraints();
    return trace;
  }

  int n_variables() const { return n_variables_; }
  int n_constraints() const { return n_constraints_; }

 private:
  scene::Scene scene_;
  build::BuiltModel built_;
  std::optional<pipeline::OptimalProblem> problem_;
  control::Trajectory guess_;
  int n_variables_ = 0;
  int n_constraints_ = 0;
};

double error_of(const Trace::Row& row, double optimum) {
  return std::max(std::abs(row.objective - optimum) / std::abs(optimum), row.infeasibility);
}

/// Adds for each level of the error the time after which the iterates stay below it.
void add_levels(bench::WorkReport& report, const std::string& scene, Derivatives derivatives, const Trace& trace,
                double optimum) {
  for (const double level : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    std::size_t first = trace.rows.size();
    while (first > 0 && error_of(trace.rows[first - 1], optimum) <= level) --first;
    const bool reached = first < trace.rows.size();
    report.add(bench::WorkPoint{
        .scene = scene,
        .sweep = "iteration",
        .method = name_of(derivatives),
        .setting = reached ? "iteration " + std::to_string(first)
                           : "not reached in " + bench::short_number(std::round(100.0 * trace.seconds) / 100.0) + " s",
        .seconds = reached ? trace.rows[first].seconds : std::nan(""),
        .error = level});
  }
}

void compare(bench::WorkReport& report, const Case& one, double limit, int repeats) {
  Problem problem(one);
  // Opens and warms the solver up; to the last digit.
  const Trace finest = problem.solve(Derivatives::exact, 1e-11, limit);
  const double optimum = finest.objective;
  const double distance = std::abs(finest.sum_squared_field - one.independent) / one.independent;
  report.add(bench::Reference{
      .scene = one.name,
      .measure =
          "the larger of the objective's relative error and the infeasibility; a level counts from the iterate after "
          "which it is kept; " +
          std::to_string(problem.n_variables()) + " unknowns, " + std::to_string(problem.n_constraints()) + " rows",
      .how = "our own solution to 1e-11" +
             (std::isnan(distance) ? std::string()
                                   : "; an independent program finds the same sum of squared fields within " +
                                         bench::short_number(distance)),
      .uncertainty = 1e-9});
  for (const Derivatives derivatives : all_derivatives) {
    Trace best;
    for (int i = 0; i < repeats; ++i) {
      Trace trace = problem.solve(derivatives, 1e-8, limit);
      if (i == 0 || trace.seconds < best.seconds) best = std::move(trace);
      if (best.seconds > 0.5 * limit) break;
    }
    add_levels(report, one.name, derivatives, best, optimum);
  }
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10}) {
    Trace best;
    for (int i = 0; i < repeats; ++i) {
      Trace trace = problem.solve(Derivatives::exact, tolerance, limit);
      if (i == 0 || trace.seconds < best.seconds) best = std::move(trace);
    }
    report.add(bench::WorkPoint{.scene = one.name,
                                .sweep = "tolerance",
                                .method = name_of(Derivatives::exact),
                                .setting = "tol " + bench::short_number(tolerance),
                                .seconds = best.seconds,
                                .error = std::abs(best.objective - optimum) / std::abs(optimum)});
  }
}

void add_methods(bench::WorkReport& report) {
  const std::string ipopt =
      "Ipopt 3.11.9 with MUMPS (AMF), adaptive barrier, bounds not relaxed, no scaling of its own, tolerance 1e-8; ";
  report.add(
      bench::MethodOptions{"muldi-sim", "this commit",
                           ipopt + "sparse exact first and second derivatives of the discrete equations of motion"});
  report.add(bench::MethodOptions{
      "limited-memory Hessian", "this commit",
      ipopt + "exact first derivatives, hessian_approximation limited-memory (BFGS, six pairs: the default)"});
  report.add(bench::MethodOptions{
      "grouped differences, limited-memory Hessian", "this commit",
      ipopt + "forward differences with step 1e-8, columns that share no row together; limited-memory Hessian"});
  report.add(
      bench::MethodOptions{"plain differences, limited-memory Hessian", "this commit",
                           ipopt + "forward differences with step 1e-8, column by column; limited-memory Hessian"});
}

}  // namespace

/// Argument --quick: the two small problems alone, with shorter limits.
int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
  bench::WorkReport report("work_optimal_control");
  add_methods(report);
  const Case joint{.name = "optimal control, joint 200 ms",
                   .file = "revolute_joint_optimal",
                   .overrides = {},
                   .independent = 5763.8653};
  const Case fast{.name = "optimal control, joint 70 ms",
                  .file = "revolute_joint_optimal",
                  .overrides = {"optimal_control.duration=70 ms", "optimal_control.step=5 ms"},
                  .independent = 11493.9116};
  const Case trunk{.name = "optimal control, trunk",
                   .file = "elephant_trunk_optimal",
                   .overrides = {"optimal_control.stages=[{minimise: {effort: {scale: 1.0e-14}}}]"}};
  compare(report, joint, quick ? 2.0 : 5.0, quick ? 2 : 4);
  compare(report, fast, quick ? 2.0 : 5.0, quick ? 2 : 4);
  if (!quick) compare(report, trunk, 8.0, 1);
  report.print();
}
