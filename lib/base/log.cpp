#include "base/log.hpp"

#include <spdlog/logger.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/ansicolor_sink.h>

#include <memory>

namespace muldi::base {
namespace {

/// `warning: text`, coloured on a terminal; information comes bare.
class LevelPrefix : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&, spdlog::memory_buf_t& target) override {
    const std::string_view word = message.level == spdlog::level::warn  ? "warning: "
                                  : message.level == spdlog::level::err ? "error: "
                                                                        : "";
    target.append(word.data(), word.data() + word.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<LevelPrefix>(); }
};

spdlog::logger& logger() {
  static spdlog::logger only = [] {
    auto sink = std::make_shared<spdlog::sinks::ansicolor_stderr_sink_st>();
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<LevelPrefix>('*').set_pattern("%^%*%$%v");
    spdlog::logger made("muldi-sim", std::move(sink));
    made.set_formatter(std::move(formatter));
    made.set_level(spdlog::level::info);
    return made;
  }();
  return only;
}

Verbosity& current() {
  static Verbosity value = Verbosity::normal;
  return value;
}

void log(spdlog::level::level_enum level, std::string_view message) {
  logger().log(level, spdlog::string_view_t(message.data(), message.size()));
}

}  // namespace

void set_verbosity(Verbosity verbosity) {
  current() = verbosity;
  switch (verbosity) {
    case Verbosity::quiet:
      return logger().set_level(spdlog::level::warn);
    case Verbosity::normal:
      return logger().set_level(spdlog::level::info);
    case Verbosity::verbose:
      return logger().set_level(spdlog::level::debug);
    case Verbosity::debug:
      return logger().set_level(spdlog::level::trace);
  }
}

Verbosity verbosity() { return current(); }

void log_error(std::string_view message) { log(spdlog::level::err, message); }
void log_warning(std::string_view message) { log(spdlog::level::warn, message); }
void log_info(std::string_view message) { log(spdlog::level::info, message); }
void log_verbose(std::string_view message) { log(spdlog::level::debug, message); }
void log_debug(std::string_view message) { log(spdlog::level::trace, message); }
void log_plain(std::string_view line) { log(spdlog::level::critical, line); }

}  // namespace muldi::base
