#pragma once
/// When the kept factors of substructures are made anew although the iterations still converge with them.
///
/// A factor grows old with the configuration, and each step takes a little more iterations than the one before. With
/// the cost c of a factor in iterations, k steps cost (c + n_1 + ... + n_k) / k each; that mean falls as long as the
/// next step takes fewer iterations than it, and is smallest where a step takes more.

namespace muldi::variational {

struct FactorUse {
  int steps = 0;        ///< that the factors have served
  int iterations = 0;   ///< of these steps
  bool renews = false;  ///< the next step begins with new factors

  /// Books a step that took so many iterations; `renewed`: with new factors.
  void book(int iterations_of_step, bool renewed);
};

}  // namespace muldi::variational
