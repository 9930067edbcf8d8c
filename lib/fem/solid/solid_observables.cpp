#include "fem/solid/solid_observables.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace muldi::fem {
namespace {

namespace dim = base::dimension;

/// Places of xx, yy, zz, xy, yz, zx in PointValues::cauchy.
constexpr std::array<int, 6> recorded_order{0, 1, 2, 5, 3, 4};

struct FieldText {
  const char* name;
  std::vector<std::size_t> width;  // shape of one value
  base::Dimension unit;
  bool at_nodes;
  const char* doc;
};

FieldText text_of(FieldQuantity quantity) {
  switch (quantity) {
    case FieldQuantity::position:
      return {"position", {3}, dim::length, true, "positions of the nodes, world axes"};
    case FieldQuantity::velocity:
      return {"velocity", {3}, dim::velocity, true, "velocities of the nodes, world axes"};
    case FieldQuantity::potential:
      return {"potential", {}, dim::voltage, true, "electric potential at the nodes"};
    case FieldQuantity::pressure:
      return {"pressure", {}, dim::stress, false, "pressure of the cells, > 0 in compression"};
    case FieldQuantity::stress:
      return {"stress",
              {6},
              dim::stress,
              false,
              "Cauchy stress with its electric and viscous parts, means of the cells: xx, yy, zz, xy, yz, zx"};
    case FieldQuantity::field:
      return {"field",
              {3},
              dim::field,
              false,
              "nominal electric field (by reference length), means of the cells, reference axes"};
    case FieldQuantity::true_field:
      return {"true_field",
              {3},
              dim::field,
              false,
              "electric field, means of the cells over the reference volume, world axes"};
    case FieldQuantity::jacobian:
      break;
  }
  return {"jacobian", {}, dim::none, false, "volume of the cells by their reference volume"};
}

void copy(const Eigen::Ref<const Eigen::VectorXd>& from, std::span<double> out) {
  std::copy(from.data(), from.data() + from.size(), out.begin());
}

}  // namespace

SolidRecords::SolidRecords(const Solid& solid, std::size_t member) : solid_(solid), member_(member) {}

std::vector<int> SolidRecords::nodes(std::vector<int> of_member) const {
  for (int& node : of_member) node += member().first_node;
  return of_member;
}

bool SolidRecords::is_held(int node, int component) const {
  const std::vector<std::uint8_t>& given = solid_.data().given;
  if (given.empty()) return !solid_.unknowns().is_free(node, component);
  return (given[static_cast<std::size_t>(node)] >> component & 1) != 0;
}

const Eigen::VectorXd& SolidRecords::potentials(const model::NodeView& at) const {
  if (potentials_.is_old(at)) potentials_.value = solid_.potentials_at(solid_.positions(at.q), at.u);
  return potentials_.value;
}

double SolidRecords::charge(const std::vector<int>& nodes, const model::NodeView& at) const {
  if (charges_.is_old(at)) {
    const Eigen::VectorXd& phi = potentials(at);
    charges_.value.setZero(phi.size());
    solid_.elements().forces({.x = solid_.positions(at.q).data(), .phi = phi.data()},
                             {.charge = charges_.value.data()});
    solid_.bonds().gather(1, charges_.value);
    solid_.bonds().account(1, charges_.value);
  }
  // The gradient of the enthalpy by the potentials is minus the charge.
  double sum = 0.0;
  for (const int node : nodes) sum -= charges_.value[node];
  return sum;
}

Eigen::Vector3d SolidRecords::reaction(const std::vector<int>& nodes, const model::NodeView& at) const {
  if (reactions_.is_old(at)) {
    reactions_.value = solid_.positions(at.constraint_force);
    solid_.bonds().account(3, reactions_.value);
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int node : nodes) {
    for (int i = 0; i < 3; ++i) {
      if (is_held(node, i)) sum[i] += reactions_.value[3 * static_cast<Eigen::Index>(node) + i];
    }
  }
  return sum;
}

double SolidRecords::potential(const WeightedNodes& where, const model::NodeView& at) const {
  const Eigen::VectorXd& phi = potentials(at);
  double sum = 0.0;
  for (std::size_t k = 0; k < where.nodes.size(); ++k) sum += where.weights[k] * phi[where.nodes[k]];
  return sum;
}

Eigen::Vector3d SolidRecords::value(PointQuantity quantity, const WeightedNodes& where,
                                    const model::NodeView& at) const {
  const auto values = solid_.positions(quantity == PointQuantity::velocity ? at.v : at.q);
  const Eigen::VectorXd& X = solid_.data().X;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < where.nodes.size(); ++k) {
    const Eigen::Index first = 3 * static_cast<Eigen::Index>(where.nodes[k]);
    Eigen::Vector3d one = values.segment<3>(first);
    if (quantity == PointQuantity::displacement) one -= X.segment<3>(first);
    sum += where.weights[k] * one;
  }
  return sum;
}

const Eigen::VectorXd& SolidRecords::tensions(const model::NodeView& at) const {
  if (!tensions_.is_old(at)) return tensions_.value;
  const ElementSet& elements = solid_.elements();
  Eigen::VectorXd& p = tensions_.value;
  if (solid_.is_incompressible()) {
    p = solid_.pressures(at.y_after != nullptr ? *at.y_after : at.y);
    return p;
  }
  p.resize(elements.n_cells());
  if (solid_.has_pressures()) {
    const Volumes& volumes = solid_.volumes_at(solid_.positions(at.q));
    for (int cell = 0; cell < elements.n_cells(); ++cell) p[cell] = solid_.dilation(cell, volumes.J[cell]).pressure;
    return p;
  }
  std::vector<PointValues> points(8 * static_cast<std::size_t>(elements.n_cells()));
  elements.point_values({.x = solid_.positions(at.q).data()}, points.data());
  for (int cell = 0; cell < elements.n_cells(); ++cell) {
    const PointValues mean = mean_of(std::span<const PointValues, 8>(&points[8 * static_cast<std::size_t>(cell)], 8));
    p[cell] = (mean.cauchy[0] + mean.cauchy[1] + mean.cauchy[2]) / 3.0;
  }
  return p;
}

