#pragma once
/// The `sweep` pipeline: a scene at many points, each in a process of its own, into one table.
#include <functional>
#include <optional>
#include <string>

#include "results/layout.hpp"
#include "scene/scene.hpp"
#include "scene/study.hpp"

namespace muldi::pipeline {

struct SweepSetup {
  std::string table = {};  ///< the .h5; the .csv and the journals stand beside it
  int jobs = 1;
  int shard = 1;  ///< which part of the points, from 1
  int n_shards = 1;
  bool merge_only = false;  ///< runs nothing, makes the table of what all journals have
  bool force = false;       ///< begins anew
  /// The record that `initial.from` of a scene names, if it names one.
  std::function<std::optional<results::Checkpoint>(const scene::Scene&)> earlier = {};
  std::function<bool()> interrupted = {};
  std::function<void(std::size_t done, std::size_t all)> progress = {};
  /// A point that failed: its overrides, status and sentence.
  std::function<void(std::size_t point, const std::string& overrides, const std::string& why)> failed = {};
};

struct SweepEnd {
  std::size_t n_points = 0;
  std::size_t n_run = 0;      ///< now
  std::size_t n_failed = 0;   ///< of all that are finished
  std::size_t n_missing = 0;  ///< of other shards, or not run yet
  std::size_t n_killed = 0;   ///< now, from outside: not finished
  bool interrupted = false;
  bool written = false;  ///< the table: once every point is finished, or on `merge_only`
};

/// Runs the points of the shard that no journal has. A point that crashes has the status `crashed`; one that is killed
/// from outside (memory, the end of a cluster's job) is not finished and is tried again the next time. The table has
/// the same bytes however often the sweep was broken off, whatever the number of jobs and shards. InputError with all
/// that is wrong with the study before anything runs; EnvironmentError if the results cannot be written.
SweepEnd sweep(const scene::SweepStudy& study, const scene::SceneText& scene, const SweepSetup& setup);

}  // namespace muldi::pipeline
