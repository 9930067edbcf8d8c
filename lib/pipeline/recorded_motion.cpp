#include "pipeline/recorded_motion.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"
#include "multibody/joint.hpp"
#include "pipeline/optimal_problem.hpp"
#include "pipeline/provenance.hpp"
#include "results/result_file.hpp"

namespace muldi::pipeline {
namespace {

/// The rows of a data set, each of `n_columns` numbers.
class Rows {
 public:
  Rows(const results::ResultFile& file, const std::string& path, std::size_t n_columns) : n_columns_(n_columns) {
    if (!file.contains(path)) {
      throw base::InputError(
          base::format("'{}' is of another system or records less: it has no {}", file.path(), path));
    }
    array_ = file.read(path);
    std::size_t n = 1;
    for (std::size_t k = 1; k < array_.shape.size(); ++k) n *= array_.shape[k];
    if (array_.shape.empty() || n != n_columns) {
      throw base::InputError(base::format("'{}' is of another system: {} has other columns", file.path(), path));
    }
  }

  std::size_t size() const { return array_.shape[0]; }
  const double* operator[](std::size_t row) const { return array_.values.data() + row * n_columns_; }
  std::vector<double> row(std::size_t i) const { return {(*this)[i], (*this)[i] + n_columns_}; }

 private:
  std::size_t n_columns_;
  results::Array array_;
};

std::vector<Eigen::VectorXd> vectors_of(const Rows& rows, int n) {
  std::vector<Eigen::VectorXd> vectors;
  vectors.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) vectors.emplace_back(Eigen::Map<const Eigen::VectorXd>(rows[i], n));
  return vectors;
}

control::Trajectory optimum_in(const results::ResultFile& file, const control::Problem& problem) {
  const std::string folder = "optimum/trajectory/";
  control::Trajectory found;
  found.step = file.read(folder + "step").values.at(0);
  const model::Manifold& manifold = *problem.model.manifold;
  found.x = vectors_of(Rows(file, folder + "coordinates", static_cast<std::size_t>(manifold.n_x())), manifold.n_x());
  if (problem.model.controls.empty()) {
    found.u.resize(found.x.size() - 1);
  } else {
    const Rows controls(file, folder + "controls", problem.model.controls.size());
    found.u.reserve(controls.size());
    for (std::size_t i = 0; i < controls.size(); ++i) found.u.push_back(controls.row(i));
  }
  if (found.x.size() != found.u.size() + 1) {
    throw base::InputError(base::format("'{}' holds an incomplete optimum", file.path()));
  }
  if (file.contains(folder + "multipliers")) {
    const int n = manifold.n_loop_rows();
    found.multipliers = vectors_of(Rows(file, folder + "multipliers", static_cast<std::size_t>(n)), n);
  }
  return found;
}

/// What `run` records of poses: coordinates of the joints, of bodies without a joint their pose, and free lengths.
class RunMotion {
 public:
  RunMotion(const scene::Scene& scene, const build::BuiltModel& built, const results::ResultFile& file)
      : manifold_(*built.manifold), tree_(manifold_.tree()), times_(file, "time", 1) {
    for (const multibody::TreeLink& link : tree_.links) {
      const multibody::Joint& joint = tree_.joint(link);
      if (link.joint < tree_.n_user_joints()) {
        const auto n = static_cast<std::size_t>(joint.pattern.n_rates());
        links_.push_back({.position = n > 0 ? Rows(file, "joints/" + joint.name + "/coordinate", n) : times_});
      } else {
        const std::string body = "bodies/" + scene.bodies[static_cast<std::size_t>(link.body)].name + "/";
        links_.push_back(
            {.position = Rows(file, body + "position", 3), .orientation = Rows(file, body + "orientation", 9)});
      }
    }
    for (const auto& entry : scene.muscles) {
      if (entry.value.ends != scene::MuscleEnds::free) continue;
      lengths_.emplace_back(file, "muscles/" + entry.name + "/length", 1);
    }
    if (times_.size() == 0) throw base::InputError(base::format("'{}' holds no motion to start from", file.path()));
  }

  double duration() const { return time(times_.size() - 1); }

