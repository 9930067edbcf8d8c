/// Runs a fuzz target over files and folders of inputs, with any compiler: replay FILE_OR_FOLDER... The sanitizers
/// judge.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fuzz/target.hpp"

namespace {

std::vector<std::filesystem::path> files_of(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::is_directory(path)) return {path};
  for (const auto& entry : std::filesystem::directory_iterator(path)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The input, its beginning, and the input with a bit changed at each of some places: cheap hostility that needs no
/// libFuzzer.
void run_all(const std::string& input) {
  const auto run = [](const std::string& text) {
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  };
  run(input);
  constexpr std::size_t places = 4;
  for (std::size_t i = 1; i <= places && input.size() > places; ++i) {
    const std::size_t at = i * (input.size() - 1) / places;
    run(input.substr(0, at));
    std::string changed = input;
    changed[at] = static_cast<char>(changed[at] ^ (1 << i % 8));
    run(changed);
  }
}

}  // namespace

int main(int argc, char** argv) {
  int n = 0;
  for (int i = 1; i < argc; ++i) {
    for (const auto& path : files_of(argv[i])) {
      std::ifstream file(path, std::ios::binary);
      if (!file) {
        std::fprintf(stderr, "cannot read %s\n", path.c_str());
        return 2;
      }
      run_all(std::string(std::istreambuf_iterator<char>(file), {}));
      ++n;
    }
  }
  std::printf("%d inputs\n", n);
  return n > 0 ? 0 : 2;
}
