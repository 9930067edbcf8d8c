/// Work against precision of lumped scenes: our stepper, textbook integrators and CVODE on the same systems.
#include <cmath>
#include <cstring>

#include "bench/work_precision/energy_comparison.hpp"
#include "bench/work_precision/integrators.hpp"
#include "bench/work_precision/peer_run.hpp"
#include "bench/work_precision/published_systems.hpp"
#include "bench/work_precision/scene_motion.hpp"
#include "bench/work_precision/work_report.hpp"
#ifdef MULDI_CVODE
#include "bench/work_precision/cvode_rival.hpp"
#endif

namespace {

using namespace muldi;

const std::string ours = "muldi-sim";

struct Case {
  std::string name;  // of the scene in the report
  std::string file;
  std::unique_ptr<bench::MinimalSystem> system;
  std::string general_rival = {};  // the system's word for peer_simbody
  std::vector<std::string> overrides = {};
  double end = 0.0;
  double sample = 0.0;
  std::vector<double> steps = {};
  double reference_step = 0.0;
};

std::vector<std::vector<double>> rows_of(const bench::Samples& samples) {
  std::vector<std::vector<double>> rows;
  if (!samples.completed) return rows;
  for (const bench::Coordinates& x : samples.x) rows.emplace_back(x.data(), x.data() + x.size());
  return rows;
}

std::string step_text(double step) { return "dt " + bench::short_number(step) + " ms"; }
std::string tolerance_text(double tolerance) { return "tol " + bench::short_number(tolerance); }

class Comparison {
 public:
  Comparison(bench::WorkReport& report, const Case& one, double budget)
      : report_(report),
        case_(one),
        budget_(budget),
        ready_(scene::read_scene(bench::scene_path(one.file), one.overrides)),
        chart_(ready_.built.model->manifold->make_chart()) {
    const bench::Coordinates from = one.system->start();
    start_.assign(from.data(), from.data() + from.size());
    chart_->coordinates(ready_.state.x, theta_);
    our_start_ = theta_;
    make_reference();
  }

  void sweep_ours() {
    for (const double step : case_.steps) run_ours("step", ours, step_text(step), step, {});
  }

  void sweep_steps() {
    for (const double step : case_.steps) {
      run_ours("step", ours, step_text(step), step, {});
      for (const auto method : {bench::Method::runge_kutta_4, bench::Method::implicit_euler, bench::Method::trapezoidal,
                                bench::Method::generalised_alpha}) {
        std::vector<std::vector<double>> rows;
        const double seconds =
            bench::least_seconds(budget_, [&] { rows = rows_of(bench::integrate(*case_.system, method, grid(step))); });
        add("step", bench::name_of(method), step_text(step), seconds, rows);
      }
    }
  }

  void sweep_cvode() {
#ifdef MULDI_CVODE
    for (const auto method : {bench::CvodeMethod::adams, bench::CvodeMethod::bdf}) {
      for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
        std::vector<std::vector<double>> rows;
        const double seconds = bench::least_seconds(budget_, [&] {
          rows = rows_of(bench::integrate_with_cvode(*case_.system, method, tolerance, grid(case_.sample)));
        });
        add("step", bench::name_of(method), tolerance_text(tolerance), seconds, rows);
      }
    }
#endif
  }

  /// Another general program, with muscles that have no mass: it has no element of theirs.
  void sweep_simbody() {
    for (const auto& [word, method] :
         {std::pair("merson", "Simbody, Runge-Kutta-Merson"), {"cpodes", "Simbody, CPodes BDF"}}) {
      for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
        const auto n = static_cast<std::size_t>(case_.system->n());
        const auto n_samples = static_cast<std::size_t>(std::lround(case_.end / case_.sample));
        const auto numbers =
            bench::run_peer("peer_simbody",
                            case_.general_rival + " " + word + " " + bench::short_number(accuracy) + " " +
                                bench::short_number(case_.end) + " " + bench::short_number(case_.sample),
                            static_cast<int>(1 + n * n_samples));
        if (!numbers) return;
        std::vector<std::vector<double>> rows;
        for (std::size_t i = 0; i < n_samples; ++i) {
          const auto from = numbers->begin() + static_cast<std::ptrdiff_t>(1 + i * n);
          rows.emplace_back(from, from + static_cast<std::ptrdiff_t>(n));
        }
        add("step", method, "accuracy " + bench::short_number(accuracy), numbers->front(), rows);
      }
    }
  }

  void sweep_tolerances(double step) {
    for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
      run_ours("tolerance", ours + ", " + step_text(step), tolerance_text(tolerance), step, {.tolerance = tolerance});
    }
  }

  void sweep_solvers(const std::vector<double>& steps) {
    for (const std::string solver : {"tree", "dense"}) {
      for (const double step : steps) {
        run_ours("solver", ours + ", " + solver, step_text(step), step, {.linear = solver});
      }
    }
  }

 private:
  bench::Grid grid(double step) const { return {.step = step, .sample = case_.sample, .end = case_.end}; }

  void make_reference() {
    const auto method = bench::Method::runge_kutta_4;
    const auto coarse = rows_of(bench::integrate(*case_.system, method, grid(2.0 * case_.reference_step)));
    reference_ = rows_of(bench::integrate(*case_.system, method, grid(case_.reference_step)));
    MULDI_EXPECT(!reference_.empty(), "the reference run completes");
    report_.add(bench::Reference{.scene = case_.name,
                                 .measure = "largest difference of a coordinate at samples every " +
                                            bench::short_number(case_.sample) + " ms over " +
                                            bench::short_number(case_.end) + " ms, relative to the largest motion",
                                 .how = "hand-written equations in minimal coordinates, Runge-Kutta 4 with " +
                                        step_text(case_.reference_step) + " (independent of lib/)",
                                 .uncertainty = bench::motion_error(coarse, reference_, start_)});
  }

  void run_ours(const std::string& sweep, const std::string& method, const std::string& setting, double step,
                const variational::StepOptions& options) {
    const bench::Read read = [&](const variational::State& state, std::vector<double>& row) {
      chart_->coordinates(state.x, theta_);
      for (Eigen::Index k = 0; k < theta_.size(); ++k) {
        row.push_back(theta_[k] - our_start_[k] + start_[static_cast<std::size_t>(k)]);
      }
    };
    bench::Motion motion;
    const double seconds =
        bench::least_seconds(budget_, [&] { motion = bench::march(ready_, grid(step), options, read); });
    add(sweep, method, setting, seconds, motion.rows);
  }

  void add(const std::string& sweep, const std::string& method, const std::string& setting, double seconds,
           const std::vector<std::vector<double>>& rows) {
    report_.add(bench::WorkPoint{.scene = case_.name,
                                 .sweep = sweep,
                                 .method = method,
                                 .setting = setting,
                                 .seconds = seconds,
                                 .error = bench::motion_error(rows, reference_, start_)});
  }

  bench::WorkReport& report_;
  const Case& case_;
  double budget_;
  bench::ReadyScene ready_;
  std::unique_ptr<model::Chart> chart_;
  Eigen::VectorXd theta_;
  Eigen::VectorXd our_start_;
  std::vector<double> start_;
  std::vector<std::vector<double>> reference_;
};

