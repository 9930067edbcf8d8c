#pragma once
/// Progress on a terminal: bar, step, simulated time, time to go. Nothing elsewhere.
#include <chrono>
#include <string>

namespace muldi::app {

class ProgressBar {
 public:
  /// `enabled` false, or stderr not a terminal: does nothing.
  ProgressBar(bool enabled, std::string time_unit);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(long done, long all, double t);
  /// Removes the bar, so that other lines can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  void draw(long done, long all, double t);

  bool enabled_;
  bool drawn_ = false;
  std::string unit_;
  Clock::time_point start_;
  Clock::time_point next_;
};

}  // namespace muldi::app
