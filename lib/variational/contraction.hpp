#pragma once
/// How the increments of a Newton iteration with kept factors contract: when they are small enough, when the matrix is
/// too old, when round-off is all that is left.

namespace muldi::variational {

/// Sizes of one increment, each relative to the natural ones of the system.
struct Increment {
  double size = 0.0;    ///< of all unknowns; NaN if one is
  double length = 0.0;  ///< of the positions alone
  double stage = 0.0;   ///< of the stage unknowns alone: potentials, element pressures
};

class Contraction {
 public:
  /// One more increment; `renewed` if the factor of its matrix has just been made. `residual` is relative, before it.
  void take(const Increment& increment, bool renewed, double residual);
  /// What follows has better derivatives than the factor's: the next increment is no witness of its age.
  void count_anew() { since_change_ = 0; }
  /// The last increment is not taken.
  void drop_last() { last_ = previous_; }

  /// Positions have moved by no more than the tolerance, and what is left of the stage unknowns is estimated to be no
  /// more. These are known less well than positions where a step resists by inertia and viscosity, so that another
  /// increment would be asked for by them alone; their increments fall like a geometric series, whose rest counts
  /// (Hairer and Wanner, Solving ordinary differential equations II, IV.8).
  bool is_small(double tolerance) const;
  /// Increments have stopped falling where round-off is all that they hold.
  bool stagnates() const;
  /// The matrix is not that of the present configuration any more.
  bool is_slow(double tolerance) const;
  bool grows() const { return last_.size > previous_.size; }
  /// The last increment is the first that the factor of this very iteration is judged by.
  bool judges_new_factor() const { return is_new_ && since_change_ == 2; }
  double size() const { return last_.size; }

 private:
  Increment last_;
  Increment previous_;
  double residual_ = 0.0;
  int n_increments_ = 0;
  int since_change_ = 0;  // increments with the same factor, or with the exact derivative
  bool is_new_ = false;   // the factor is of this iteration
};

}  // namespace muldi::variational
