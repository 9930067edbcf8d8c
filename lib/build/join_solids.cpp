#include "build/join_solids.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/text.hpp"
#include "build/bond_builder.hpp"
#include "fem/mesh/selection.hpp"
#include "fem/solid/face_projection.hpp"
#include "fem/solid/mortar.hpp"
#include "fem/solid/solid_unknowns.hpp"

namespace muldi::build {
namespace {

/// Gap of a joint that is closed, relative to the size of the attached solid.
constexpr double closing_gap = 1e-6;

double diagonal(const Eigen::VectorXd& X) {
  const Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic>> nodes(X.data(), 3, X.size() / 3);
  return (nodes.rowwise().maxCoeff() - nodes.rowwise().minCoeff()).norm();
}

int index_of(const std::vector<SolidPart>& parts, const std::string& name) {
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const auto& one) { return one.entry->name == name; });
  return found == parts.end() ? -1 : static_cast<int>(found - parts.begin());
}

/// By solid: the first of those that it is connected with.
std::vector<std::size_t> groups_of(const std::vector<SolidPart>& parts) {
  std::vector<std::size_t> group(parts.size());
  for (std::size_t k = 0; k < parts.size(); ++k) group[k] = k;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    for (const scene::SolidAttachment& said : parts[k].entry->value.attach) {
      const int other = said.solid ? index_of(parts, said.solid->name) : -1;
      if (other < 0) continue;
      const std::size_t low = std::min(group[k], group[static_cast<std::size_t>(other)]);
      const std::size_t high = std::max(group[k], group[static_cast<std::size_t>(other)]);
      std::replace(group.begin(), group.end(), high, low);
    }
  }
  return group;
}

void shift(std::vector<int>& nodes, int by) {
  for (int& node : nodes) node += by;
}

/// Adds a solid to those that are there, with its nodes, cells and materials behind theirs.
class Merger {
 public:
  explicit Merger(fem::SolidDescription& to) : to_(to) {}

  fem::Member add(fem::SolidDescription from) {
    const fem::Member member{.name = from.name,
                             .first_node = static_cast<int>(to_.X.size() / 3),
                             .n_nodes = static_cast<int>(from.X.size() / 3),
                             .first_cell = static_cast<int>(to_.cells.size()),
                             .n_cells = static_cast<int>(from.cells.size()),
                             .first_material = static_cast<int>(to_.materials.size()),
                             .n_materials = static_cast<int>(from.materials.size())};
    first_ = member.first_node;
    index_ = static_cast<int>(to_.members.size());
    to_.members.push_back(member);
    to_.name += (to_.name.empty() ? "" : " + ") + from.name;
    add_mesh(from, member);
    add_given(from);
    add_loads(from);
    return member;
  }

 private:
  void add_mesh(fem::SolidDescription& from, const fem::Member& member) {
    Eigen::VectorXd X(to_.X.size() + from.X.size());
    X << to_.X, from.X;
    to_.X = std::move(X);
    for (auto& cell : from.cells) {
      for (int& node : cell) node += first_;
    }
    for (int& material : from.material_of_cell) material += member.first_material;
    append(from.cells, to_.cells);
    append(from.material_of_cell, to_.material_of_cell);
    append(from.materials, to_.materials);
    append(from.shear_moduli, to_.shear_moduli);
    number(from.labels_of_nodes, member.n_nodes);
    number(from.labels_of_cells, member.n_cells);
    append(from.labels_of_nodes, to_.labels_of_nodes);
    append(from.labels_of_cells, to_.labels_of_cells);
  }

  void add_given(fem::SolidDescription& from) {
    for (fem::PrescribedDisplacement& said : from.displacements) said.node += first_;
    for (fem::PrescribedPotential& said : from.potentials) said.node += first_;
    for (fem::Tie& tie : from.ties) {
      tie.node += first_;
      tie.host = host(from.hosts[static_cast<std::size_t>(tie.host)]);
    }
    append(from.displacements, to_.displacements);
    append(from.potentials, to_.potentials);
    append(from.ties, to_.ties);
    to_.tied_to_ground |= from.tied_to_ground;
    to_.formulation = from.formulation;
    to_.gravity = from.gravity;
  }

