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

IncrementSize SubstructureSet::size_of(const Eigen::VectorXd& dq, const Eigen::VectorXd& dy) const {
  IncrementSize largest;
  for (const auto& part : model_.substructures) {
    const IncrementSize size = part->size_of(dq, dy);
    // Comparisons that keep a NaN.
    if (!(size.positions <= largest.positions)) largest.positions = size.positions;
    if (!(size.stage <= largest.stage)) largest.stage = size.stage;
  }
  return largest;
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

void SubstructureSet::linearise(const IntervalPoint& at, double accuracy) {
  for (auto& solver : solvers_) solver->linearise(at, accuracy);
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
