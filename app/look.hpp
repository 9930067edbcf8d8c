#pragma once
/// The verbs for people: plot, report, paraview, new, explain; each returns the exit code.
#include <string>
#include <vector>

namespace muldi::app {

struct LookArguments {
  std::vector<std::string> files;
  std::vector<std::string> what;  ///< kinds of plots; empty: what the files hold
  std::string output;             ///< empty: by the name of the first file; for `new` standard output
  std::string word;               ///< kind of scene, or key path
  bool force = false;
};

/// What `plot --what` takes.
const std::vector<std::string>& plot_kinds();
/// The kinds of `new`, each with its sentence.
std::string starter_kinds();

int plot(const LookArguments& arguments);
int report(const LookArguments& arguments);
int paraview(const LookArguments& arguments);
int starter(const LookArguments& arguments);
int explain(const LookArguments& arguments);

}  // namespace muldi::app
