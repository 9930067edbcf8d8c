/// Work against precision of finite elements: steps, meshes, tolerances, formulations, solvers, and deal.II.
#include <cstring>
#include <ctime>

#include "base/parallel.hpp"
#include "bench/work_precision/solid_cases.hpp"

/// Arguments: --quick: fewer points, coarser references; and words: only the cases whose names contain one.
int main(int argc, char** argv) {
  using namespace muldi;
  bench::Effort effort;
  std::vector<std::string> wanted;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--quick") == 0) {
      effort = {.quick = true, .budget = 0.02};
    } else {
      wanted.emplace_back(argv[i]);
    }
  }
  base::set_threads(1);
  bench::WorkReport report("work_solids");
  report.add(bench::MethodOptions{"muldi-sim", "this commit",
                                  "hexahedra with eight Gauss points, midpoint variational integrator, Newton "
                                  "tolerance 1e-10, kept factors of an own "
                                  "L S L^T, formulation and solver by default unless said; one thread; of dynamics the "
                                  "time of the steps, of statics "
                                  "that of building and solving"});
  report.add(bench::MethodOptions{"deal.II 9.4", "9.4.1 (Debian)",
                                  "tests/bench/peer_dealii.cpp, -O3 -march=native: the same equations, mesh, step and "
                                  "increments (1e-10); hand-written "
                                  "law and tangent, loops that know their components; WorkStream on one thread, full "
                                  "Newton, GMRES(40) to 1e-6 with SSOR "
                                  "1.2 on displacements and ML on the potential; the time of the steps"});
  report.add(bench::MethodOptions{"deal.II 9.4, Q1-P0", "9.4.1 (Debian)",
                                  "tests/bench/peer_dealii_q1p0.cpp, -O3 -march=native: mechanics alone, mean "
                                  "dilatation condensed in each cell, full "
                                  "Newton to 1e-10, UMFPACK, one thread; the time of building and solving"});
  const std::pair<const char*, void (*)(bench::WorkReport&, const bench::Effort&)> cases[] = {
      {"membrane", bench::sweep_membrane},
      {"cube", bench::sweep_cube},
      {"block", bench::sweep_block},
      {"boxed", bench::sweep_boxed_cube},
      {"joint", bench::sweep_finite_element_joint}};
  for (const auto& [name, sweep] : cases) {
    bool is_wanted = wanted.empty();
    for (const std::string& word : wanted) is_wanted = is_wanted || std::string(name).find(word) != std::string::npos;
    if (!is_wanted) continue;
    const double start = bench::processor_seconds();
    sweep(report, effort);
    std::fprintf(stderr, "  %s: %.1f s\n", name, bench::processor_seconds() - start);
  }
  report.print();
}
