#pragma once
/// The visitor of describe() that reads a map: finds the fields, reports missing and unknown keys.
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/describe.hpp"
#include "scene/joints.hpp"
#include "scene/read_context.hpp"

namespace muldi::scene {

class FieldReader {
 public:
  FieldReader(ReadContext& context, const Node& map);

  /// Each call reads one field; the templates are in read_values.hpp.
  template <class T>
  void operator()(const base::Field& field, T& value);
  template <class T>
  void operator()(const CoordinateField& field, T& values);
  template <class... Components>
  void operator()(const base::Choice& choice, std::variant<Components...>& value);

  /// Reports unknown and missing keys; call it after the visit.
  void finish();

 private:
  template <class Component, class Variant>
  void visit_component(std::size_t i, std::optional<std::size_t> chosen, Variant& value);
  /// The value of a key, which counts as known from now on; notes a required key that is missing.
  const Node* take(std::string_view key, bool required);

  ReadContext& context_;
  const Node& map_;
  std::vector<bool> taken_;           // of the entries of map_
  std::vector<std::string> known_;    // keys that may stand here
  std::vector<std::string> missing_;  // required keys that do not stand here
  std::vector<std::string> others_;   // keys of components that were not chosen
  std::string component_;             // `type revolute`
  bool reading_ = true;               // false: keys only become known
  bool foreign_ = false;              // keys belong to a component that was not chosen
};

}  // namespace muldi::scene
