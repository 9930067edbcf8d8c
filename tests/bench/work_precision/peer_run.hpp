#pragma once
/// Rivals that are programs of their own: the figures that they print, nothing where they have not been built.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace muldi::bench {

inline std::string peer_path(const std::string& name) { return std::string(MULDI_BINARY_DIR) + "/bench/" + name; }

inline bool has_peer(const std::string& name) { return access(peer_path(name).c_str(), X_OK) == 0; }

/// The `n` numbers that the peer prints; nothing if it has not been built.
inline std::optional<std::vector<double>> run_peer(const std::string& name, const std::string& arguments, int n) {
  if (!has_peer(name)) return std::nullopt;
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
  // Its BLAS on one thread, as ours.
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  setenv("OMP_NUM_THREADS", "1", 0);
  FILE* output = popen((peer_path(name) + " " + arguments).c_str(), "r");
  MULDI_EXPECT(output != nullptr, "the peer starts");
  std::vector<double> numbers(static_cast<std::size_t>(n));
  int n_read = 0;
  for (double& number : numbers) n_read += std::fscanf(output, "%lf", &number) == 1 ? 1 : 0;
  const int status = pclose(output);
  MULDI_EXPECT(n_read == n && status == 0, "the peer prints its figures");
  return numbers;
}

}  // namespace muldi::bench
