#pragma once
/// Messages to the user on stderr; stdout carries what was asked for. Kernels do not log.
#include <string_view>

namespace muldi::base {

/// `quiet`: warnings and errors; `normal`: what happens; `verbose` (-v): details; `debug` (-vv): everything.
enum class Verbosity { quiet, normal, verbose, debug };

void set_verbosity(Verbosity verbosity);
Verbosity verbosity();

/// One line each, shown from the verbosity in the name of the level on.
void log_error(std::string_view message);
void log_warning(std::string_view message);
void log_info(std::string_view message);
void log_verbose(std::string_view message);
void log_debug(std::string_view message);

/// A line as it stands, without a level in front (diagnostics carry their own); shown at every verbosity.
void log_plain(std::string_view line);

}  // namespace muldi::base
