/// What is prescribed on solids: displacements, potentials, loads, electrodes.
#include <cmath>
#include <map>

#include "base/error.hpp"
#include "base/text.hpp"
#include "build/build_solids.hpp"
#include "build/build_ties.hpp"
#include "build/place_bodies.hpp"
#include "fem/mesh/selection.hpp"
#include "fem/solid/face_shares.hpp"

namespace muldi::build {
namespace {

namespace dim = base::dimension;

fem::Value value_of(const SolidContext& context, const scene::Drive& drive, const base::Dimension& unit,
                    const std::string& owner) {
  const ControlValue value = context.controls.value_of(drive, unit, owner);
  return {.control = value.control, .constant = value.constant};
}

bool same(const fem::Value& a, const fem::Value& b) {
  return a.control == b.control && a.constant == b.constant && a.factor == b.factor;
}

/// Values on nodes, each given once.
class Prescriptions {
 public:
  /// False if the node has another value already.
  bool add(int node, int unknown, const fem::Value& value) {
    const auto [at, is_new] = values_.try_emplace({node, unknown}, value);
    is_new_ = is_new;
    return is_new || same(at->second, value);
  }
  bool is_new() const { return is_new_; }
  bool has(int node, int unknown) const { return values_.count({node, unknown}) > 0; }

 private:
  std::map<std::pair<int, int>, fem::Value> values_;
  bool is_new_ = false;
};

class ConditionBuilder {
 public:
  ConditionBuilder(const SolidContext& context, const scene::Entry<scene::Solid>& entry, const fem::Mesh& mesh,
                   fem::SolidDescription& data)
      : context_(context),
        mesh_(mesh),
        selection_(mesh),
        owner_("solids." + entry.name),
        data_(data),
        ties_(context.scene, context.poses, data) {}

  void add(const scene::Condition& condition) {
    if (condition.displacement) add_displacement(condition);
    if (condition.potential) {
      prescribe_potential(nodes(condition.where), value_of(context_, *condition.potential, dim::voltage, owner_),
                          condition.origin);
    }
    if (condition.traction) add_traction(condition);
    if (condition.pressure) {
      fem::Pressure load{.value = value_of(context_, *condition.pressure, dim::stress, owner_)};
      for (const fem::CellFace& face : faces(condition.where)) load.faces.push_back(face_nodes(mesh_, face));
      data_.pressures.push_back(std::move(load));
    }
    if (condition.body_force) add_body_force(condition);
    if (condition.surface_charge) add_surface_charge(condition);
  }

  /// Fixes the nodes to the body. One node says what is wrong with all.
  void tie(const scene::SolidAttachment& said) {
    const int body = body_index(context_.scene, said.body->name);
    for (const int node : nodes(said.where)) {
      const int* other = ties_.body_of(node);
      if (other != nullptr && *other == body) continue;
      const std::size_t errors = context_.errors.size();
      if (other == nullptr && body == multibody::ground) {
        for (int i = 0; i < 3; ++i) prescribe(node, i, {}, said.origin);
        if (context_.errors.size() > errors) return;
      }
      if (other == nullptr && (body == multibody::ground || !is_held(node))) {
        ties_.add(node, body);
        continue;
      }
      const std::string why =
          other == nullptr ? "its displacement is prescribed" : "it is fixed to " + ties_.name_of(*other) + " before";
      context_.errors.push_back(scene::error_at(
          said.origin, node_name(mesh_, node) + " cannot be fixed to " + ties_.name_of(body) + ": " + why));
      return;
    }
  }
  const std::vector<TiedNodes>& ties() const { return ties_.groups(); }

  void add(const std::string& name, const scene::Electrode& electrode) {
    if (electrode.alternate) {
      add_stack(name, electrode);
      return;
    }
    const std::vector<int> where = nodes(*electrode.where);
    if (electrode.charge) {
      data_.floating.push_back({name, where, value_of(context_, *electrode.charge, dim::charge, owner_)});
    } else {
      prescribe_potential(where, value_of(context_, *electrode.potential, dim::voltage, owner_), electrode.origin);
      data_.electrodes.push_back({name, where});
    }
  }

