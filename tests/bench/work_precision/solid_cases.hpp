#pragma once
/// Scenes of finite elements as points of time against error.
#include "bench/work_precision/work_report.hpp"

namespace muldi::bench {

/// What a sweep may take.
struct Effort {
  bool quick = false;
  double budget = 0.1;  ///< s of repetitions a point
};

void sweep_cube(WorkReport& report, const Effort& effort);
void sweep_block(WorkReport& report, const Effort& effort);
void sweep_boxed_cube(WorkReport& report, const Effort& effort);
void sweep_membrane(WorkReport& report, const Effort& effort);
void sweep_finite_element_joint(WorkReport& report, const Effort& effort);

}  // namespace muldi::bench