void add_methods(bench::WorkReport& report) {
  report.add(bench::MethodOptions{
      ours, "this commit",
      "midpoint variational integrator in directors on the null space, fixed step, Newton tolerance 1e-10, linear "
      "solver "
      "auto unless said; the time is that of the steps with the making of their solver, on one thread"});
  for (const auto method : {bench::Method::runge_kutta_4, bench::Method::implicit_euler, bench::Method::trapezoidal,
                            bench::Method::generalised_alpha}) {
    report.add(bench::MethodOptions{bench::name_of(method), "tests/bench of this commit", bench::options_of(method)});
  }
#ifdef MULDI_CVODE
  for (const auto method : {bench::CvodeMethod::adams, bench::CvodeMethod::bdf}) {
    report.add(bench::MethodOptions{bench::name_of(method), bench::cvode_version(), bench::options_of(method)});
  }
#endif
  if (!bench::has_peer("peer_simbody")) return;
  const std::string simbody =
      "tests/bench/peer_simbody.cpp: a general multibody library in joint coordinates, built from bodies, pin joints "
      "and a "
      "custom force for each muscle; variable step, setAccuracy, the rest by default; ";
  report.add(bench::MethodOptions{"Simbody, Runge-Kutta-Merson", "3.7 (Debian)", simbody + "order 4, explicit"});
  report.add(bench::MethodOptions{"Simbody, CPodes BDF", "3.7 (Debian)", simbody + "BDF to order 5, Newton"});
}

}  // namespace

/// Argument --quick: fewer points, shorter motions.
int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
  const double budget = quick ? 0.02 : 0.1;
  bench::WorkReport report("work_multibody");
  add_methods(report);
  Case joint{.name = "lumped joint",
             .file = "revolute_joint_lumped",
             .system = bench::system_of(bench::joint_parts(10.0, bench::muscle_density)),
             .end = 1000.0,
             .sample = 20.0,
             .steps = {20, 10, 5, 2, 1, 0.5, 0.2, 0.1},
             .reference_step = 0.05};
  Case trunk{.name = "trunk",
             .file = "elephant_trunk_lumped",
             .system = bench::system_of(bench::trunk_parts(bench::muscle_density)),
             .end = quick ? 500.0 : 2000.0,
             .sample = 20.0,
             .steps = {20, 10, 5, 2, 1, 0.5, 0.25},
             .reference_step = 0.1};
  Case membrane{.name = "membrane, lumped",
                .file = "membrane_lumped",
                .system = bench::lumped_membrane(),
                .end = 5.0,
                .sample = 0.1,
                .steps = {0.1, 0.05, 0.02, 0.01, 0.005, 0.0025, 0.00125},
                .reference_step = 2.5e-4};
  for (const Case* one : {&joint, &trunk, &membrane}) {
    Comparison comparison(report, *one, budget);
    comparison.sweep_steps();
    comparison.sweep_cvode();
    if (one == &trunk) comparison.sweep_solvers({5, 1});
    if (one != &membrane) comparison.sweep_tolerances(one == &joint ? 2.0 : 5.0);
  }
  const std::vector<std::string> massless{"materials.silicone.density=1e-12"};
  Case joint_without{.name = "lumped joint, massless muscles",
                     .file = joint.file,
                     .system = bench::system_of(bench::joint_parts(10.0, 0.0)),
                     .general_rival = "joint",
                     .overrides = massless,
                     .end = joint.end,
                     .sample = joint.sample,
                     .steps = joint.steps,
                     .reference_step = joint.reference_step};
  Case trunk_without{.name = "trunk, massless muscles",
                     .file = trunk.file,
                     .system = bench::system_of(bench::trunk_parts(0.0)),
                     .general_rival = "trunk",
                     .overrides = massless,
                     .end = trunk.end,
                     .sample = trunk.sample,
                     .steps = trunk.steps,
                     .reference_step = trunk.reference_step};
  for (const Case* one : {&joint_without, &trunk_without}) {
    Comparison comparison(report, *one, budget);
    comparison.sweep_ours();
    comparison.sweep_simbody();
  }
  bench::compare_energies(report, quick ? 20e3 : 200e3, budget);
  report.print();
}
