#include "model/substructure_set.hpp"

#include <algorithm>

namespace muldi::model {

SubstructureSet::SubstructureSet(const Model& model, Linearisation kind, const std::string& name) : model_(model) {
  for (const auto& part : model.substructures) solvers_.push_back(part->make_solver(kind, name));
  done_.resize(solvers_.size());
}

bool SubstructureSet::moves() const {
  return std::any_of(model_.substructures.begin(), model_.substructures.end(),
                     [](const auto& part) { return part->moves(); });
}

void SubstructureSet::place(const Placement& at, Eigen::VectorXd& q, Eigen::VectorXd& y) const {
  model_.each_part([&](const Substructure& part, std::size_t) { part.place(at, q, y); });
}

void SubstructureSet::settle_stage(const IntervalPoint& at, Eigen::VectorXd& y) const {
  model_.each_part([&](const Substructure& part, std::size_t) { part.settle_stage(at, y); });
}

void SubstructureSet::keep_free(Eigen::VectorXd& rows) const {
  for (const auto& part : model_.substructures) part->keep_free(rows);
}

void SubstructureSet::gather(Eigen::VectorXd& rows) const {
  for (const auto& part : model_.substructures) part->gather(rows);
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

double SubstructureSet::deformation(const Eigen::VectorXd& q, const Eigen::VectorXd& dq) const {
  double largest = 0.0;
  for (const auto& part : model_.substructures) {
    const double one = part->deformation(q, dq);
    if (!(one <= largest)) largest = one;
  }
  return largest;
}

void SubstructureSet::carry(const Eigen::VectorXd& before, const Eigen::VectorXd& motion, Eigen::VectorXd& q) const {
  for (const auto& part : model_.substructures) part->carry(before, motion, q);
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
  model_.each_part([&](const Substructure&, std::size_t i) { done_[i] = solvers_[i]->factorise(at) ? 1 : 0; });
  factorised_ = std::all_of(done_.begin(), done_.end(), [](char done) { return done != 0; });
  return factorised_;
}

void SubstructureSet::turn(const Eigen::VectorXd& q) {
  model_.each_part([&](const Substructure&, std::size_t i) { solvers_[i]->turn(q); });
}

void SubstructureSet::linearise(const IntervalPoint& at, double accuracy) {
  model_.each_part([&](const Substructure&, std::size_t i) { solvers_[i]->linearise(at, accuracy); });
}

void SubstructureSet::respond(Eigen::VectorXd& bracket, const Eigen::VectorXd& h) {
  model_.each_part([&](const Substructure&, std::size_t i) { solvers_[i]->reduce(bracket, h); });
  for (const auto& solver : solvers_) solver->add_response(bracket);
}

void SubstructureSet::eliminate(Eigen::VectorXd& bracket, const Eigen::VectorXd& h, math::BlockMatrix& K) {
  respond(bracket, h);
  for (const auto& solver : solvers_) solver->add_condensed(K);
}

void SubstructureSet::complete(Eigen::VectorXd& dq, Eigen::VectorXd& dy) {
  model_.each_part([&](const Substructure&, std::size_t i) { solvers_[i]->expand(dq, dy); });
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
