#include "pipeline/study/workers.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <vector>

#include "base/error.hpp"

namespace muldi::pipeline {
namespace {

struct Child {
  pid_t process = -1;
  int pipe = -1;
  std::size_t task = 0;
  std::string answer = {};
};

[[noreturn]] void cannot_start() {
  throw base::EnvironmentError(std::string("cannot start a process: ") + std::strerror(errno));
}

/// Reads until there is nothing more for now; false at the end.
bool read_some(Child& child) {
  std::array<char, 4096> buffer{};
  const ssize_t n = ::read(child.pipe, buffer.data(), buffer.size());
  if (n < 0) return errno == EINTR || errno == EAGAIN;
  child.answer.append(buffer.data(), static_cast<std::size_t>(n));
  return n > 0;
}

[[noreturn]] void be_child(std::size_t task, int pipe, pid_t parent, const WorkerCalls& calls) {
  // Nobody waits for the answer of an orphan.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  ::signal(SIGINT, SIG_IGN);  // the parent decides
  std::string answer;
  try {
    answer = calls.work(task);
  } catch (const std::exception& error) {
    std::fputs((std::string(error.what()) + "\n").c_str(), stderr);
    ::_exit(1);
  }
  answer += '\n';
  const char* next = answer.data();
  std::size_t left = answer.size();
  while (left > 0) {
    const ssize_t n = ::write(pipe, next, left);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) ::_exit(1);
    next += n;
    left -= static_cast<std::size_t>(n);
  }
  ::_exit(0);  // destructors and buffers are the parent's
}

Child start(std::size_t task, const WorkerCalls& calls) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) cannot_start();
  std::fflush(nullptr);
  const pid_t parent = ::getpid();
  const pid_t process = ::fork();
  if (process < 0) cannot_start();
  if (process == 0) {
    ::close(ends[0]);
    be_child(task, ends[1], parent, calls);
  }
  ::close(ends[1]);
  return {.process = process, .pipe = ends[0], .task = task};
}

void finish(Child& child, const WorkerCalls& calls) {
  ::close(child.pipe);
  int status = 0;
  while (::waitpid(child.process, &status, 0) < 0 && errno == EINTR) {
  }
  const bool whole = !child.answer.empty() && child.answer.back() == '\n';
  if (whole) child.answer.pop_back();
  calls.done(child.task, whole ? child.answer : std::string(), WIFSIGNALED(status) ? WTERMSIG(status) : 0);
}

void end_all(std::vector<Child>& children) {
  for (const Child& child : children) ::kill(child.process, SIGKILL);
  for (const Child& child : children) {
    ::close(child.pipe);
    ::waitpid(child.process, nullptr, 0);
  }
  children.clear();
}

}  // namespace

bool run_in_processes(std::span<const std::size_t> tasks, int jobs, const WorkerCalls& calls) {
  constexpr int wait = 200;  // ms, after which interrupts are asked for
  std::vector<Child> children;
  std::size_t next = 0;
  try {
    while (next < tasks.size() || !children.empty()) {
      if (calls.interrupted && calls.interrupted()) {
        end_all(children);
        return false;
      }
      while (next < tasks.size() && children.size() < static_cast<std::size_t>(jobs)) {
        children.push_back(start(tasks[next++], calls));
      }
      std::vector<pollfd> pipes;
      pipes.reserve(children.size());
      for (const Child& child : children) pipes.push_back({.fd = child.pipe, .events = POLLIN, .revents = 0});
      if (::poll(pipes.data(), pipes.size(), wait) <= 0) continue;
      std::vector<Child> going;
      for (std::size_t i = 0; i < children.size(); ++i) {
        if (pipes[i].revents == 0 || read_some(children[i])) {
          going.push_back(std::move(children[i]));
        } else {
          finish(children[i], calls);
        }
      }
      children = std::move(going);
    }
  } catch (...) {
    end_all(children);
    throw;
  }
  return true;
}

}  // namespace muldi::pipeline