  /// Electrodes must not share nodes: they would be one.
  void check_floating(const scene::Entry<scene::Solid>& entry) {
    std::map<int, std::string> owner_of_node;
    for (const fem::FloatingElectrode& electrode : data_.floating) {
      for (const int node : electrode.nodes) {
        const auto [at, is_new] = owner_of_node.try_emplace(node, electrode.name);
        const bool driven = !prescribed_.add(node, 3, {.control = -2}) || !prescribed_.is_new();
        if (is_new && !driven) continue;
        const auto* said = entry.value.electrodes.find(electrode.name);
        const fem::Vec3& X = mesh_.nodes[static_cast<std::size_t>(node)];
        context_.errors.push_back(scene::error_at(
            said != nullptr ? said->value.origin : entry.origin,
            base::format(
                "floating electrode '{}' has {} at [{:.6g}, {:.6g}, {:.6g}] in common with {}: what floats has "
                "one unknown potential; select nodes that nothing else holds",
                electrode.name, node_name(mesh_, node), X[0], X[1], X[2],
                is_new ? "a condition or an electrode of given potential" : "electrode '" + at->second + "'")));
        return;
      }
    }
  }

 private:
  bool is_held(int node) const {
    return prescribed_.has(node, 0) || prescribed_.has(node, 1) || prescribed_.has(node, 2);
  }
  fem::Selected found(fem::Selected selected, const scene::Where& where) {
    if (!selected.error.empty()) context_.errors.push_back(scene::error_at(where.origin, selected.error));
    return selected;
  }
  std::vector<int> nodes(const scene::Where& where) { return found(selection_.nodes(where.selector), where).nodes; }
  std::vector<fem::CellFace> faces(const scene::Where& where) {
    return found(selection_.faces(where.selector), where).faces;
  }

  void prescribe(int node, int unknown, const fem::Value& value, const scene::Origin& origin) {
    if (!prescribed_.add(node, unknown, value)) {
      static const char* const names[] = {"x displacement", "y displacement", "z displacement", "potential"};
      context_.errors.push_back(scene::error_at(origin, "the " + std::string(names[unknown]) + " of " +
                                                            node_name(mesh_, node) +
                                                            " is prescribed before with another value"));
      return;
    }
    if (!prescribed_.is_new()) return;
    if (unknown < 3) {
      data_.displacements.push_back({node, unknown, value});
    } else {
      data_.potentials.push_back({node, value});
    }
  }

  void prescribe_potential(const std::vector<int>& where, const fem::Value& value, const scene::Origin& origin) {
    const std::size_t errors = context_.errors.size();
    for (const int node : where) {
      prescribe(node, 3, value, origin);
      if (context_.errors.size() > errors) return;  // one node says it all
    }
  }

  void add_displacement(const scene::Condition& condition) {
    const std::vector<int> where = nodes(condition.where);
    for (int i = 0; i < 3; ++i) {
      const auto& said = (*condition.displacement)[static_cast<std::size_t>(i)];
      if (!said) continue;
      const fem::Value value = value_of(context_, *said, dim::length, owner_);
      const std::size_t errors = context_.errors.size();
      for (const int node : where) {
        prescribe(node, i, value, condition.origin);
        if (context_.errors.size() > errors) break;
      }
    }
  }

  /// One load for each component that is given, from the shares of the nodes in area or volume.
  void add_dead_loads(const std::map<int, double>& shares, const std::array<scene::Drive, 3>& said,
                      const base::Dimension& unit) {
    for (int i = 0; i < 3; ++i) {
      fem::DeadLoad load{.value = value_of(context_, said[static_cast<std::size_t>(i)], unit, owner_)};
      if (load.value.is_zero()) continue;
      for (const auto& [node, share] : shares) {
        load.nodes.push_back(node);
        load.unit.push_back(share * Eigen::Vector3d::Unit(i));
      }
      data_.dead_loads.push_back(std::move(load));
    }
  }

  std::map<int, double> area_shares(const scene::Where& where) {
    std::map<int, double> shares;
    for (const fem::CellFace& face : faces(where)) {
      const std::array<int, 4> corners = face_nodes(mesh_, face);
      const std::array<double, 4> share = fem::area_shares(corners, data_.X);
      for (std::size_t a = 0; a < 4; ++a) shares[corners[a]] += share[a];
    }
    return shares;
  }

