#pragma once
/// What the fields of `optimal_control:` say together, and with the rest of the scene.
#include <string>
#include <string_view>

#include "scene/scene_check.hpp"

namespace muldi::scene {

/// One look at the optimal control problem of a scene that has one.
class OptimalControlCheck {
 public:
  OptimalControlCheck(Scene& scene, SceneCheck& check, ReadContext& context)
      : scene_(scene), problem_(*scene.optimal_control), check_(check), context_(context) {}

  void all();

 private:
  using Keys = SceneCheck::Keys;

  void parts();
  void horizon();
  void controls();
  void end(std::string_view which, EndCondition& end);
  void poses(std::string_view which, const EndCondition& end);
  void equilibrium();
  void limits();
  void guess();
  void stages();
  void stage(const Stage& stage);
  void replay();
  /// That every control which is sought has an entry.
  void need_all_controls(std::string_view section, const Origin& at, const std::vector<std::string>& given);

  template <class T>
  void resolve(ByPoint<T>& points);
  void against_limits(std::string_view which, const Pose& pose);
  bool has_driven_muscle() const;
  /// Errors in the field of this name below `optimal_control`, unless the reader has reported something there.
  void error(Keys keys, std::string message);
  bool failed(const std::string& below) const;

  Scene& scene_;
  OptimalControl& problem_;
  SceneCheck& check_;
  ReadContext& context_;
};

}  // namespace muldi::scene
