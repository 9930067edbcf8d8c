#include "app/python_program.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "base/error.hpp"
#include "base/text.hpp"

namespace muldi::app {
namespace {

namespace fs = std::filesystem;

fs::path program_file(const std::string& name) {
  std::error_code none;
  const fs::path self = fs::read_symlink("/proc/self/exe", none);
  const fs::path installed = self.parent_path().parent_path() / "share" / "muldi-sim" / "look" / (name + ".py");
  const fs::path source = fs::path(MULDI_LOOK_FOLDER) / (name + ".py");
  for (const fs::path& path : {installed, source}) {
    if (fs::exists(path, none)) return path;
  }
  throw base::EnvironmentError(base::format("the program of '{}' is missing: neither {} nor {} exists", name,
                                            installed.string(), source.string()));
}

std::string python() {
  const char* chosen = std::getenv("MULDI_PYTHON");
  if (chosen != nullptr && *chosen != '\0') return chosen;
  // Debian's modules belong to Debian's Python; another one may come first on the path.
  std::error_code none;
  return fs::exists("/usr/bin/python3", none) ? "/usr/bin/python3" : "python3";
}

/// Standard input from a text, through a file without a name.
void feed(const std::string& input) {
  std::FILE* file = std::tmpfile();
  const bool written = file != nullptr && std::fwrite(input.data(), 1, input.size(), file) == input.size() &&
                       std::fflush(file) == 0 && std::fseek(file, 0, SEEK_SET) == 0;
  if (!written || dup2(fileno(file), STDIN_FILENO) < 0) {
    throw base::EnvironmentError("cannot write a temporary file");
  }
}

}  // namespace

void become_python(const std::string& name, const std::vector<std::string>& arguments, const std::string& input) {
  std::vector<std::string> words{python(), program_file(name).string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  if (!input.empty()) feed(input);
  std::fflush(nullptr);
  execvp(pointers.front(), pointers.data());
  throw base::EnvironmentError(
      base::format("cannot start Python ({}); as root: apt-get install python3", words.front()));
}

}  // namespace muldi::app
