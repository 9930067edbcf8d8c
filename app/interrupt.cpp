#include "app/interrupt.hpp"

#include <csignal>

namespace muldi::app {
namespace {

volatile std::sig_atomic_t asked = 0;

void ask(int signal) {
  if (asked != 0) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  asked = 1;
}

}  // namespace

void watch_interrupts() {
  // A file size limit is a failed write like a full disk: not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGINT, ask);
  std::signal(SIGTERM, ask);
}

bool interrupt_asked() { return asked != 0; }

}  // namespace muldi::app
