/// Work against precision of lumped scenes: our stepper, textbook integrators and CVODE on the same systems.
#include <cmath>
#include <cstring>

#include "bench/work_precision/integrators.hpp"
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
        ready_(scene::read_scene(bench::scene_path(one.file))),
        chart_(ready_.built.model->manifold->make_chart()) {
    const bench::Coordinates from = one.system->start();
    start_.assign(from.data(), from.data() + from.size());
    chart_->coordinates(ready_.state.x, theta_);
    our_start_ = theta_;
    make_reference();
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

/// Energy of the joint without viscosity: what is lost or won over a long time.
class EnergyComparison {
 public:
  EnergyComparison(bench::WorkReport& report, double end, double budget)
      : report_(report),
        end_(end),
        budget_(budget),
        system_(bench::lumped_joint(0.0)),
        ready_(scene::read_scene(
            bench::scene_path("revolute_joint_lumped"),
            std::vector<std::string>{"materials.silicone.viscous.viscosity=0", "muscles.upper.lumped.viscosity=0",
                                     "muscles.lower.lumped.viscosity=0"})) {
    report.add(bench::Reference{
        .scene = name,
        .measure = "largest departure of the total energy from its start at samples every 20 ms in the last tenth of " +
                   bench::short_number(1e-3 * end) + " s, relative to the largest kinetic energy",
        .how = "closed form: the energy of an undamped joint under a held voltage is constant",
        .uncertainty = 0.0});
  }

  void run() {
    for (const double step : {10.0, 5.0, 2.0, 1.0, 0.5}) {
      run_ours(step);
      for (const auto method : {bench::Method::runge_kutta_4, bench::Method::implicit_euler, bench::Method::trapezoidal,
                                bench::Method::generalised_alpha}) {
        bench::Samples samples;
        const double seconds =
            bench::least_seconds(budget_, [&] { samples = bench::integrate(*system_, method, grid(step)); });
        add(bench::name_of(method), step_text(step), seconds, drift_of(samples));
      }
    }
#ifdef MULDI_CVODE
    for (const auto method : {bench::CvodeMethod::adams, bench::CvodeMethod::bdf}) {
      for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
        bench::Samples samples;
        const double seconds = bench::least_seconds(
            budget_, [&] { samples = bench::integrate_with_cvode(*system_, method, tolerance, grid(20.0)); });
        add(bench::name_of(method), tolerance_text(tolerance), seconds, drift_of(samples));
      }
    }
#endif
  }

 private:
  static constexpr const char* name = "undamped lumped joint, energy";

  bench::Grid grid(double step) const { return {.step = step, .sample = 20.0, .end = end_}; }

  static double drift(const std::vector<double>& kinetic, const std::vector<double>& total) {
    double largest = 0.0;
    double departure = 0.0;
    for (std::size_t i = 0; i < total.size(); ++i) {
      largest = std::max(largest, kinetic[i]);
      if (10 * i >= 9 * total.size()) departure = std::max(departure, std::abs(total[i]));
    }
    return departure / largest;
  }

  double drift_of(const bench::Samples& samples) const {
    if (!samples.completed) return std::nan("");
    std::vector<double> kinetic, total;
    for (std::size_t i = 0; i < samples.x.size(); ++i) {
      kinetic.push_back(system_->kinetic(samples.x[i], samples.v[i]));
      total.push_back(kinetic.back() + system_->potential(samples.x[i]));
    }
    return drift(kinetic, total);
  }

  void run_ours(double step) {
    const bench::Read keep = [](const variational::State&, std::vector<double>&) {};
    const double seconds = bench::least_seconds(budget_, [&] { bench::march(ready_, grid(step), {}, keep); });
    // Energies in a run of their own: no rival's time contains them either.
    variational::NodeEvaluator nodes(*ready_.built.model, "auto");
    variational::NodeValues values;
    std::vector<double> u(ready_.built.model->controls.size());
    ready_.built.model->evaluate_controls(0.0, u);
    nodes.evaluate(ready_.state, u, u, values);
    const double start = values.total.kinetic + values.total.potential();
    std::vector<double> kinetic, total;
    bench::march(ready_, grid(step), {}, [&](const variational::State& state, std::vector<double>&) {
      nodes.evaluate(state, u, u, values);
      kinetic.push_back(values.total.kinetic);
      total.push_back(values.total.kinetic + values.total.potential() - start);
    });
    add(ours, step_text(step), seconds, drift(kinetic, total));
  }

  void add(const std::string& method, const std::string& setting, double seconds, double error) {
    report_.add(bench::WorkPoint{
        .scene = name, .sweep = "step", .method = method, .setting = setting, .seconds = seconds, .error = error});
  }

  bench::WorkReport& report_;
  double end_;
  double budget_;
  std::unique_ptr<bench::MinimalSystem> system_;
  bench::ReadyScene ready_;
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
             .system = bench::lumped_joint(10.0),
             .end = 1000.0,
             .sample = 20.0,
             .steps = {20, 10, 5, 2, 1, 0.5, 0.2, 0.1},
             .reference_step = 0.05};
  Case trunk{.name = "trunk",
             .file = "elephant_trunk_lumped",
             .system = bench::lumped_trunk(),
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
  EnergyComparison(report, quick ? 20e3 : 200e3, budget).run();
  report.print();
}
