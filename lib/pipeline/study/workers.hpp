#pragma once
/// Tasks in processes of their own: a crash of one is a result like any other, and nothing leaks from one to the next.
#include <cstddef>
#include <functional>
#include <span>
#include <string>

namespace muldi::pipeline {

struct WorkerCalls {
  /// Runs in the child: the task's answer in one line.
  std::function<std::string(std::size_t task)> work;
  /// In the parent, as answers come. `answer` is empty where the process crashed; then `signal` says by which signal,
  /// or 0 if it ended early.
  std::function<void(std::size_t task, const std::string& answer, int signal)> done;
  std::function<bool()> interrupted = {};
};

/// Forks a child for each task, at most `jobs` at a time; they die with the parent. False if it was interrupted; then
/// the children have been ended. EnvironmentError if no process can be made.
bool run_in_processes(std::span<const std::size_t> tasks, int jobs, const WorkerCalls& calls);

}  // namespace muldi::pipeline
