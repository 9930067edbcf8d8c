/// What a scene records of solids: fields, probes, electrodes.
#include <map>
#include <optional>

#include "base/error.hpp"
#include "build/build_solids.hpp"
#include "build/place_bodies.hpp"
#include "fem/mesh/selection.hpp"
#include "fem/solid/face_shares.hpp"
#include "fem/solid/solid_observables.hpp"

namespace muldi::build {
namespace {

namespace dim = base::dimension;

using Eigen::Vector3d;
using fem::PointQuantity;
using fem::SolidRecords;
using model::NodeView;

/// A vector at a node in time.
using Read = std::function<Vector3d(const NodeView&)>;

fem::FieldQuantity quantity_of(scene::SolidField field) {
  switch (field) {
    case scene::SolidField::position:
      return fem::FieldQuantity::position;
    case scene::SolidField::velocity:
      return fem::FieldQuantity::velocity;
    case scene::SolidField::potential:
      return fem::FieldQuantity::potential;
    case scene::SolidField::pressure:
      return fem::FieldQuantity::pressure;
    case scene::SolidField::stress:
      return fem::FieldQuantity::stress;
    case scene::SolidField::field:
      return fem::FieldQuantity::field;
    case scene::SolidField::true_field:
      return fem::FieldQuantity::true_field;
    case scene::SolidField::jacobian:
      break;
  }
  return fem::FieldQuantity::jacobian;
}

PointQuantity quantity_of(scene::ProbeQuantity of) {
  switch (of) {
    case scene::ProbeQuantity::position:
      return PointQuantity::position;
    case scene::ProbeQuantity::displacement:
      return PointQuantity::displacement;
    case scene::ProbeQuantity::velocity:
      return PointQuantity::velocity;
    case scene::ProbeQuantity::potential:
      break;
  }
  return PointQuantity::potential;
}

base::Dimension unit_of(PointQuantity of) {
  return of == PointQuantity::potential ? dim::voltage : of == PointQuantity::velocity ? dim::velocity : dim::length;
}

const char* word_of(PointQuantity of) {
  switch (of) {
    case PointQuantity::position:
      return "position";
    case PointQuantity::displacement:
      return "displacement from the scene pose";
    case PointQuantity::velocity:
      return "velocity";
    case PointQuantity::potential:
      break;
  }
  return "potential";
}

class ProbeBuilder {
 public:
  ProbeBuilder(const scene::Scene& scene, const std::vector<fem::Mesh>& meshes, BuiltModel& built)
      : scene_(scene), meshes_(meshes), built_(built) {}

  void add(const scene::Entry<scene::Probe>& entry) {
    name_ = entry.name;
    std::visit([this](const auto& probe) { add(probe); }, entry.value);
  }

  std::vector<base::Diagnostic> take_errors() { return std::move(errors_); }

 private:
  void add(const scene::DistanceProbe& probe) {
    const Read a = point(probe.distance[0], PointQuantity::position);
    const Read b = point(probe.distance[1], PointQuantity::position);
    if (probe.along) {
      const Vector3d along = to_eigen(*probe.along).normalized();
      record({}, dim::length, "second point less the first, along the given direction",
             [a, b, along](const NodeView& at, std::span<double> out) { out[0] = along.dot(b(at) - a(at)); });
    } else {
      record({}, dim::length, "distance of the two points",
             [a, b](const NodeView& at, std::span<double> out) { out[0] = (b(at) - a(at)).norm(); });
    }
  }

  void add(const scene::PointProbe& probe) {
    const PointQuantity of = quantity_of(probe.of);
    const std::string what = std::string(word_of(of)) + " of the point";
    if (of == PointQuantity::potential) {
      record_potential(records(*probe.point.solid), node_at(probe.point), what);
    } else {
      record_vector(point(probe.point, of), probe.along, unit_of(of), what, of == PointQuantity::velocity);
    }
  }

