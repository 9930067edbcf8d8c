#pragma once
/// The JSON that every benchmark program prints: what ran, on which processor, built how, and the figures.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "base/build_info.hpp"

namespace muldi::bench {

/// One figure. `bound` is the figure that the project asks for and `aim` the one that it wishes for, NaN if there is
/// none; less is better.
struct Figure {
  std::string name;
  double value = 0.0;
  std::string unit;
  double bound = std::nan("");
  double aim = std::nan("");
};

/// A number in JSON; null where it is not finite.
inline std::string json_number(double value) {
  if (!std::isfinite(value)) return "null";
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

inline std::string json_text(std::string_view text) {
  std::string result = "\"";
  for (const char character : text) {
    if (character == '"' || character == '\\') result += '\\';
    result += static_cast<unsigned char>(character) < 0x20 ? ' ' : character;
  }
  return result + '"';
}

inline std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

/// Prints the members that say what ran, on which processor and built how, a comma after the last.
inline void print_origin(std::string_view name) {
  const base::BuildInfo& build = base::build_info();
  std::printf("  \"name\": %s,\n  \"cpu\": %s,\n  \"cores\": %u,\n", json_text(name).c_str(),
              json_text(cpu_name()).c_str(), std::thread::hardware_concurrency());
  std::printf("  \"compiler\": %s,\n  \"flags\": %s,\n", json_text(build.compiler).c_str(),
              json_text(build.flags).c_str());
  std::printf("  \"version\": %s,\n  \"commit\": %s,\n  \"libraries\": {", json_text(build.version).c_str(),
              json_text(build.commit).c_str());
  for (std::size_t i = 0; i < build.libraries.size(); ++i) {
    std::printf("%s%s: %s", i == 0 ? "" : ", ", json_text(build.libraries[i].name).c_str(),
                json_text(build.libraries[i].version).c_str());
  }
  std::printf("},\n");
}

/// Collects the figures of one program; `print()` writes one JSON object to stdout.
class BenchReport {
 public:
  explicit BenchReport(std::string name) : name_(std::move(name)) {}

  void add(Figure figure) { figures_.push_back(std::move(figure)); }

  void print() const {
    std::printf("{\n");
    print_origin(name_);
    std::printf("  \"values\": [");
    for (std::size_t i = 0; i < figures_.size(); ++i) {
      const Figure& figure = figures_[i];
      std::printf("%s\n    {\"name\": %s, \"value\": %s, \"unit\": %s, \"bound\": %s, \"aim\": %s}", i == 0 ? "" : ",",
                  json_text(figure.name).c_str(), json_number(figure.value).c_str(), json_text(figure.unit).c_str(),
                  json_number(figure.bound).c_str(), json_number(figure.aim).c_str());
    }
    std::printf("\n  ]\n}\n");
  }

 private:
  std::string name_;
  std::vector<Figure> figures_;
};

/// Median of the seconds that `work()` takes in `repeats` calls, after one call that is not counted.
template <class Work>
double median_seconds(int repeats, Work&& work) {
  work();
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  const auto middle = seconds.begin() + repeats / 2;
  std::nth_element(seconds.begin(), middle, seconds.end());
  return *middle;
}

}  // namespace muldi::bench
