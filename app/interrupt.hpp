#pragma once
/// Ctrl-C and SIGTERM as a question that loops ask: the run ends after the current step with its results on disk.

namespace muldi::app {

/// Installs the handlers; a second signal ends the process at once. From then on a file that may grow no further is an
/// error of the write, not a signal.
void watch_interrupts();
bool interrupt_asked();

}  // namespace muldi::app
