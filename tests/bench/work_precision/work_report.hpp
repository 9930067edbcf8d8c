#pragma once
/// The JSON of the work-precision programs: points of processor time against error, with what they are compared to.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "bench/bench_report.hpp"

namespace muldi::bench {

/// One run: what was asked for, how long it took, how wrong it was.
struct WorkPoint {
  std::string scene;
  std::string sweep;     ///< what varies along the curve: step, tolerance, mesh, formulation, solver, iteration
  std::string method;    ///< the curve
  std::string setting;   ///< e.g. "dt 2 ms"
  double seconds = 0.0;  ///< processor time, user and system, the least of several runs
  double error = 0.0;    ///< relative, NaN where the run failed
};

/// What errors are measured against.
struct Reference {
  std::string scene;
  std::string measure;                ///< what is compared, and relative to what
  std::string how;                    ///< where the reference comes from
  double uncertainty = std::nan("");  ///< of the reference, in units of the error
};

/// Every option of a method, and the version of a rival.
struct MethodOptions {
  std::string method;
  std::string version;  ///< "this commit", "SUNDIALS 6.4.1"
  std::string options;
};

class WorkReport {
 public:
  explicit WorkReport(std::string name) : name_(std::move(name)) {}

  void add(WorkPoint point) { points_.push_back(std::move(point)); }
  void add(Reference reference) { references_.push_back(std::move(reference)); }
  void add(MethodOptions options) { options_.push_back(std::move(options)); }

  void print() const {
    std::printf("{\n");
    print_origin(name_);
    std::printf("  \"references\": [");
    each(references_, [](const Reference& r) {
      std::printf("{\"scene\": %s, \"measure\": %s, \"how\": %s, \"uncertainty\": %s}", json_text(r.scene).c_str(),
                  json_text(r.measure).c_str(), json_text(r.how).c_str(), json_number(r.uncertainty).c_str());
    });
    std::printf("],\n  \"methods\": [");
    each(options_, [](const MethodOptions& m) {
      std::printf("{\"method\": %s, \"version\": %s, \"options\": %s}", json_text(m.method).c_str(),
                  json_text(m.version).c_str(), json_text(m.options).c_str());
    });
    std::printf("],\n  \"points\": [");
    each(points_, [](const WorkPoint& p) {
      std::printf("{\"scene\": %s, \"sweep\": %s, \"method\": %s, \"setting\": %s, \"seconds\": %s, \"error\": %s}",
                  json_text(p.scene).c_str(), json_text(p.sweep).c_str(), json_text(p.method).c_str(),
                  json_text(p.setting).c_str(), json_number(p.seconds).c_str(), json_number(p.error).c_str());
    });
    std::printf("]\n}\n");
  }

 private:
  template <class Item, class Print>
  static void each(const std::vector<Item>& items, Print&& print) {
    for (std::size_t i = 0; i < items.size(); ++i) {
      std::printf("%s\n    ", i == 0 ? "" : ",");
      print(items[i]);
    }
  }

  std::string name_;
  std::vector<WorkPoint> points_;
  std::vector<Reference> references_;
  std::vector<MethodOptions> options_;
};

/// Processor time of this process, user and system (s): other processes on the machine do not count.
inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Least processor time of a call of work(): at least two calls, up to twenty within `budget` seconds.
template <class Work>
double least_seconds(double budget, Work&& work) {
  double least = std::numeric_limits<double>::infinity();
  double spent = 0.0;
  for (int i = 0; i < 20 && (i < 2 || spent < budget); ++i) {
    const double start = processor_seconds();
    work();
    const double seconds = processor_seconds() - start;
    least = std::min(least, seconds);
    spent += seconds;
    if (spent > 4.0 * budget) break;  // a long run is repeatable as it is
  }
  return least;
}

/// Shortest text of a number.
inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace muldi::bench
