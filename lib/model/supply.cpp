#include "model/supply.hpp"

namespace muldi::model {
namespace {

namespace dim = base::dimension;

/// What has been supplied to one terminal at a node.
double supplied_to(const Model& model, std::size_t terminal, const NodeView& at) {
  const Terminal& one = model.terminals[terminal];
  return one.supplied(at.accounts[terminal], one.values(at));
}

Observable scalar(std::string path, std::string doc, std::function<double(const NodeView&)> value) {
  return {.path = std::move(path),
          .shape = {},
          .unit = dim::energy,
          .doc = std::move(doc),
          .evaluate = [value = std::move(value)](const NodeView& at, std::span<double> out) { out[0] = value(at); }};
}

}  // namespace

SupplyBook::SupplyBook(const Model& model) {
  if (!model.books_supply) return;
  terminals_ = model.terminals;
  before_.resize(terminals_.size());
}

void SupplyBook::open(const NodeView& at, std::vector<double>& accounts) {
  stand(at);
  accounts.assign(terminals_.size(), 0.0);
  for (std::size_t i = 0; i < terminals_.size(); ++i) {
    if (!terminals_[i].gives_charge) accounts[i] = -before_[i].potential * before_[i].charge;
  }
}

void SupplyBook::stand(const NodeView& at) {
  for (std::size_t i = 0; i < terminals_.size(); ++i) before_[i] = terminals_[i].values(at);
}

void SupplyBook::change(const NodeView& at, std::vector<double>& accounts) {
  for (std::size_t i = 0; i < terminals_.size(); ++i) {
    const TerminalValues now = terminals_[i].values(at);
    const TerminalValues& old = before_[i];
    accounts[i] += terminals_[i].gives_charge ? 0.5 * (old.potential + now.potential) * (now.charge - old.charge)
                                              : -0.5 * (old.charge + now.charge) * (now.potential - old.potential);
    before_[i] = now;
  }
}

void add_terminal(const std::string& folder, Terminal terminal, const ElectricRecord& wanted, Model& model) {
  const std::size_t index = model.terminals.size();
  model.terminals.push_back(std::move(terminal));
  if (folder.empty()) return;
  if (wanted.stored_energy) {
    model.observables.push_back(
        scalar(folder + "/stored_energy", "electric energy stored, half of voltage times charge",
               [&model, index](const NodeView& at) { return model.terminals[index].values(at).stored(); }));
  }
  if (!wanted.supplied_energy) return;
  model.books_supply = true;
  model.observables.push_back(scalar(folder + "/supplied_energy", "electric energy supplied since the first row",
                                     [&model, index](const NodeView& at) { return supplied_to(model, index, at); }));
}

void add_supply_totals(const ElectricRecord& wanted, Model& model) {
  if (model.terminals.empty()) return;
  if (wanted.stored_energy) {
    model.observables.push_back(
        scalar("energy/stored", "energy of the electric field, +1/2 C U^2", [&model](const NodeView& at) {
          double sum = 0.0;
          for (const Terminal& terminal : model.terminals) sum += terminal.values(at).stored();
          return sum;
        }));
  }
  if (!wanted.supplied_energy) return;
  model.books_supply = true;
  model.observables.push_back(scalar("energy/supplied",
                                     "energy that all electric sources have supplied since the first row",
                                     [&model](const NodeView& at) {
                                       double sum = 0.0;
                                       for (std::size_t i = 0; i < model.terminals.size(); ++i)
                                         sum += supplied_to(model, i, at);
                                       return sum;
                                     }));
}

}  // namespace muldi::model
