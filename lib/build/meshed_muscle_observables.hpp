#pragma once
/// What is recorded of muscles of finite elements, under the names that lumped muscles have.
#include <optional>
#include <string>
#include <vector>

#include "build/built_model.hpp"
#include "model/linear_point.hpp"
#include "model/supply.hpp"
#include "muscles/two_point_term.hpp"

namespace muldi::build {

struct MeshedMuscleRecord {
  std::string name = {};
  double length = 0.0;  ///< of the reference
  model::LinearPoint from = {};
  model::LinearPoint to = {};
  const TiedNodes& at_from;
  const TiedNodes& at_to;
  const fem::SolidRecords& records;
  int layers = 1;                              ///< of cells
  std::vector<int> driven = {};                ///< nodes of the electrodes that are not at potential 0; empty: no field
  muscles::ControlInput input = {};            ///< of the nominal field
  std::optional<double> layer_thickness = {};  ///< of the muscle's own layers
  model::ElectricRecord wanted = {};
};

/// muscles/<name>/length, stretch, force, and with a control field, true_field, and with a layer thickness
/// layer_voltage and charge; of driven muscles also the capacitance of one layer and the energies, where they are
/// wanted. The force is the mean of those on the two ends along the line between them, > 0 where they
/// pull. The charge is that of one of the muscle's own layers: n layers of cells of the same voltage a length carry n
/// times as much together.
void add_muscle_observables(MeshedMuscleRecord record, model::Model& model);

}  // namespace muldi::build