  void add_loads(fem::SolidDescription& from) {
    for (fem::FloatingElectrode& one : from.floating) own(one);
    for (fem::Electrode& one : from.electrodes) own(one);
    for (fem::SurfaceCharge& one : from.surface_charges) own(one);
    for (fem::DeadLoad& one : from.dead_loads) shift(one.nodes, first_);
    for (fem::Pressure& one : from.pressures) {
      for (auto& face : one.faces) {
        for (int& node : face) node += first_;
      }
    }
    append(from.floating, to_.floating);
    append(from.electrodes, to_.electrodes);
    append(from.surface_charges, to_.surface_charges);
    append(from.dead_loads, to_.dead_loads);
    append(from.pressures, to_.pressures);
  }

  template <class OfMember>
  void own(OfMember& one) const {
    shift(one.nodes, first_);
    one.member = index_;
  }

  template <class T>
  static void append(std::vector<T>& from, std::vector<T>& to) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  }

  static void number(std::vector<long>& labels, int n) {
    for (long k = static_cast<long>(labels.size()); k < n; ++k) labels.push_back(k);
  }

  int host(const fem::Host& wanted) {
    for (std::size_t k = 0; k < to_.hosts.size(); ++k) {
      if (to_.hosts[k].pattern_node == wanted.pattern_node) return static_cast<int>(k);
    }
    to_.hosts.push_back(wanted);
    return static_cast<int>(to_.hosts.size()) - 1;
  }

  fem::SolidDescription& to_;
  int first_ = 0;
  int index_ = 0;
};

/// Where the nodes of attachments lie on the faces of the others.
class Joiner {
 public:
  Joiner(const std::vector<const SolidPart*>& parts, JoinedSolid& joined, std::vector<base::Diagnostic>& errors)
      : parts_(parts), joined_(joined), errors_(errors), bonds_(joined.data, meshes_of(parts), errors) {}

