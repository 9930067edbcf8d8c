#pragma once
/// Wall time of the named phases of a run (read, build, step, write, ...).
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace muldi::base {

struct Phase {
  std::string name = {};
  double seconds = 0.0;
  long count = 0;  ///< how often it was entered
};

/// Collects phases in the order of their first entry; one object a run, one thread.
class Phases {
 public:
  /// Adds wall time to the phase from its making to its end; phases may nest, each then counts its whole time.
  class Scope {
   public:
    Scope(Phases& phases, std::string_view name);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Phases& phases_;
    std::size_t index_;
    std::chrono::steady_clock::time_point start_;
  };

  /// Adds `seconds` to the phase `name`.
  void add(std::string_view name, double seconds);
  /// Seconds of the phase, 0 if it was never entered.
  double seconds(std::string_view name) const;
  const std::vector<Phase>& all() const { return phases_; }

 private:
  std::size_t index(std::string_view name);

  std::vector<Phase> phases_;
};

}  // namespace muldi::base
