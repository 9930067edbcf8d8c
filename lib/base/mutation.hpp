#pragma once
/// Faults that test builds inject to see that the tests find them (numerics 5; tools/mutation). MULDI_MUTATION is
/// defined by no other build: without it every question below is false where it is compiled, and nothing is left of it.

namespace muldi::base {

enum class Mutation {
  none,
  sign_of_displacement,   ///< (a) D enters the charge rows of elements with the wrong sign
  null_space_at_end,      ///< (b) the step projects with T(q_{n+1}) in place of T(q_n)
  constraints_in_middle,  ///< (c) loops act along G(q_{n+1/2}) in place of G(q_n)
  dilatation_in_middle,   ///< (d) mean dilatation of the middle in place of the mean of both ends
  forces_without_half,    ///< (e) the discrete forces f+ and f- without their factor 1/2
  potentials_at_nodes,    ///< (f) potentials at nodes in time, whose mean enters an interval
};

#ifdef MULDI_MUTATION
inline constexpr Mutation mutation = Mutation::MULDI_MUTATION;
#else
inline constexpr Mutation mutation = Mutation::none;
#endif

/// What stands where the factor 1/2 of discrete forces is missing, over what should.
constexpr double times_missing_half() { return mutation == Mutation::forces_without_half ? 2.0 : 1.0; }

/// True in the test builds that inject this fault.
constexpr bool has(Mutation fault) { return mutation == fault; }

}  // namespace muldi::base
