#include "model/model.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace muldi::model {

void Model::bind() {
  PatternRequest request;
  for (const auto& term : terms) term->request(request);
  pattern = std::make_unique<math::BlockPattern>(node_sizes, request.pairs());
  part_counts_.clear();
  for (const auto& term : terms) {
    term->bind(*pattern);
    part_counts_.push_back(term->parts().size());
  }
}

void Model::evaluate_controls(double t, std::vector<double>& u) const {
  for (std::size_t k = 0; k < controls.size(); ++k) u[k] = controls[k].function.at(t);
}

void Model::forces(const IntervalPoint& at, IntervalForces& out) const {
  out.force.setZero();
  out.momentum.setZero();
  for (const auto& term : terms) term->add_forces(at, out);
}

void Model::tangent(const IntervalPoint& at, const TangentWeights& weights, math::BlockMatrix& K) const {
  K.set_zero();
  for (const auto& term : terms) term->add_tangent(at, weights, K);
}

IntervalWork Model::work(const IntervalPoint& at) const {
  IntervalWork total;
  for (const auto& term : terms) total += term->work(at);
  return total;
}

std::string Model::inadmissible(const Eigen::VectorXd& q) const {
  for (const auto& term : terms) {
    std::string reason = term->inadmissible(q);
    if (!reason.empty()) return reason;
  }
  return {};
}

std::string Model::advice(const NodePoint& at) const {
  for (const auto& term : terms) {
    std::string sentence = term->advice(at);
    if (!sentence.empty()) return sentence;
  }
  return {};
}

std::vector<std::string> Model::parts() const {
  std::vector<std::string> all;
  for (const auto& term : terms) {
    for (std::string& part : term->parts()) all.push_back(std::move(part));
  }
  return all;
}

void Model::energies(const NodePoint& at, std::span<Energy> out) const {
  std::fill(out.begin(), out.end(), Energy{});
  std::size_t first = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    terms[i]->energies(at, out.subspan(first, part_counts_[i]));
    first += part_counts_[i];
  }
}

void Model::momentum_maps(const Eigen::VectorXd& q, const Eigen::VectorXd& p, Eigen::Vector3d& linear,
                          Eigen::Vector3d& angular) const {
  linear.setZero();
  angular.setZero();
  for (int node = 0; node < pattern->n_nodes(); ++node) {
    const int first = pattern->offset(node);
    for (int k = 0; k + 3 <= pattern->size(node); k += 3) {
      const Eigen::Vector3d part = p.segment<3>(first + k);
      if (k == 0) linear += part;
      angular += Eigen::Vector3d(q.segment<3>(first + k)).cross(part);
    }
  }
}

}  // namespace muldi::model
