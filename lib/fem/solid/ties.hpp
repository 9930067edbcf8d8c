#pragma once
/// Nodes of a solid that follow rigid bodies through a constant linear map (numerics 1.9, 5.26): x = A q with the rows
/// phi + xi_1 d1 + xi_2 d2 + xi_3 d3.
#include <Eigen/Core>
#include <array>

#include "fem/solid/tie_weights.hpp"

namespace muldi::fem {

/// Entries of a body in q: phi, d1, d2, d3.
inline constexpr int host_size = 12;

class Ties {
 public:
  /// `data` must outlive the object.
  explicit Ties(const SolidDescription& data) : data_(&data), weights_(data) {}

  bool empty() const { return data_->ties.empty(); }
  int n_hosts() const { return empty() ? 0 : static_cast<int>(data_->hosts.size()); }
  /// Columns of A, twelve a host.
  int n_columns() const { return host_size * n_hosts(); }
  /// Writes A q to the tied nodes of a solid whose slice begins at `first`: positions, velocities, increments (n_q).
  void follow(Eigen::Index first, Eigen::VectorXd& q) const;
  /// rows of the bodies += A^T rows of the tied nodes, which keep their values (n_q).
  void gather(Eigen::Index first, Eigen::VectorXd& rows) const;
  /// Adds factor times the motion of the bodies as the nodes share it, by TieWeights: `motion` holds changes of phi,
  /// d1, d2, d3 in the entries of the bodies, and a node moves with a body as if it were fixed to it at the
  /// configuration q (all n_q).
  void add_shared(Eigen::Index first, const Eigen::VectorXd& q, const Eigen::VectorXd& motion, double factor,
                  Eigen::Ref<Eigen::VectorXd> positions) const;
  /// Calls use(node, component, value) for the entries of a column of A.
  template <class Use>
  void each_entry(int column, const Use& use) const {
    const int local = column % host_size;
    for (const Tie& tie : data_->ties) {
      if (tie.host == column / host_size) use(tie.node, local % 3, weights(tie)[static_cast<std::size_t>(local / 3)]);
    }
  }

 private:
  static std::array<double, 4> weights(const Tie& tie) { return {1.0, tie.xi[0], tie.xi[1], tie.xi[2]}; }

  const SolidDescription* data_;
  TieWeights weights_;
};

}  // namespace muldi::fem
