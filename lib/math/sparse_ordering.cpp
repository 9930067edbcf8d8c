#include "math/sparse_ordering.hpp"

#include <amd.h>
#include <dlfcn.h>
#include <metis.h>

#include <cstring>
#include <new>
#include <numeric>

#include "base/error.hpp"

namespace muldi::math {
namespace {

std::vector<int> natural_order(const NodeGraph& graph) {
  std::vector<int> order(graph.weights.size());
  std::iota(order.begin(), order.end(), 0);
  return order;
}

std::vector<int> minimum_degree_order(const NodeGraph& graph) {
  std::vector<int> order = natural_order(graph);
  const int status =
      amd_order(graph.n_nodes(), graph.start.data(), graph.neighbours.data(), order.data(), nullptr, nullptr);
  if (status == AMD_OUT_OF_MEMORY) throw std::bad_alloc();
  MULDI_EXPECT(status == AMD_OK, "AMD accepts every graph with ascending neighbours");
  return order;
}

/// METIS, opened by the first graph that wants it: runs without large matrices start without it.
struct Metis {
  decltype(&METIS_SetDefaultOptions) set_default_options = nullptr;
  decltype(&METIS_NodeND) node_nd = nullptr;

  Metis() {
    void* const library = ::dlopen("libmetis.so.5", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      // Another order than METIS's gives other bits: taken where there is no METIS, never where there is no room for
      // it.
      const char* const why = ::dlerror();
      if (why == nullptr || std::strstr(why, "No such file") == nullptr) throw std::bad_alloc();
      return;
    }
    set_default_options = reinterpret_cast<decltype(set_default_options)>(::dlsym(library, "METIS_SetDefaultOptions"));
    node_nd = reinterpret_cast<decltype(node_nd)>(::dlsym(library, "METIS_NodeND"));
  }
  bool found() const { return set_default_options != nullptr && node_nd != nullptr; }
};

std::vector<int> nested_dissection_order(const NodeGraph& graph) {
  static_assert(sizeof(idx_t) == sizeof(int), "METIS is built with 32-bit indices");
  static const Metis metis;
  if (!metis.found()) return minimum_degree_order(graph);
  idx_t n = graph.n_nodes();
  idx_t options[METIS_NOPTIONS];
  metis.set_default_options(options);
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  // METIS takes its input by pointers to what it could change, and does not change it.
  NodeGraph copy = graph;
  std::vector<int> order(graph.weights.size());
  std::vector<int> position(graph.weights.size());
  const int status = metis.node_nd(&n, copy.start.data(), copy.neighbours.data(), copy.weights.data(), options,
                                   order.data(), position.data());
  if (status == METIS_ERROR_MEMORY) throw std::bad_alloc();
  MULDI_EXPECT(status == METIS_OK, "METIS accepts every graph that fits into memory");
  return order;
}

}  // namespace

std::string_view name_of(Ordering ordering) {
  switch (ordering) {
    case Ordering::automatic:
      return "automatic";
    case Ordering::natural:
      return "natural";
    case Ordering::minimum_degree:
      return "minimum_degree";
    case Ordering::nested_dissection:
      return "nested_dissection";
  }
  return "";
}

std::vector<int> elimination_order(const NodeGraph& graph, Ordering ordering) {
  MULDI_EXPECT(ordering != Ordering::automatic, "automatic is a choice among orders, not an order");
  if (graph.neighbours.empty()) return natural_order(graph);  // the libraries want edges
  if (ordering == Ordering::minimum_degree) return minimum_degree_order(graph);
  if (ordering == Ordering::nested_dissection) return nested_dissection_order(graph);
  return natural_order(graph);
}

}  // namespace muldi::math
