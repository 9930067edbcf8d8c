#pragma once
/// Places of the unknowns of a discrete optimal control problem.
///
/// Node by node: coordinates theta_n, then for n < N the controls w_n, then the multipliers mu_n of the loops where
/// node n has a balance of momentum; at the end the step, the end motions and whatever objectives need.
#include <array>
#include <vector>

namespace muldi::control {

/// Unknowns and rows of a motion at an end: rates omega and momenta m = D^T M D omega (n_v each).
struct EndMotion {
  int rates = -1;    ///< first unknown of omega
  int momenta = -1;  ///< first unknown of m

  bool exists() const { return rates >= 0; }
};

struct Layout {
  int n_steps = 0;
  int n_v = 0;
  int n_u = 0;                           ///< controls that are sought
  int n_c = 0;                           ///< rank of the loops
  std::array<bool, 2> balance_at_end{};  ///< whether the first and the last node have a balance of momentum

  std::vector<int> first_theta = {};   ///< of every node
  std::vector<int> first_lambda = {};  ///< of every node; -1 without
  int step = -1;                       ///< the step, where free
  std::array<EndMotion, 2> motion{};
  int equilibrium_lambda = -1;  ///< loop multipliers of the final equilibrium
  int peak = -1;
  int n = 0;

  int theta(int node, int k) const { return first_theta[static_cast<std::size_t>(node)] + k; }
  int w(int interval, int c) const { return theta(interval, n_v) + c; }
  int lambda(int node, int i) const {
    const int first = first_lambda[static_cast<std::size_t>(node)];
    return first < 0 ? -1 : first + i;
  }
  bool has_balance(int node) const {
    return node == 0 ? balance_at_end[0] : node == n_steps ? balance_at_end[1] : true;
  }

  /// Places thetas, controls and loop multipliers; what comes after them is appended with `append`.
  void place_nodes() {
    n = 0;
    first_theta.clear();
    first_lambda.clear();
    for (int node = 0; node <= n_steps; ++node) {
      first_theta.push_back(append(n_v));
      if (node < n_steps) append(n_u);
      first_lambda.push_back(n_c > 0 && has_balance(node) ? append(n_c) : -1);
    }
  }
  int append(int count) {
    const int first = n;
    n += count;
    return first;
  }
};

}  // namespace muldi::control
