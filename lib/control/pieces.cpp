#include "control/pieces.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace muldi::control {
namespace {

std::vector<int> sorted(const std::set<int>& values) { return {values.begin(), values.end()}; }

/// Copies the forms of the pieces.
class Lister final : public model::ExpansionSink {
 public:
  Lister(const model::Chart& chart, PieceList& list) : chart_(chart), list_(list) {}

  void add(const model::LocalForms& forms, const model::LocalExpansion& expansion) override {
    Piece piece{.points = {forms.points.begin(), forms.points.end()},
                .entries = {forms.entries.begin(), forms.entries.end()},
                .rate = forms.rate,
                .coordinate = forms.coordinate,
                .size = forms.size(),
                .controls = {expansion.controls.begin(), expansion.controls.end()}};
    if (piece.coordinate != nullptr) piece.entries = piece.coordinate->unknowns();
    std::set<int> columns;
    if (piece.rate >= 0) columns.insert(piece.rate);
    for (const int dof : piece.entries) {
      const std::vector<int>& of_dof = chart_.columns_of(dof);
      columns.insert(of_dof.begin(), of_dof.end());
    }
    for (const model::LinearPoint& point : piece.points) {
      const std::vector<int> of_point = columns_of(point, chart_);
      columns.insert(of_point.begin(), of_point.end());
    }
    piece.columns = sorted(columns);
    list_.cliques.push_back(piece.columns);
    list_.pieces.push_back(std::move(piece));
  }

 private:
  const model::Chart& chart_;
  PieceList& list_;
};

void list_mass(const model::Model& model, const model::Chart& chart, PieceList& list) {
  std::vector<model::MassEntry> entries;
  for (const auto& term : model.terms) term->add_constant_mass(entries);
  std::map<std::pair<int, int>, double> sums;
  for (const model::MassEntry& entry : entries) {
    for (int i = 0; i < entry.x.n; ++i) {
      for (int j = 0; j < entry.y.n; ++j) {
        const auto a = static_cast<std::size_t>(i);
        const auto b = static_cast<std::size_t>(j);
        sums[{entry.x.dof[a], entry.y.dof[b]}] += entry.mass * entry.x.weight[a] * entry.y.weight[b];
      }
    }
  }
  for (const auto& [place, mass] : sums) {
    if (mass == 0.0) continue;
    list.mass.push_back({place.first, place.second, mass, &chart.columns_of(place.second)});
    std::set<int> columns;
    for (const int dof : {place.first, place.second}) {
      const std::vector<int>& of_dof = chart.columns_of(dof);
      columns.insert(of_dof.begin(), of_dof.end());
    }
    std::vector<int> clique = sorted(columns);
    if (list.cliques.empty() || list.cliques.back() != clique) list.cliques.push_back(std::move(clique));
  }
}

}  // namespace

void Piece::apply(const Eigen::VectorXd& q, Eigen::Ref<Eigen::VectorXd> out) const {
  for (std::size_t k = 0; k < points.size(); ++k) out.segment<3>(static_cast<Eigen::Index>(3 * k)) = points[k].rate(q);
  for (std::size_t k = 0; k < entries.size(); ++k) out[static_cast<Eigen::Index>(k)] = q[entries[k]];
}

void Piece::add_transposed(const Eigen::Ref<const Eigen::VectorXd>& local, Eigen::VectorXd& f) const {
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k].add_transposed(local.segment<3>(static_cast<Eigen::Index>(3 * k)), f);
  }
  for (std::size_t k = 0; k < entries.size(); ++k) f[entries[k]] += local[static_cast<Eigen::Index>(k)];
}

void Piece::project(const Eigen::MatrixXd& D, Eigen::MatrixXd& out) const {
  const auto n = static_cast<Eigen::Index>(columns.size());
  out.setZero(size, n);
  if (rate >= 0) {
    out(0, 0) = 1.0;
    return;
  }
  for (Eigen::Index c = 0; c < n; ++c) {
    const double* const column = D.data() + columns[static_cast<std::size_t>(c)] * D.rows();
    double* const to = out.data() + c * size;
    for (std::size_t p = 0; p < points.size(); ++p) {
      const model::LinearPoint& point = points[p];
      for (int k = 0; k < point.n; ++k) {
        const auto at = static_cast<std::size_t>(k);
        for (int r = 0; r < 3; ++r)
          to[3 * p + static_cast<std::size_t>(r)] += point.weight[at] * column[point.dof[at] + r];
      }
    }
    for (std::size_t k = 0; k < entries.size(); ++k) to[k] = column[entries[k]];
  }
}

std::vector<int> columns_of(const model::LinearPoint& point, const model::Chart& chart) {
  std::set<int> columns;
  for (int k = 0; k < point.n; ++k) {
    const std::vector<int>& of_dof = chart.columns_of(point.dof[static_cast<std::size_t>(k)]);
    columns.insert(of_dof.begin(), of_dof.end());
  }
  return sorted(columns);
}

void project_point(const model::LinearPoint& point, const Eigen::MatrixXd& D, Eigen::Ref<Eigen::MatrixXd> out) {
  out.setZero();
  for (int k = 0; k < point.n; ++k) {
    const auto at = static_cast<std::size_t>(k);
    out += point.weight[at] * D.middleRows<3>(point.dof[at]);
  }
}

void PieceList::multiply_mass(const Eigen::Ref<const Eigen::MatrixXd>& x, Eigen::Ref<Eigen::MatrixXd> out) const {
  out.setZero();
  for (Eigen::Index c = 0; c < x.cols(); ++c) {
    const double* const from = x.data() + c * x.outerStride();
    double* const to = out.data() + c * out.outerStride();
    for (const TripleMass& entry : mass) {
      for (int r = 0; r < 3; ++r) to[entry.row + r] += entry.mass * from[entry.column + r];
    }
  }
}

void PieceList::multiply_mass_of_chart(const Eigen::MatrixXd& D, Eigen::MatrixXd& out) const {
  out.setZero();
  for (const TripleMass& entry : mass) {
    for (const int c : *entry.columns) {
      const double* const from = D.data() + c * D.rows() + entry.column;
      double* const to = out.data() + c * out.rows() + entry.row;
      for (int r = 0; r < 3; ++r) to[r] += entry.mass * from[r];
    }
  }
}

PieceList list_pieces_of(const model::IntervalTerm& term, const model::Chart& chart, const model::IntervalPoint& at,
                         std::span<const double> squared) {
  PieceList list;
  Lister lister(chart, list);
  if (!term.expand(at, {.squared = squared}, lister)) list.refused.push_back(name_of_term(term));
  return list;
}

PieceList list_pieces(const model::Model& model, const model::Chart& chart, const model::IntervalPoint& at,
                      std::span<const double> squared) {
  PieceList list;
  Lister lister(chart, list);
  for (const auto& term : model.terms) {
    if (!term->expand(at, {.squared = squared}, lister)) list.refused.push_back(name_of_term(*term));
  }
  list_mass(model, chart, list);
  std::sort(list.cliques.begin(), list.cliques.end());
  list.cliques.erase(std::unique(list.cliques.begin(), list.cliques.end()), list.cliques.end());
  return list;
}

std::string name_of_term(const model::IntervalTerm& term) {
  const std::vector<std::string> parts = term.parts();
  return parts.empty() ? "loads" : parts.front();
}

}  // namespace muldi::control
