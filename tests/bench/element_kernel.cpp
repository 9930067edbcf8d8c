/// The element kernels by instruction set: processor time an element, beside the machine's own rate of fused
/// multiply-adds in the same run.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <map>
#include <memory>
#include <random>
#include <string>

#include "bench/bench_report.hpp"
#include "fem/kernel/element_kernels.hpp"

namespace {

using namespace muldi;
using namespace muldi::fem;

constexpr int n_side = 16;
constexpr int n_line = n_side + 1;
constexpr int n_elements = n_side * n_side * n_side;
constexpr int n_nodes = n_line * n_line * n_line;

/// A cube of n_side^3 distorted elements, deformed, in motion and in a field.
struct Cube {
  std::vector<std::array<int, 8>> elements;
  std::vector<double> X, x, v, phi;

  Cube() {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> noise(-0.1, 0.1);
    for (int n = 0; n < n_nodes; ++n) {
      const int at[3] = {n % n_line, n / n_line % n_line, n / n_line / n_line};
      for (const int coordinate : at) {
        X.push_back(coordinate + noise(random));
        x.push_back(1.05 * X.back() + 0.5 * noise(random));
        v.push_back(noise(random));
      }
      phi.push_back(2e4 * X[X.size() - 1] + 1e3 * noise(random));
    }
    for (int e = 0; e < n_elements; ++e) {
      const int first = e % n_side + n_line * (e / n_side % n_side + n_line * (e / n_side / n_side));
      const int above = first + n_line * n_line;
      elements.push_back(
          {first, first + 1, first + 1 + n_line, first + n_line, above, above + 1, above + 1 + n_line, above + n_line});
    }
  }

