#pragma once
/// The verbs about many runs: sweep, calibrate; each returns the exit code.
#include <string>
#include <vector>

namespace muldi::app {

struct StudyArguments {
  std::string study;
  std::vector<std::string> overrides;
  std::string output;   ///< empty: by the name of the study
  std::string results;  ///< of calibrate; empty: by the name of the study
  std::string shard;    ///< `k/n`; empty: all points
  std::string slurm;    ///< script to write instead of running; empty: none
  std::string program;  ///< how this program was called
  int jobs = 1;
  bool merge = false;
  bool force = false;
  bool progress = true;
};

int sweep(const StudyArguments& arguments);
int calibrate(const StudyArguments& arguments);

}  // namespace muldi::app
