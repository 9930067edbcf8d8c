#pragma once
/// Lets Eigen's small vectors and matrices hold jets.
#include <Eigen/Core>

#include "math/jet.hpp"

namespace Eigen {

template <class J>
struct MuldiJetTraits : NumTraits<double> {
  using Real = J;
  using NonInteger = J;
  using Nested = J;
  using Literal = double;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 8,
    AddCost = 16,
    MulCost = 32
  };
};
template <class S>
struct NumTraits<muldi::math::Dual<S>> : MuldiJetTraits<muldi::math::Dual<S>> {};
template <int N, class S>
struct NumTraits<muldi::math::Jet2<N, S>> : MuldiJetTraits<muldi::math::Jet2<N, S>> {};

// Products and sums with plain numbers.
template <muldi::math::Jet J, class BinaryOp>
struct ScalarBinaryOpTraits<J, double, BinaryOp> {
  using ReturnType = J;
};
template <muldi::math::Jet J, class BinaryOp>
struct ScalarBinaryOpTraits<double, J, BinaryOp> {
  using ReturnType = J;
};

}  // namespace Eigen
