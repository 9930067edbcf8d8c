#pragma once
/// A list of types as GoogleTest takes it.
#include <gtest/gtest.h>

#include "base/describe.hpp"

namespace muldi::test {

template <class List>
struct TypesOf;
template <class... Types>
struct TypesOf<base::TypeList<Types...>> {
  using type = testing::Types<Types...>;
};

}  // namespace muldi::test