  /// Row whose time is the last that is not after t, and the part of the way to the next.
  std::pair<std::size_t, double> place(double t) const {
    std::size_t row = 0;
    while (row + 1 < times_.size() && time(row + 1) <= t) ++row;
    if (row + 1 == times_.size()) return {row, 0.0};
    return {row, std::clamp((t - time(row)) / (time(row + 1) - time(row)), 0.0, 1.0)};
  }

  Eigen::VectorXd pose_at(double t) const {
    const auto [row, part] = place(t);
    Eigen::VectorXd x = pose(row);
    if (part == 0.0) return x;
    Eigen::VectorXd increment(manifold_.n_v());
    manifold_.difference(x, pose(row + 1), increment);
    manifold_.retract(x, part * increment, x);
    return x;
  }

 private:
  struct Recorded {
    Rows position;
    std::optional<Rows> orientation = {};
  };

  double time(std::size_t row) const { return times_[row][0] - times_[0][0]; }

  Eigen::VectorXd pose(std::size_t row) const {
    Eigen::VectorXd x = manifold_.reference();
    for (std::size_t l = 0; l < links_.size(); ++l) {
      const multibody::TreeLink& link = tree_.links[l];
      const multibody::Joint& joint = tree_.joint(link);
      double* const coordinates = x.data() + link.first_coordinate;
      if (!links_[l].orientation) {
        multibody::stored_coordinates(joint, links_[l].position[row], coordinates);
        continue;
      }
      const multibody::Pose body{
          .position = Eigen::Map<const Eigen::Vector3d>(links_[l].position[row]),
          .orientation = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>((*links_[l].orientation)[row])};
      const std::vector<double> near(coordinates, coordinates + joint.pattern.n_coordinates());
      multibody::coordinates_of(joint, multibody::measure(joint, {}, body), near.data(), coordinates);
    }
    for (std::size_t k = 0; k < lengths_.size(); ++k) {
      x[tree_.n_coordinates + static_cast<Eigen::Index>(k)] = lengths_[k][row][0];
    }
    return x;
  }

  const multibody::TreeManifold& manifold_;
  const multibody::KinematicTree& tree_;
  Rows times_;
  std::vector<Recorded> links_;
  std::vector<Rows> lengths_;
};

control::Trajectory run_in(const results::ResultFile& file, const scene::Scene& scene, const build::BuiltModel& built,
                           const control::Problem& problem) {
  const RunMotion motion(scene, built, file);
  const auto n = static_cast<std::size_t>(problem.horizon.n_steps);
  const double natural = motion.duration() / static_cast<double>(n);
  control::Trajectory found{.step = std::clamp(natural, problem.horizon.shortest_step, problem.horizon.longest_step)};
  found.x.reserve(n + 1);
  for (std::size_t i = 0; i <= n; ++i) found.x.push_back(motion.pose_at(static_cast<double>(i) * found.step));
  found.u = scheduled_controls(problem, found.step);
  for (std::size_t c = 0; c < built.n_named_controls; ++c) {
    const Rows values(file, "controls/" + problem.model.controls[c].name, 1);
    for (std::size_t i = 0; i < n; ++i) {
      // The value of a row is that of the interval which ends there.
      const auto [row, part] = motion.place((static_cast<double>(i) + 0.5) * found.step);
      found.u[i][c] = values[std::min(part > 0.0 ? row + 1 : row, values.size() - 1)][0];
    }
  }
  return found;
}

}  // namespace

control::Trajectory recorded_motion(const scene::Scene& scene, const build::BuiltModel& built,
                                    const control::Problem& problem, const std::string& path) {
  const results::ResultFile file(path);
  if (const std::string units = file.text("units"); units != units_text(scene)) {
    throw base::InputError(
        base::format("'{}' is in other units ({}) than the scene ({})", file.path(), units, units_text(scene)));
  }
  if (file.contains("optimum/trajectory/coordinates")) return optimum_in(file, problem);
  if (file.contains("time")) return run_in(file, scene, built, problem);
  throw base::InputError(base::format("'{}' holds no motion to start from", file.path()));
}

}  // namespace muldi::pipeline
