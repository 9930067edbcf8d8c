#pragma once
/// What the verbs that write a result file share.
#include <vector>

#include "app/verbs.hpp"
#include "base/diagnostic.hpp"
#include "base/phases.hpp"
#include "pipeline/advice.hpp"
#include "pipeline/outcome.hpp"
#include "results/hdf5_recorder.hpp"
#include "scene/scene.hpp"

namespace muldi::app {

void print(const std::vector<base::Diagnostic>& diagnostics);

/// The file that the options ask for; default `<scene stem>.h5` here.
results::Output output_of(const RunArguments& arguments);

/// Wall time of each phase, with -v.
void report_phases(const base::Phases& phases);

/// The end of a run that failed: its status, where and when, what it means and what to try, and where the result is.
void report_failure(const pipeline::Outcome& outcome, pipeline::Task task, const scene::Scene& scene,
                    const std::string& kept);

/// The files by which ParaView opens a result. The result is what counts: without room for them there is a warning.
void write_side_files(const std::string& path, const scene::Scene& scene);

}  // namespace muldi::app
