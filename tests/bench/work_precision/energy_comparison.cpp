#include "bench/work_precision/energy_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "bench/work_precision/integrators.hpp"
#include "bench/work_precision/published_systems.hpp"
#include "bench/work_precision/scene_motion.hpp"
#ifdef MULDI_CVODE
#include "bench/work_precision/cvode_rival.hpp"
#endif

namespace muldi::bench {
namespace {

const std::string ours = "muldi-sim";

std::string step_text(double step) { return "dt " + short_number(step) + " ms"; }

/// Energy of the joint without viscosity: what is lost or won over a long time.
class EnergyComparison {
 public:
  EnergyComparison(WorkReport& report, double end, double budget)
      : report_(report),
        end_(end),
        budget_(budget),
        system_(system_of(joint_parts(0.0, muscle_density))),
        ready_(scene::read_scene(
            scene_path("revolute_joint_lumped"),
            std::vector<std::string>{"materials.silicone.viscous.viscosity=0", "muscles.upper.lumped.viscosity=0",
                                     "muscles.lower.lumped.viscosity=0"})) {
    report.add(Reference{
        .scene = name,
        .measure = "largest departure of the total energy from its start at samples every 20 ms in the last tenth of " +
                   short_number(1e-3 * end) + " s, relative to the largest kinetic energy",
        .how = "closed form: the energy of an undamped joint under a held voltage is constant",
        .uncertainty = 0.0});
    report.add(Reference{
        .scene = drift_name,
        .measure =
            "mean energy of the last tenth less that of the first (Hann windows), relative to the largest kinetic "
            "energy: what oscillates does not count, what is lost or won for good does",
        .how = "closed form: the energy is constant",
        .uncertainty = 1e-12});
  }

  void run() {
    for (const double step : {10.0, 5.0, 2.0, 1.0, 0.5}) {
      run_ours(step);
      for (const auto method :
           {Method::runge_kutta_4, Method::implicit_euler, Method::trapezoidal, Method::generalised_alpha}) {
        Samples samples;
        const double seconds = least_seconds(budget_, [&] { samples = integrate(*system_, method, grid(step)); });
        add(name_of(method), step_text(step), seconds, error_of(samples));
      }
    }
#ifdef MULDI_CVODE
    for (const auto method : {CvodeMethod::adams, CvodeMethod::bdf}) {
      for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
        Samples samples;
        const double seconds =
            least_seconds(budget_, [&] { samples = integrate_with_cvode(*system_, method, tolerance, grid(20.0)); });
        add(name_of(method), "tol " + short_number(tolerance), seconds, error_of(samples));
      }
    }
#endif
  }

 private:
  static constexpr const char* name = "undamped lumped joint, energy";
  static constexpr const char* drift_name = "undamped lumped joint, energy drift";

  Grid grid(double step) const { return {.step = step, .sample = 20.0, .end = end_}; }

  /// Relative to the largest kinetic energy.
  struct EnergyError {
    double departure = std::nan("");  ///< largest, in the last tenth
    double drift = std::nan("");      ///< of the mean of the last tenth from that of the first
  };

  /// Mean with a Hann window, which a bounded oscillation does not move.
  static double windowed_mean(std::span<const double> values) {
    double sum = 0.0;
    double weights = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double s = std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(values.size()));
      sum += s * s * values[i];
      weights += s * s;
    }
    return sum / weights;
  }

  static EnergyError error_of(const std::vector<double>& kinetic, const std::vector<double>& total) {
    const std::size_t tenth = total.size() / 10;
    const std::span<const double> all(total);
    double departure = 0.0;
    for (const double value : all.last(tenth)) departure = std::max(departure, std::abs(value));
    const double largest = *std::max_element(kinetic.begin(), kinetic.end());
    return {.departure = departure / largest,
            .drift = std::abs(windowed_mean(all.last(tenth)) - windowed_mean(all.first(tenth))) / largest};
  }

  EnergyError error_of(const Samples& samples) const {
    if (!samples.completed) return {};
    std::vector<double> kinetic, total;
    for (std::size_t i = 0; i < samples.x.size(); ++i) {
      kinetic.push_back(system_->kinetic(samples.x[i], samples.v[i]));
      total.push_back(kinetic.back() + system_->potential(samples.x[i]));
    }
    return error_of(kinetic, total);
  }

  void run_ours(double step) {
    const Read keep = [](const variational::State&, std::vector<double>&) {};
    const double seconds = least_seconds(budget_, [&] { march(ready_, grid(step), {}, keep); });
    // Energies in a run of their own: no rival's time contains them either.
    variational::NodeEvaluator nodes(*ready_.built.model, "auto");
    variational::NodeValues values;
    std::vector<double> u(ready_.built.model->controls.size());
    ready_.built.model->evaluate_controls(0.0, u);
    nodes.evaluate(ready_.state, u, u, values);
    const double start = values.total.kinetic + values.total.potential();
    std::vector<double> kinetic, total;
    march(ready_, grid(step), {}, [&](const variational::State& state, std::vector<double>&) {
      nodes.evaluate(state, u, u, values);
      kinetic.push_back(values.total.kinetic);
      total.push_back(values.total.kinetic + values.total.potential() - start);
    });
    add(ours, step_text(step), seconds, error_of(kinetic, total));
  }

  void add(const std::string& method, const std::string& setting, double seconds, const EnergyError& error) {
    for (const auto& [scene, value] : {std::pair(std::string(name), error.departure), {drift_name, error.drift}}) {
      // It has lost all that it can lose within the first tenth.
      if (scene == drift_name && method == name_of(Method::implicit_euler)) continue;
      report_.add(WorkPoint{
          .scene = scene, .sweep = "step", .method = method, .setting = setting, .seconds = seconds, .error = value});
    }
  }

  WorkReport& report_;
  double end_;
  double budget_;
  std::unique_ptr<MinimalSystem> system_;
  ReadyScene ready_;
};

}  // namespace

void compare_energies(WorkReport& report, double end, double budget) { EnergyComparison(report, end, budget).run(); }

}  // namespace muldi::bench
