#include "model/substructure_set.hpp"

#include <algorithm>

namespace muldi::model {

SubstructureSet::SubstructureSet(const Model& model, Linearisation kind, const std::string& name) : model_(model) {
  for (const auto& part : model.substructures) solvers_.push_back(part->make_solver(kind, name));
}

bool SubstructureSet::moves() const {
  return std::any_of(model_.substructures.begin(), model_.substructures.end(),
                     [](const auto& part) { return part->moves(); });
}

void SubstructureSet::place(const Placement& at, Eigen::VectorXd& q, Eigen::VectorXd& y) const {
  for (const auto& part : model_.substructures) part->place(at, q, y);
}

void SubstructureSet::settle_stage(const IntervalPoint& at, Eigen::VectorXd& y) const {
  for (const auto& part : model_.substructures) part->settle_stage(at, y);
}

void SubstructureSet::keep_free(Eigen::VectorXd& rows) const {
  for (const auto& part : model_.substructures) part->keep_free(rows);
}

double SubstructureSet::size_of(const Eigen::VectorXd& dq, const Eigen::VectorXd& dy) const {
  double largest = 0.0;
  for (const auto& part : model_.substructures) {
    const double size = part->size_of(dq, dy).largest();
    if (!(size <= largest)) largest = size;  // keeps a NaN
  }
  return largest;
}

double SubstructureSet::product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  double sum = 0.0;
  Eigen::Index n_nodes = 0;
  for (const auto& part : model_.substructures) {
    const Slice& slice = part->q_slice();
    const double length = part->natural_length();
    sum += a.segment(slice.first, slice.size).dot(b.segment(slice.first, slice.size)) / (length * length);
    n_nodes += slice.size / 3;
  }
  return n_nodes > 0 ? sum / static_cast<double>(n_nodes) : 0.0;
}

void SubstructureSet::add_load_rate(const IntervalPoint& at, std::span<const double> du, Eigen::VectorXd& rows,
                                    Eigen::VectorXd& h) const {
  for (const auto& part : model_.substructures) part->add_load_rate(at, du, rows, h);
}

double SubstructureSet::largest_row(const Eigen::VectorXd& rows) const {
  double largest = 0.0;
  for (const auto& part : model_.substructures) {
    const Slice& slice = part->q_slice();
    largest = std::max(largest, rows.segment(slice.first, slice.size).lpNorm<Eigen::Infinity>());
  }
  return largest;
}

bool SubstructureSet::factorise(const IntervalPoint& at) {
  factorised_ = std::all_of(solvers_.begin(), solvers_.end(), [&](auto& solver) { return solver->factorise(at); });
  return factorised_;
}

void SubstructureSet::eliminate(Eigen::VectorXd& bracket, const Eigen::VectorXd& h, math::BlockMatrix& K) {
  for (auto& solver : solvers_) {
    solver->add_condensed(K);
    solver->reduce(bracket, h);
  }
}

void SubstructureSet::complete(Eigen::VectorXd& dq, Eigen::VectorXd& dy) {
  for (auto& solver : solvers_) solver->expand(dq, dy);
}

int SubstructureSet::unstable_directions() const {
  int count = 0;
  for (const auto& solver : solvers_) count += solver->unstable_directions();
  return count;
}

void SubstructureSet::copy_slices(const Eigen::VectorXd& from, Eigen::VectorXd& to) const {
  for (const auto& part : model_.substructures) {
    const Slice& slice = part->q_slice();
    to.segment(slice.first, slice.size) = from.segment(slice.first, slice.size);
  }
}

void SubstructureSet::add_slices(double factor, const Eigen::VectorXd& from, Eigen::VectorXd& to) const {
  for (const auto& part : model_.substructures) {
    const Slice& slice = part->q_slice();
    to.segment(slice.first, slice.size) += factor * from.segment(slice.first, slice.size);
  }
}

}  // namespace muldi::model