  void join() {
    const std::size_t before = errors_.size();
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      for (const scene::SolidAttachment& said : parts_[k]->entry->value.attach) {
        if (said.solid) attach(k, said);
      }
    }
    if (errors_.size() == before) bonds_.finish();
    if (errors_.size() == before) check_fields();
  }

 private:
  static std::vector<const fem::Mesh*> meshes_of(const std::vector<const SolidPart*>& parts) {
    std::vector<const fem::Mesh*> meshes;
    meshes.reserve(parts.size());
    for (const SolidPart* part : parts) meshes.push_back(part->mesh);
    return meshes;
  }

  Eigen::Vector3d at(int node) const { return joined_.data.X.segment<3>(3 * static_cast<Eigen::Index>(node)); }

  void attach(std::size_t k, const scene::SolidAttachment& said) {
    std::size_t other = 0;
    while (parts_[other]->entry->name != said.solid->name) ++other;
    const fem::Selected nodes = fem::MeshSelection(*parts_[k]->mesh).nodes(said.where.selector);
    const fem::Selected faces = fem::MeshSelection(*parts_[other]->mesh).faces(said.where_other->selector);
    if (!nodes.error.empty()) errors_.push_back(scene::error_at(said.where.origin, nodes.error));
    if (!faces.error.empty()) errors_.push_back(scene::error_at(said.where_other->origin, faces.error));
    if (!nodes.error.empty() || !faces.error.empty()) return;
    corners_ = face_nodes(other, faces.faces);
    tolerance_ = closing_gap * diagonal(parts_[k]->data.X);
    JoinedNodes joint{.name = parts_[k]->entry->name, .other = parts_[other]->entry->name};
    widest_ = {};
    held_.clear();
    const std::set<int> follow = bind_by_mortar(k, said);
    for (const int node : nodes.nodes) {
      joint.nodes.push_back(joined_.data.members[k].first_node + node);
      if (follow.count(joint.nodes.back()) == 0) place(joint.nodes.back(), said.origin);
    }
    joined_.joints.push_back(std::move(joint));
    if (widest_.gap > tolerance_) return report(k, other, said.origin);
    note_loose_nodes(k, other, said);
  }

  /// Faces of a member, with nodes of the whole.
  std::vector<fem::FaceNodes> face_nodes(std::size_t member, const std::vector<fem::CellFace>& faces) const {
    std::vector<fem::FaceNodes> found;
    found.reserve(faces.size());
    for (const fem::CellFace& face : faces) {
      found.push_back(fem::face_nodes(*parts_[member]->mesh, face));
      for (int& node : found.back()) node += joined_.data.members[member].first_node;
    }
    return found;
  }

  /// Where neither mesh refines the other; the nodes that need no place then. What is prescribed on one of them and not
  /// on all that it would follow can only hold where it lies.
  std::set<int> bind_by_mortar(std::size_t k, const scene::SolidAttachment& said) {
    const fem::Selected faces = fem::MeshSelection(*parts_[k]->mesh).faces(said.where.selector);
    if (!faces.error.empty()) return {};
    const std::vector<fem::FaceNodes> own = face_nodes(k, faces.faces);
    std::set<int> placed;
    std::vector<fem::NodeSum> sums;
    for (bool all_agree = false; !all_agree;) {
      all_agree = true;
      sums = fem::mortar_sums(joined_.data.X, own, corners_, tolerance_, placed);
      for (const fem::NodeSum& sum : sums) {
        if (bonds_.agree(sum.node, sum.to, sum.weights)) continue;
        placed.insert(sum.node);
        all_agree = false;
      }
    }
    std::set<int> follow;
    for (fem::NodeSum& sum : sums) {
      follow.insert(sum.node);
      for (std::size_t i = 0; i < sum.to.size(); ++i) {
        if (std::abs(sum.weights[i]) > BondBuilder::no_weight) held_.push_back(sum.to[i]);
      }
      bonds_.fix(sum.node, std::move(sum.to), std::move(sum.weights), said.origin);
    }
    return follow;
  }

  /// Nodes of the other solid inside the joint that no node holds can leave it.
  void note_loose_nodes(std::size_t k, std::size_t other, const scene::SolidAttachment& said) {
    const fem::Selected faces = fem::MeshSelection(*parts_[k]->mesh).faces(said.where.selector);
    if (!faces.error.empty()) return;
    std::set<int> loose;
    for (const auto& corners : corners_) loose.insert(corners.begin(), corners.end());
    for (const int node : held_) loose.erase(node);
    std::size_t n_loose = 0;
    for (const int node : loose) {
      const Eigen::Vector3d X = at(node);
      n_loose += std::any_of(faces.faces.begin(), faces.faces.end(), [&](const fem::CellFace& face) {
        Eigen::Matrix<double, 3, 4> positions;
        Eigen::Index a = 0;
        for (const int corner : fem::face_nodes(*parts_[k]->mesh, face)) {
          positions.col(a++) = at(joined_.data.members[k].first_node + corner);
        }
        const Eigen::Vector3d centre = positions.rowwise().mean();
        if ((X - centre).norm() > tolerance_ + (positions.colwise() - centre).colwise().norm().maxCoeff()) return false;
        return fem::project_on_face(X, positions).distance <= tolerance_;
      });
    }
    if (n_loose == 0) return;
    const std::string& name = parts_[k]->entry->name;
    const std::string& of = parts_[other]->entry->name;
    joined_.notes.push_back(scene::warning_at(
        said.origin,
        base::format("{} nodes of '{}' lie in the joint between those of '{}' and are held by none: it can "
                     "open there; attach the solid with the finer mesh to that with the coarser one",
                     n_loose, of, name)));
  }

  /// A node is one with a corner that it meets, or fixed to the nearest face.
  void place(int node, const scene::Origin& origin) {
    const Eigen::Vector3d X = at(node);
    fem::FaceProjection nearest{.weights = {}, .distance = std::numeric_limits<double>::infinity()};
    const std::array<int, 4>* face = nullptr;
    for (const auto& corners : corners_) {
      Eigen::Matrix<double, 3, 4> positions;
      for (int a = 0; a < 4; ++a) positions.col(a) = at(corners[static_cast<std::size_t>(a)]);
      for (std::size_t a = 0; a < 4; ++a) {
        if ((positions.col(static_cast<Eigen::Index>(a)) - X).norm() > tolerance_) continue;
        held_.push_back(corners[a]);
        return bonds_.unite(node, corners[a], origin);
      }
      const Eigen::Vector3d centre = positions.rowwise().mean();
      const double reach = (positions.colwise() - centre).colwise().norm().maxCoeff();
      if ((X - centre).norm() - reach > nearest.distance) continue;
      const fem::FaceProjection found = fem::project_on_face(X, positions);
      if (found.distance >= nearest.distance) continue;
      nearest = found;
      face = &corners;
    }
    if (nearest.distance > widest_.gap) widest_ = {node, nearest.distance};
    if (nearest.distance > tolerance_) return;
    for (std::size_t a = 0; a < 4; ++a) {
      if (nearest.weights[a] > BondBuilder::no_weight) held_.push_back((*face)[a]);
    }
    bonds_.fix(node, {face->begin(), face->end()}, {nearest.weights.begin(), nearest.weights.end()}, origin);
  }

  void report(std::size_t k, std::size_t other, const scene::Origin& origin) {
    const int node = widest_.node - joined_.data.members[k].first_node;
    const Eigen::Vector3d X = at(widest_.node);
    errors_.push_back(scene::error_at(
        origin, base::format("{} at [{:.6g}, {:.6g}, {:.6g}] is not on the faces of '{}' that where_other selects: the "
                             "gap is {:.4g}, more than {:.2g} (1e-6 of the size of '{}'); move the solids together, or "
                             "select other nodes or faces",
                             fem::node_name(*parts_[k]->mesh, node), X[0], X[1], X[2], parts_[other]->entry->name,
                             widest_.gap, tolerance_, parts_[k]->entry->name)));
  }

  /// Charges need a potential somewhere in what is electrically connected with them.
  void check_fields() {
    const fem::SolidDescription& data = joined_.data;
    if (data.potentials.empty() && data.floating.empty() && data.surface_charges.empty()) return;
    const std::vector<int> field = fem::connected_fields(data);
    std::vector<char> fixed(field.size(), 0);
    for (const fem::PrescribedPotential& said : data.potentials) {
      fixed[static_cast<std::size_t>(field[static_cast<std::size_t>(said.node)])] = 1;
    }
    const auto check = [&](const auto& charged) {
      for (const auto& one : charged) {
        const int node = one.nodes.front();
        if (fixed[static_cast<std::size_t>(field[static_cast<std::size_t>(node)])] != 0) continue;
        errors_.push_back(scene::error_at(
            parts_[static_cast<std::size_t>(one.member)]->entry->origin,
            "its potential is nowhere fixed: give a condition or an electrode a `potential`, here or on a dielectric "
            "that it is attached to"));
        return;
      }
    };
    check(data.floating);
    check(data.surface_charges);
  }

  struct Widest {
    int node = 0;
    double gap = 0.0;
  };

  const std::vector<const SolidPart*>& parts_;
  JoinedSolid& joined_;
  std::vector<base::Diagnostic>& errors_;
  BondBuilder bonds_;
  std::vector<fem::FaceNodes> corners_;  // of the faces of the other solid
  std::vector<int> held_;                // of these, by nodes of the attachment
  double tolerance_ = 0.0;
  Widest widest_;
};

