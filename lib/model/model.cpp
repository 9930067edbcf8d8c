#include "model/model.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace muldi::model {

void Model::bind() {
  PatternRequest request;
  each([&](const IntervalTerm& term) { term.request(request); });
  pattern = std::make_unique<math::BlockPattern>(node_sizes, request.pairs());
  n_q_ = pattern->n_rows();
  n_y_ = 0;
  for (const auto& part : substructures) {
    part->place_slices(n_q_, n_y_);
    n_q_ = part->q_slice().end();
    n_y_ = part->y_slice().end();
  }
  limits_.resize(substructures.size());
  works_.resize(substructures.size());
  part_counts_.clear();
  for (const auto& term : terms) term->bind(*pattern);
  for (const auto& part : substructures) part->bind(*pattern);
  each([&](const IntervalTerm& term) { part_counts_.push_back(term.parts().size()); });
}

void Model::evaluate_controls(double t, std::vector<double>& u) const {
  u.resize(controls.size());
  for (std::size_t k = 0; k < controls.size(); ++k) u[k] = controls[k].function.at(t);
}

bool Model::acts_at_ends() const {
  return !substructures.empty() ||
         std::any_of(terms.begin(), terms.end(), [](const auto& term) { return term->acts_at_ends(); });
}

void Model::forces(const IntervalPoint& at, IntervalForces& out) const {
  out.force.setZero();
  out.momentum.setZero();
  out.begin.setZero();
  out.end.setZero();
  out.stage.setZero();
  out.on_rates.setZero();
  out.margin = std::numeric_limits<double>::infinity();
  out.violation = 0.0;
  for (const auto& term : terms) term->add_forces(at, out);
  each_part([&](const Substructure& part, std::size_t i) { limits_[i] = part.add_part_forces(at, out); });
  for (const PartLimits& limits : limits_) limits.add_to(out);
}

void Model::tangent(const IntervalPoint& at, const TangentWeights& weights, math::BlockMatrix& K) const {
  K.set_zero();
  for (const auto& term : terms) term->add_tangent(at, weights, K);
}

void Model::rate_tangent(const IntervalPoint& at, const TangentWeights& weights, Eigen::VectorXd& diagonal) const {
  diagonal.setZero();
  for (const auto& term : terms) term->add_rate_tangent(at, weights, diagonal);
}

IntervalWork Model::work(const IntervalPoint& at) const {
  IntervalWork total;
  for (const auto& term : terms) total += term->work(at);
  each_part([&](const Substructure& part, std::size_t i) { works_[i] = part.work(at); });
  for (const IntervalWork& work : works_) total += work;
  return total;
}

std::string Model::inadmissible(const Eigen::VectorXd& q) const {
  for (const auto& term : terms) {
    std::string reason = term->inadmissible(q);
    if (!reason.empty()) return reason;
  }
  return {};
}

std::string Model::inadmissible_anywhere(const Eigen::VectorXd& q) const {
  std::string reason = inadmissible(q);
  for (const auto& part : substructures) {
    if (reason.empty()) reason = part->inadmissible(q);
  }
  return reason;
}

std::string Model::unresolved(const Eigen::VectorXd& q) const {
  std::string reason;
  for (const auto& part : substructures) {
    if (reason.empty()) reason = part->unresolved(q);
  }
  return reason;
}

std::string Model::body_at(int node) const {
  const auto at = static_cast<std::size_t>(node);
  return node >= 0 && at < body_names.size() ? "body '" + body_names[at] + "'" : "a body";
}

std::string Model::breach(const NodeView& at) const {
  for (const Guard& guard : guards) {
    if (std::string sentence = guard.breach(at); !sentence.empty()) return sentence;
  }
  return {};
}

std::string Model::advice(const NodePoint& at) const {
  std::string sentence;
  each([&](const IntervalTerm& term) {
    if (sentence.empty()) sentence = term.advice(at);
  });
  return sentence;
}

std::vector<std::string> Model::parts() const {
  std::vector<std::string> all;
  each([&](const IntervalTerm& term) {
    for (std::string& part : term.parts()) all.push_back(std::move(part));
  });
  return all;
}

bool Model::parts_side_by_side() const {
  if (substructures.size() < 2 || base::n_threads() == 1) return false;
  Eigen::Index total = 0;
  Eigen::Index largest = 0;
  for (const auto& part : substructures) {
    total += part->q_slice().size;
    largest = std::max(largest, part->q_slice().size);
  }
  const auto lanes = std::min<std::size_t>(substructures.size(), static_cast<std::size_t>(base::n_threads()));
  return static_cast<double>(total) > 0.6 * static_cast<double>(lanes) * static_cast<double>(largest);
}

void Model::energies(const NodePoint& at, std::span<Energy> out) const {
  std::fill(out.begin(), out.end(), Energy{});
  std::size_t first = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    terms[i]->energies(at, out.subspan(first, part_counts_[i]));
    first += part_counts_[i];
  }
  each_part([&](const Substructure& part, std::size_t k) {
    std::size_t begin = first;
    for (std::size_t before = 0; before < k; ++before) begin += part_counts_[terms.size() + before];
    part.energies(at, out.subspan(begin, part_counts_[terms.size() + k]));
  });
}

void Model::momentum_maps(const Eigen::VectorXd& q, const Eigen::VectorXd& p, Eigen::Vector3d& linear,
                          Eigen::Vector3d& angular) const {
  linear.setZero();
  angular.setZero();
  const auto add = [&](Eigen::Index at, bool is_position) {
    const Eigen::Vector3d part = p.segment<3>(at);
    if (is_position) linear += part;
    angular += Eigen::Vector3d(q.segment<3>(at)).cross(part);
  };
  for (int node = 0; node < pattern->n_nodes(); ++node) {
    const int first = pattern->offset(node);
    for (int k = 0; k + 3 <= pattern->size(node); k += 3) add(first + k, k == 0);
  }
  for (const auto& part : substructures) {
    for (Eigen::Index at = part->q_slice().first; at < part->q_slice().end(); at += 3) add(at, true);
  }
}

}  // namespace muldi::model