  void add(const scene::AverageProbe& probe) {
    const fem::Mesh& mesh = meshes_[index_of(probe.average.solid)];
    const fem::Selected found = fem::MeshSelection(mesh).faces(probe.average.where.selector);
    if (!accept(found, probe.average.where.origin)) return;
    const SolidRecords& solid = records(probe.average.solid);
    const int first = solid.member().first_node;
    std::map<int, double> shares;
    double area = 0.0;
    for (const fem::CellFace& face : found.faces) {
      std::array<int, 4> corners = face_nodes(mesh, face);
      for (int& corner : corners) corner += first;
      const std::array<double, 4> share = fem::area_shares(corners, solid.solid().data().X);
      for (std::size_t a = 0; a < 4; ++a) {
        shares[corners[a]] += share[a];
        area += share[a];
      }
    }
    fem::WeightedNodes where;
    for (const auto& [node, share] : shares) {
      where.nodes.push_back(node);
      where.weights.push_back(share / area);
    }
    const PointQuantity of = quantity_of(probe.of);
    const std::string what = std::string(word_of(of)) + ", average over the faces by reference area";
    if (of == PointQuantity::potential) {
      record_potential(solid, std::move(where), what);
    } else {
      record_vector([&solid, of, where](const NodeView& at) { return solid.value(of, where, at); }, probe.along,
                    unit_of(of), what, of == PointQuantity::velocity);
    }
  }

  void add(const scene::ReactionProbe& probe) {
    const scene::Where& where = probe.reaction.where;
    const fem::Selected found = fem::MeshSelection(meshes_[index_of(probe.reaction.solid)]).nodes(where.selector);
    if (!accept(found, where.origin)) return;
    const SolidRecords& solid = records(probe.reaction.solid);
    const std::vector<int> nodes = solid.nodes(found.nodes);
    bool held = false;
    for (const int node : nodes) {
      for (int i = 0; i < 3; ++i) held |= solid.is_held(node, i);
    }
    if (!held) errors_.push_back(scene::error_at(where.origin, "no displacement is prescribed there: no reaction"));
    record_vector([&solid, nodes](const NodeView& at) { return solid.reaction(nodes, at); }, probe.along, dim::force,
                  "force on the solid that holds its prescribed displacements", false);
  }

  /// The charge of an electrode; of alternating ones, of those at each potential in turn.
  void add(const scene::ChargeProbe& probe) {
    const SolidRecords& solid = records(probe.charge.solid);
    std::vector<const std::vector<int>*> groups;
    const auto collect = [&](const auto& list) {
      for (const auto& one : list) {
        if (!solid.owns(one)) continue;
        const bool part = one.name.starts_with(probe.charge.name + "_") && is_alternating(probe.charge);
        if (part || one.name == probe.charge.name) groups.push_back(&one.nodes);
      }
    };
    collect(solid.solid().data().electrodes);
    collect(solid.solid().data().floating);
    std::vector<std::size_t> shape;
    if (groups.size() != 1) shape.push_back(groups.size());
    record(std::move(shape), dim::charge, "free charge on the electrode",
           [&solid, groups](const NodeView& at, std::span<double> out) {
             for (std::size_t k = 0; k < groups.size(); ++k) out[k] = solid.charge(*groups[k], at);
           });
  }

  bool is_alternating(const scene::ElectrodeName& name) const {
    const auto* electrode = scene_.solids.find(name.solid.name)->value.electrodes.find(name.name);
    return electrode != nullptr && electrode->value.alternate.has_value();
  }

  std::size_t index_of(const scene::SolidName& name) const {
    return static_cast<std::size_t>(scene_.solids.index(name.name));
  }
  const SolidRecords& records(const scene::SolidName& name) const { return *built_.solid_records[index_of(name)]; }

  bool accept(const fem::Selected& found, const scene::Origin& origin) {
    if (found.error.empty()) return true;
    errors_.push_back(scene::error_at(origin, found.error));
    return false;
  }

  fem::WeightedNodes node_at(const scene::ProbePoint& point) {
    const fem::Selected found =
        fem::MeshSelection(meshes_[index_of(*point.solid)]).nodes(fem::SelectPoint{.point = point.at});
    if (!accept(found, point.origin)) return {};
    return {records(*point.solid).nodes(found.nodes), {1.0}};
  }

  Read point(const scene::ProbePoint& said, PointQuantity of) {
    if (said.solid) {
      const SolidRecords& solid = records(*said.solid);
      return [&solid, of, where = node_at(said)](const NodeView& at) { return solid.value(of, where, at); };
    }
    // phi + sum xi_i d_i of positions, velocities or displacements: the same linear map.
    const Vector3d local = to_eigen(said.point.position);
    const Eigen::Index first = 12 * static_cast<Eigen::Index>(body_index(scene_, said.body->name));
    const auto map = [first, local](const Eigen::VectorXd& q) -> Vector3d {
      Vector3d sum = q.segment<3>(first);
      for (Eigen::Index i = 0; i < 3; ++i) sum += local[i] * q.segment<3>(first + 3 + 3 * i);
      return sum;
    };
    if (of == PointQuantity::velocity) return [map](const NodeView& at) { return map(at.v); };
    if (of == PointQuantity::position) return [map](const NodeView& at) { return map(at.q); };
    Eigen::VectorXd q(built_.manifold->n_q());
    built_.manifold->configuration(built_.manifold->reference(), q);
    return [map, start = map(q)](const NodeView& at) -> Vector3d { return map(at.q) - start; };
  }