const SolidRecords::CellMeans& SolidRecords::cell_means(const model::NodeView& at) const {
  if (!means_.is_old(at)) return means_.value;
  const ElementSet& elements = solid_.elements();
  ElementFields fields{.x = solid_.positions(at.q).data(), .v = solid_.positions(at.v).data()};
  if (solid_.unknowns().has_field()) fields.phi = potentials(at).data();
  if (solid_.has_pressures()) fields.pressure = tensions(at).data();
  std::vector<PointValues> points(8 * static_cast<std::size_t>(elements.n_cells()));
  elements.point_values(fields, points.data());
  CellMeans& out = means_.value;
  out.stress.setZero(6, elements.n_cells());
  out.field.setZero(3, elements.n_cells());
  out.true_field.setZero(3, elements.n_cells());
  for (Eigen::Index cell = 0; cell < elements.n_cells(); ++cell) {
    double volume = 0.0;
    for (std::size_t i = 0; i < 8; ++i) {
      const PointValues& point = points[8 * static_cast<std::size_t>(cell) + i];
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> F(point.F);
      const Eigen::Map<const Eigen::Vector3d> e(point.field);
      for (std::size_t k = 0; k < 6; ++k) {
        out.stress(static_cast<Eigen::Index>(k), cell) += point.volume * point.cauchy[recorded_order[k]];
      }
      out.true_field.col(cell) += point.volume * e;
      out.field.col(cell) += point.volume * (F.transpose() * e);
      volume += point.volume;
    }
    out.stress.col(cell) /= volume;
    out.field.col(cell) /= volume;
    out.true_field.col(cell) /= volume;
  }
  return out;
}

void SolidRecords::write(FieldQuantity quantity, const model::NodeView& at, std::span<double> out) const {
  const auto of_nodes = [&](const Eigen::Ref<const Eigen::VectorXd>& all, int width) {
    copy(all.segment(width * static_cast<Eigen::Index>(member().first_node),
                     width * static_cast<Eigen::Index>(member().n_nodes)),
         out);
  };
  const auto of_cells = [&](const Eigen::Ref<const Eigen::MatrixXd>& all) {
    copy(Eigen::VectorXd(all.middleCols(member().first_cell, member().n_cells).reshaped()), out);
  };
  switch (quantity) {
    case FieldQuantity::position:
      return of_nodes(solid_.positions(at.q), 3);
    case FieldQuantity::velocity:
      return of_nodes(solid_.positions(at.v), 3);
    case FieldQuantity::potential:
      return of_nodes(potentials(at), 1);
    case FieldQuantity::pressure:
      return of_cells(-tensions(at).transpose());
    case FieldQuantity::stress:
      return of_cells(cell_means(at).stress);
    case FieldQuantity::field:
      return of_cells(cell_means(at).field);
    case FieldQuantity::true_field:
      return of_cells(cell_means(at).true_field);
    case FieldQuantity::jacobian:
      return of_cells(solid_.volumes_at(solid_.positions(at.q)).J.transpose());
  }
}

model::FieldHistory::Field SolidRecords::field(FieldQuantity quantity, const std::string& folder) const {
  const FieldText text = text_of(quantity);
  const int n = text.at_nodes ? member().n_nodes : member().n_cells;
  std::vector<std::size_t> shape{static_cast<std::size_t>(n)};
  shape.insert(shape.end(), text.width.begin(), text.width.end());
  return {.observable = {.path = folder + "/" + text.name,
                         .shape = std::move(shape),
                         .unit = text.unit,
                         .doc = text.doc,
                         .evaluate = [this, quantity](const model::NodeView& at,
                                                      std::span<double> out) { write(quantity, at, out); },
                         .of_motion = quantity == FieldQuantity::velocity},
          .at_nodes = text.at_nodes};
}

model::Observable SolidRecords::electrode(const std::string& name, const std::vector<int>& nodes, bool charged) const {
  const std::string path = "electrodes/" + member().name + "." + name;
  if (charged) {
    return {
        .path = path + "/charge",
        .shape = {},
        .unit = dim::charge,
        .doc = "free charge on the electrode",
        .evaluate = [this, &nodes](const model::NodeView& at, std::span<double> out) { out[0] = charge(nodes, at); }};
  }
  return {.path = path + "/potential",
          .shape = {},
          .unit = dim::voltage,
          .doc = "potential of the electrode",
          .evaluate = [this, first = nodes.front()](const model::NodeView& at, std::span<double> out) {
            out[0] = potentials(at)[first];
          }};
}

std::vector<model::Observable> SolidRecords::electrodes() const {
  std::vector<model::Observable> all;
  const auto add = [&](const auto& list) {
    for (const auto& one : list) {
      if (!owns(one)) continue;
      all.push_back(electrode(one.name, one.nodes, true));
      all.push_back(electrode(one.name, one.nodes, false));
    }
  };
  add(solid_.data().electrodes);
  add(solid_.data().floating);
  return all;
}

}  // namespace muldi::fem
