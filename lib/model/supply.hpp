#pragma once
/// Books the energy that electric sources supply, and makes it an observable.
#include <span>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace muldi::model {

/// Accounts of the terminals of a model. With given potentials an account is -(U Q)_0 - int Q dU, with given charges
/// int U dQ: it changes with the controls only. The integrals are trapezoids between the nodes that are compared, exact
/// where the positions are the same. Accounts are empty, and nothing is evaluated, unless the model books its supply.
class SupplyBook {
 public:
  /// The model must outlive the object.
  explicit SupplyBook(const Model& model);

  bool is_kept() const { return !terminals_.empty(); }
  /// Opens the accounts at a node, where nothing has been supplied yet.
  void open(const NodeView& at, std::vector<double>& accounts);
  /// Takes a node as the begin of the next change.
  void stand(const NodeView& at);
  /// Books the change since the node before, and takes this node as the begin of the next one.
  void change(const NodeView& at, std::vector<double>& accounts);

 private:
  std::span<const Terminal> terminals_;
  std::vector<TerminalValues> before_;
};

/// Adds a terminal to the model, with <folder>/stored_energy and <folder>/supplied_energy where they are wanted; none
/// of a folder that is empty.
void add_terminal(const std::string& folder, Terminal terminal, const ElectricRecord& wanted, Model& model);

/// energy/stored and energy/supplied, sums over all terminals, where they are wanted and there are terminals; call
/// after the last terminal.
void add_supply_totals(const ElectricRecord& wanted, Model& model);

}  // namespace muldi::model