bool keeps_volume_exactly(fem::Formulation formulation) {
  return formulation == fem::Formulation::incompressible || formulation == fem::Formulation::incompressible_direct;
}

bool agree(const SolidPart& a, const SolidPart& b, std::vector<base::Diagnostic>& errors) {
  const fem::Formulation one = a.data.formulation;
  const fem::Formulation two = b.data.formulation;
  if (one == two || (keeps_volume_exactly(one) && keeps_volume_exactly(two))) return true;
  errors.push_back(scene::error_at(b.entry->origin, "it is attached to '" + a.entry->name +
                                                        "', which keeps its volume by another formulation: give both "
                                                        "the same `formulation`"));
  return false;
}

}  // namespace

std::vector<JoinedSolid> join_solids(std::vector<SolidPart> parts, std::vector<base::Diagnostic>& errors) {
  const std::vector<std::size_t> group = groups_of(parts);
  std::vector<JoinedSolid> joined;
  for (std::size_t first = 0; first < parts.size(); ++first) {
    if (group[first] != first) continue;
    JoinedSolid& one = joined.emplace_back();
    for (std::size_t k = first; k < parts.size(); ++k) {
      if (group[k] == first) one.solids.push_back(k);
    }
    if (one.solids.size() == 1) {
      one.data = std::move(parts[first].data);
      one.tied = {std::move(parts[first].tied)};
      continue;
    }
    Merger merger(one.data);
    std::vector<const SolidPart*> members;
    bool agreed = true;
    for (const std::size_t k : one.solids) {
      agreed = agreed && agree(parts[first], parts[k], errors);
      const fem::Member member = merger.add(parts[k].data);
      for (TiedNodes& tied : parts[k].tied) shift(tied.nodes, member.first_node);
      one.tied.push_back(parts[k].tied);
      members.push_back(&parts[k]);
    }
    if (agreed) Joiner(members, one, errors).join();
  }
  return joined;
}

}  // namespace muldi::build
