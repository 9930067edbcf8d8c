#pragma once
/// Mean dilatations of the elements and their gradients at one configuration, computed once for it.
#include <Eigen/Core>
#include <span>

#include "fem/solid/element_set.hpp"

namespace muldi::fem {

struct Volumes {
  Eigen::VectorXd x;         ///< the configuration (3 n_nodes) that they belong to
  Eigen::VectorXd J;         ///< J_e (n_cells)
  Eigen::VectorXd gradient;  ///< g_e = dJ_e/dx, [cell][8][3]

  /// True if they belong to `at`.
  bool belong_to(const Eigen::Ref<const Eigen::VectorXd>& at) const { return x.size() == at.size() && x == at; }
  /// Computes them at a configuration.
  void update(const ElementSet& elements, const Eigen::Ref<const Eigen::VectorXd>& at);
  /// f += sum_e weight_e g_e.
  void add_gradients(const ElementSet& elements, const Eigen::Ref<const Eigen::VectorXd>& weight,
                     Eigen::Ref<Eigen::VectorXd> f) const;
  /// g_e . dx for every cell.
  void project(const ElementSet& elements, const Eigen::Ref<const Eigen::VectorXd>& dx,
               Eigen::Ref<Eigen::VectorXd> out) const;
};

}  // namespace muldi::fem
