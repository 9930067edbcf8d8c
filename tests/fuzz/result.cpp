/// Result files through all that reads them: summary, comparison with itself, single data sets, checkpoint,
/// continuation.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.hpp"
#include "fuzz/target.hpp"
#include "results/compare.hpp"
#include "results/info.hpp"
#include "results/result_file.hpp"

namespace {

/// HDF5 reads from files only; one a process, in memory where the system has such a folder.
const std::string& file_name() {
  static const std::string name =
      (std::filesystem::is_directory("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path().string()) +
      "/muldi_fuzz_" + std::to_string(getpid()) + ".h5";
  [[maybe_unused]] static const int removed = std::atexit([] { std::remove(name.c_str()); });
  return name;
}

template <class Action>
void try_to(const Action& action) {
  try {
    action();
  } catch (const muldi::base::InputError&) {
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace muldi;
  const std::string& name = file_name();
  std::ofstream(name, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  try_to([&] { results::info(name); });
  try_to([&] {
    const results::Comparison comparison = results::compare(name, name);
    results::to_text(comparison);
  });
  try_to([&] {
    const results::ResultFile file(name);
    try_to([&] { file.checkpoint(); });
    for (const std::string& path : file.data_sets()) {
      try_to([&] { file.last_row(path); });
      try_to([&] { file.read(path); });
      try_to([&] { file.attributes(path); });
    }
  });
  return 0;
}