  void add_traction(const scene::Condition& condition) {
    add_dead_loads(area_shares(condition.where), *condition.traction, dim::stress);
  }

  void add_body_force(const scene::Condition& condition) {
    std::map<int, double> shares;
    for (const int cell : found(selection_.cells(condition.where.selector), condition.where).cells) {
      const auto& corners = mesh_.cells[static_cast<std::size_t>(cell)];
      const std::array<double, 8> share = fem::volume_shares(corners, data_.X);
      for (std::size_t a = 0; a < 8; ++a) shares[corners[a]] += share[a];
    }
    add_dead_loads(shares, *condition.body_force, dim::force / dim::volume);
  }

  void add_surface_charge(const scene::Condition& condition) {
    fem::SurfaceCharge load{.value = value_of(context_, *condition.surface_charge, dim::charge / dim::area, owner_)};
    for (const auto& [node, share] : area_shares(condition.where)) {
      load.nodes.push_back(node);
      load.unit.push_back(share);
    }
    data_.surface_charges.push_back(std::move(load));
  }

  void add_stack(const std::string& name, const scene::Electrode& electrode) {
    std::vector<fem::Value> values;
    for (const scene::Drive& drive : electrode.potentials) {
      values.push_back(value_of(context_, drive, dim::voltage, owner_));
    }
    std::vector<fem::Electrode> together(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) together[i].name = name + "_" + std::to_string(i);
    std::size_t next = 0;
    for (const auto& [first, last] : layers_of(electrode)) {
      std::vector<int> layer;
      for (int node = 0; node < mesh_.n_nodes(); ++node) {
        const int at = mesh_.layer_of_node[static_cast<std::size_t>(node)];
        if (at >= first && at <= last) layer.push_back(node);
      }
      const std::size_t turn = next++ % values.size();
      prescribe_potential(layer, values[turn], electrode.origin);
      together[turn].nodes.insert(together[turn].nodes.end(), layer.begin(), layer.end());
    }
    for (fem::Electrode& one : together) {
      if (!one.nodes.empty()) data_.electrodes.push_back(std::move(one));
    }
  }

  /// Ranges of node layers that are electrodes.
  std::vector<std::pair<int, int>> layers_of(const scene::Electrode& electrode) {
    std::vector<std::pair<int, int>> ranges;
    if (mesh_.layer_of_node.empty()) {
      context_.errors.push_back(
          scene::error_at(electrode.origin, "`alternate` needs a mesh with layers: a cylinder or a stack"));
    } else if (*electrode.alternate == scene::Alternate::layers) {
      for (int layer = 0; layer < mesh_.n_layers(); ++layer) ranges.emplace_back(layer, layer);
    } else {
      const int part = mesh_.find_part(electrode.part);
      for (const fem::Slab& slab : mesh_.slabs) {
        if (slab.part == part) ranges.emplace_back(slab.first, slab.last);
      }
      if (ranges.empty()) {
        context_.errors.push_back(
            scene::error_at(electrode.origin, "the mesh has no layers of part '" + electrode.part + "'" +
                                                  base::did_you_mean(electrode.part, mesh_.parts)));
      }
    }
    return ranges;
  }

  const SolidContext& context_;
  const fem::Mesh& mesh_;
  fem::MeshSelection selection_;
  std::string owner_;
  fem::SolidDescription& data_;
  TieBuilder ties_;
  Prescriptions prescribed_;
};

}  // namespace

std::vector<TiedNodes> add_conditions(const SolidContext& context, const scene::Entry<scene::Solid>& entry,
                                      const fem::Mesh& mesh, fem::SolidDescription& data) {
  ConditionBuilder builder(context, entry, mesh, data);
  for (const scene::Condition& condition : entry.value.conditions) builder.add(condition);
  for (const scene::SolidAttachment& said : entry.value.attach) {
    if (said.body) builder.tie(said);
  }
  for (const auto& electrode : entry.value.electrodes) builder.add(electrode.name, electrode.value);
  builder.check_floating(entry);
  return builder.ties();
}

}  // namespace muldi::build
