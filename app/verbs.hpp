#pragma once
/// The verbs of the command line; each in its own file, each returns the exit code.
#include <string>
#include <vector>

#include "results/compare.hpp"

namespace muldi::app {

struct RunArguments {
  std::string scene;
  std::vector<std::string> overrides;
  std::string output;  ///< empty: <scene stem>.h5 here, or the file to resume
  std::string resume;  ///< empty: a new run
  bool force = false;
  bool progress = true;
  bool paraview = true;  ///< write the side file
  int threads = 1;
  std::string command_line;
};

int run(const RunArguments& arguments);
int optimise(const RunArguments& arguments);
int check_derivatives(const std::string& scene, const std::vector<std::string>& overrides);
int validate(const std::vector<std::string>& scenes, const std::vector<std::string>& overrides);
int compare(const std::string& first, const std::string& second, const results::CompareOptions& options);
int info(const std::string& file);
int schema(bool of_studies, bool markdown);

/// `--version`: program, commit, compiler, libraries.
std::string version_text();

}  // namespace muldi::app
