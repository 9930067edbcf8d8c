#pragma once
/// What the parts of check_scene share.
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "scene/node.hpp"
#include "scene/read_context.hpp"
#include "scene/scene.hpp"

namespace muldi::scene {

/// One look at one scene; `failed` entries have been reported by the reader and are passed over.
class SceneCheck {
 public:
  SceneCheck(Scene& scene, const Node& root, ReadContext& context) : scene_(scene), root_(root), context_(context) {}

  void references();
  void points();
  void bodies();  // check_bodies.cpp, as materials
  void materials();
  void joints();
  void muscles();  // check_elements.cpp, as the following
  void springs();
  void loads();
  void initial();
  void tasks();
  void unused_controls();

 private:
  friend class SolidCheck;
  friend class OptimalControlCheck;
  using Keys = std::initializer_list<std::string_view>;

  /// An error or warning about the entry under these keys, or the deepest that exists.
  void error(Keys keys, std::string message);
  Origin origin_of(Keys keys) const;
  bool failed(Keys keys) const;
  bool exists(Keys keys) const { return find(keys) != nullptr; }
  const Node* find(Keys keys) const;

  void check_body(const Entry<Body>& body);
  void check_muscle_ends(const Entry<Muscle>& muscle);
  /// The options of its model, which are given the defaults if the scene says nothing.
  template <class Model>
  void check_muscle_model(Entry<Muscle>& muscle);
  void check_meshed_muscle(const Entry<Muscle>& muscle, const MeshedMuscle& mesh, const Elastic& elastic);
  template <class Model>
  void check_muscle_control(const Entry<Muscle>& muscle, const Model& model);
  void check_load(const Entry<Load>& load);
  /// That the scene holds nothing that the explicit integrator cannot move.
  void check_explicit();
  /// Both ends of an element that acts between two points.
  void check_two_ends(std::string_view section, std::string_view name, const Attachment& from, const Attachment& to);
  /// That a control, if it exists, is of one of these quantities.
  void check_quantity(const ControlName& control, const std::vector<ControlQuantity>& quantities);
  void resolve(std::string_view body, BodyPoint& point);
  void check_direction(Keys keys, const Vec3& direction);

  Scene& scene_;
  const Node& root_;
  ReadContext& context_;
};

}  // namespace muldi::scene
