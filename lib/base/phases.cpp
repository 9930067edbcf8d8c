#include "base/phases.hpp"

namespace muldi::base {

Phases::Scope::Scope(Phases& phases, std::string_view name)
    : phases_(phases), index_(phases.index(name)), start_(std::chrono::steady_clock::now()) {}

Phases::Scope::~Scope() {
  Phase& phase = phases_.phases_[index_];
  phase.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  ++phase.count;
}

std::size_t Phases::index(std::string_view name) {
  for (std::size_t i = 0; i < phases_.size(); ++i) {
    if (phases_[i].name == name) return i;
  }
  phases_.push_back({.name = std::string(name)});
  return phases_.size() - 1;
}

void Phases::add(std::string_view name, double seconds) {
  Phase& phase = phases_[index(name)];
  phase.seconds += seconds;
  ++phase.count;
}

double Phases::seconds(std::string_view name) const {
  for (const Phase& phase : phases_) {
    if (phase.name == name) return phase.seconds;
  }
  return 0.0;
}

}  // namespace muldi::base