  void record_potential(const SolidRecords& solid, fem::WeightedNodes where, const std::string& doc) {
    record({}, dim::voltage, doc, [&solid, where = std::move(where)](const NodeView& at, std::span<double> out) {
      out[0] = solid.potential(where, at);
    });
  }

  void record_vector(const Read& read, const std::optional<base::Vec3>& along, base::Dimension unit,
                     const std::string& doc, bool of_motion) {
    if (along) {
      record({}, unit, doc + ", along the given direction",
             [read, unit_vector = to_eigen(*along).normalized()](const NodeView& at, std::span<double> out) {
               out[0] = unit_vector.dot(read(at));
             });
    } else {
      record({3}, unit, doc + ", world axes", [read](const NodeView& at, std::span<double> out) {
        const Vector3d value = read(at);
        std::copy(value.data(), value.data() + 3, out.begin());
      });
    }
    built_.model->observables.back().of_motion = of_motion;
  }

  void record(std::vector<std::size_t> shape, base::Dimension unit, std::string doc,
              std::function<void(const NodeView&, std::span<double>)> evaluate) {
    built_.model->observables.push_back({.path = "probes/" + name_,
                                         .shape = std::move(shape),
                                         .unit = unit,
                                         .doc = std::move(doc),
                                         .evaluate = std::move(evaluate)});
  }

  const scene::Scene& scene_;
  const std::vector<fem::Mesh>& meshes_;
  BuiltModel& built_;
  std::string name_;
  std::vector<base::Diagnostic> errors_;
};

model::FieldHistory history_of(const SolidRecords& records, const scene::RecordedFields& said) {
  const fem::SolidDescription& solid = records.solid().data();
  const fem::Member& member = records.member();
  // Meshes of muscles too: the folder of the muscle holds its series over all records.
  model::FieldHistory history{.folder = "solids/" + member.name, .every = said.every};
  const double* X = solid.X.data() + 3 * static_cast<std::ptrdiff_t>(member.first_node);
  history.reference.assign(X, X + 3 * static_cast<std::ptrdiff_t>(member.n_nodes));
  for (int cell = member.first_cell; cell < member.first_cell + member.n_cells; ++cell) {
    for (const int node : solid.cells[static_cast<std::size_t>(cell)]) {
      history.cells.push_back(node - member.first_node);
    }
  }
  for (const scene::SolidField field : said.fields) {
    history.fields.push_back(records.field(quantity_of(field), history.folder));
  }
  return history;
}

/// The records of a solid, or else of a meshed muscle, of this name; null for a muscle without mesh.
const SolidRecords* records_of(const scene::Scene& scene, const std::string& name, const BuiltModel& built) {
  const int solid = scene.solids.index(name);
  if (solid >= 0) return built.solid_records[static_cast<std::size_t>(solid)].get();
  for (const MeshedMuscle& muscle : built.meshed_muscles) {
    if (scene.muscles[muscle.index].name == name) return muscle.records;
  }
  return nullptr;
}

}  // namespace

void add_solid_observables(const scene::Scene& scene, const std::vector<fem::Mesh>& meshes, BuiltModel& built) {
  for (const auto& records : built.solid_records) {
    for (model::Observable& one : records->electrodes()) built.model->observables.push_back(std::move(one));
    const model::ElectricRecord wanted = electric_record(scene);
    if (wanted.any()) records->add_electric(wanted, *built.model);
  }
  ProbeBuilder probes(scene, meshes, built);
  for (const auto& entry : scene.record.probes) probes.add(entry);
  std::vector<base::Diagnostic> errors = probes.take_errors();
  if (!errors.empty()) throw base::InputError(std::move(errors));
}

void add_field_histories(const scene::Scene& scene, BuiltModel& built) {
  for (const auto& entry : scene.record.fields) {
    if (entry.value.fields.empty()) continue;
    const fem::SolidRecords* records = records_of(scene, entry.name, built);
    if (records != nullptr) built.model->histories.push_back(history_of(*records, entry.value));
  }
}

}  // namespace muldi::build
