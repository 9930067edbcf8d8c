#include "app/progress_bar.hpp"

#include <unistd.h>

#include <cstdio>

#include "base/text.hpp"

namespace muldi::app {
namespace {
constexpr std::chrono::milliseconds redraw{100};
constexpr int bar_width = 30;
}  // namespace

ProgressBar::ProgressBar(bool enabled, std::string time_unit)
    : enabled_(enabled && isatty(STDERR_FILENO) != 0),
      unit_(std::move(time_unit)),
      start_(Clock::now()),
      next_(start_ + redraw) {}

ProgressBar::~ProgressBar() { clear(); }

void ProgressBar::update(long done, long all, double t) {
  if (!enabled_ || Clock::now() < next_) return;
  next_ = Clock::now() + redraw;
  draw(done, all, t);
}

void ProgressBar::draw(long done, long all, double t) {
  const double fraction = all > 0 ? static_cast<double>(done) / static_cast<double>(all) : 1.0;
  const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
  const double to_go = fraction > 0.0 ? elapsed * (1.0 - fraction) / fraction : 0.0;
  const int filled = static_cast<int>(fraction * bar_width);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(bar_width - filled), '.');
  const std::string line = base::format("\r[{}] {:3.0f} %  step {}/{}  t = {:.6g} {}  {:.0f} s to go \033[K", bar,
                                        100.0 * fraction, done, all, t, unit_, to_go);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear() {
  if (!drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace muldi::app