  /// Slots of the upper block triangle, rows one after the other.
  std::vector<std::int32_t> slots(const ElementOrder& order, int& n_slots) const {
    std::map<std::pair<int, int>, std::int32_t> known;
    for (const auto& nodes : elements) {
      for (const int a : nodes)
        for (const int b : nodes)
          if (a <= b) known[{a, b}] = 0;
    }
    n_slots = 0;
    for (auto& entry : known) entry.second = n_slots++;
    return order.block_slots([&](int row, int column) {
      return row <= column ? 2 * known.at({row, column}) : 2 * known.at({column, row}) + 1;
    });
  }
};

/// Processor seconds of the fastest of nine calls: other work on the machine counts little.
template <class Work>
double least_seconds(const Work& work) {
  double least = 1e300;
  for (int i = 0; i < 9; ++i) {
    const std::clock_t start = std::clock();
    work();
    least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

constexpr int n_chains = 12;

// A macro, since the target of a function does not reach templates that it calls.
#define MULDI_CHAINS(name, instructions, bytes)                           \
  [[gnu::target(instructions), gnu::noinline]] double name(long rounds) { \
    using V = double __attribute__((vector_size(bytes)));                 \
    V sum[n_chains];                                                      \
    for (int c = 0; c < n_chains; ++c) sum[c] = V{} + 1e-3 * c;           \
    const V factor = V{} + 0.999999;                                      \
    const V term = V{} + 1e-7;                                            \
    for (long round = 0; round < rounds; ++round) {                       \
      for (V & s : sum) s = s * factor + term;                            \
    }                                                                     \
    double all = 0.0;                                                     \
    for (const V& s : sum) all += s[0];                                   \
    return all;                                                           \
  }
MULDI_CHAINS(chains_v1, "sse2", 16)
MULDI_CHAINS(chains_v3, "avx2,fma", 32)
MULDI_CHAINS(chains_v4, "avx512f", 64)

/// Multiplications and additions a second of independent chains, in 1e9 (fused where the set can).
double operation_rate(Isa isa) {
  constexpr long n_rounds = 2'000'000;
  double all = 0.0;
  const double seconds = least_seconds([&] {
    all += isa == Isa::v1 ? chains_v1(n_rounds) : isa == Isa::v3 ? chains_v3(n_rounds) : chains_v4(n_rounds);
  });
  if (all == 0.0) std::abort();
  const int lanes = isa == Isa::v1 ? 2 : isa == Isa::v3 ? 4 : 8;
  return 1e-9 * 2.0 * n_chains * lanes * static_cast<double>(n_rounds) / seconds;
}

struct Case {
  std::string name;
  Material material;
};

std::vector<Case> cases() {
  constexpr double eps0 = 8.8542e-12;
  const KelvinVoigt viscous{.viscosity = 0.4};
  return {{"neo_hookean + ideal_dielectric + kelvin_voigt",
           {.density = 1e-3,
            .elastic = NeoHookean{.mu = 0.233},
            .electric = IdealDielectric{.permittivity = 3.7 * eps0},
            .viscous = viscous}},
          {"bonet_wood + vu + kelvin_voigt",
           {.density = 1e-3,
            .elastic = BonetWood{.mu = 0.233, .lambda = 10.0},
            .electric = Vu{.c1 = 5e-8, .c2 = 1e-9, .eps0 = eps0},
            .viscous = viscous}}};
}

class KernelRun {
 public:
  KernelRun(const Cube& cube, Isa isa)
      : cube_(cube),
        kernels_(element_kernels(isa)),
        order_(cube.elements, std::vector<int>(n_elements, 0), kernels_.lanes),
        force_(3 * n_nodes),
        charge_(n_nodes),
        momentum_(3 * n_nodes) {
    int n_slots = 0;
    slots_ = cube.slots(order_, n_slots);
    storage_.resize(16 * static_cast<std::size_t>(n_slots) + 8);
    // Blocks at cache lines.
    void* first = storage_.data();
    std::size_t space = 8 * storage_.size();
    values_ = static_cast<double*>(std::align(64, 8, first, space));
  }

  void report(const Case& of, double rate, bench::BenchReport& report) {
    const MaterialLaws laws = laws_of(of.material);
    const ElementFields fields{.X = cube_.X.data(), .x = cube_.x.data(), .v = cube_.v.data(), .phi = cube_.phi.data()};
    const ForceTargets to{.force = force_.data(), .charge = charge_.data(), .momentum = momentum_.data()};
    const FieldDirections along{.x = cube_.v.data(), .v = cube_.x.data(), .phi = cube_.phi.data()};
    const ElementTangentWeights weights{.mass = 1e3, .stiffness = 0.25, .rate = 0.5};
    const BlockTarget matrix{.block = 4, .values = values_, .slots = slots_.data()};
    const double residual = each([&](const auto& range) { kernels_.forces(laws, range, fields, to); });
    const double action = each([&](const auto& range) { kernels_.action(laws, range, fields, along, to); });
    const double tangent = each([&](const auto& range) { kernels_.tangent(laws, range, fields, weights, matrix); });
    const std::string head = std::string(kernels_.name) + ", " + of.name + ": ";
    report.add({head + "residual", residual, "us"});
    report.add({head + "action", action, "us"});
    report.add({head + "tangent and scatter", tangent, "us"});
    report.add({head + "residual, tangent and scatter", residual + tangent, "us",
                kernels_.isa == best_isa() ? 3.0 : std::nan(""), kernels_.isa == best_isa() ? 2.0 : std::nan("")});
    report.add({head + "operations that the peak would do in that time", 1e3 * (residual + tangent) * rate, "1"});
  }

 private:
  /// Microseconds an element of a pass over all chunks.
  template <class Work>
  double each(const Work& work) {
    return 1e6 / n_elements * least_seconds([&] {
             for_each_chunk(order_, one_after_the_other,
                            [&](const ElementOrder::Chunk& chunk, int) { work(order_.range(chunk)); });
           });
  }

  const Cube& cube_;
  const ElementKernels& kernels_;
  ElementOrder order_;
  std::vector<std::int32_t> slots_;
  std::vector<double> force_, charge_, momentum_, storage_;
  double* values_ = nullptr;
};

}  // namespace

int main() {
  bench::BenchReport report("element_kernel");
  const Cube cube;
  for (const Isa isa : {Isa::v1, Isa::v3, Isa::v4}) {
    if (!runs(isa)) continue;
    KernelRun run(cube, isa);
    const double rate = operation_rate(isa);
    report.add({std::string(element_kernels(isa).name) + ", peak of one core", rate, "GF/s"});
    for (const Case& of : cases()) run.report(of, rate, report);
  }
  report.print();
}
