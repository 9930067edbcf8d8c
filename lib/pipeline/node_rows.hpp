#pragma once
/// Rows of a series of nodes: observables, controls, energies, momenta, solver figures (scene format, section 4).
#include <optional>
#include <string>
#include <vector>

#include "build/built_model.hpp"
#include "pipeline/field_rows.hpp"
#include "results/recorder.hpp"
#include "variational/time_loop.hpp"

namespace muldi::pipeline {

/// Declares the channels of one series and fills its rows; nothing is allocated after the start of the recorder.
class NodeRows {
 public:
  enum class Kind { dynamics, statics, replay };  ///< a replay: dynamics under /replay

  NodeRows(results::Recorder& recorder, const scene::Scene& scene, const build::BuiltModel& built, Kind kind,
           std::size_t expected_rows);

  /// Values of the last row of all observables, for checkpoints.
  std::span<double> observed() { return observed_; }

  void write(const variational::NodeRecord& node);
  /// One equilibrium; `load` is the swept value.
  struct Equilibrium {
    double load;
    bool stable;
    int iterations;
    double residual;
    double violation;
    std::span<const model::Energy> parts;
    bool last;  ///< of the curve
  };
  void write(const Equilibrium& equilibrium, const model::NodeView& view);

 private:
  struct Recorded {
    const model::Observable* observable;
    results::Channel channel;
    std::size_t first;  // in observed_
  };
  results::Channel declare(const std::string& path, results::Shape shape, base::Dimension unit, const std::string& doc);
  void declare_common();
  void declare_dynamics();
  void declare_statics();
  void write_common(const model::NodeView& view, std::span<const model::Energy> parts);

  results::Recorder& recorder_;
  const build::BuiltModel& built_;
  Kind kind_;
  const base::UnitSystem& units_;
  std::string prefix_;
  results::Series series_;
  std::vector<Recorded> recorded_;
  std::vector<double> observed_;
  std::vector<results::Channel> controls_;
  std::vector<results::Channel> parts_;
  struct {
    results::Channel kinetic, elastic, electric, electric_after, gravity, dissipated, external, source, total, balance;
    results::Channel linear, angular;
    results::Channel iterations, residual, violation, factorisations;
    results::Channel stable;
  } channel_;
  std::optional<FieldRows> fields_;
  long record_every_;
  long serial_ = 0;
};

}  // namespace muldi::pipeline
