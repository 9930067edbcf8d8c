#pragma once
/// The joint types that scenes may name; the reader, the schema, the documentation and the tests follow this list.
#include "base/describe.hpp"
#include "multibody/joints/cylindrical.hpp"
#include "multibody/joints/fixed.hpp"
#include "multibody/joints/free.hpp"
#include "multibody/joints/planar.hpp"
#include "multibody/joints/prismatic.hpp"
#include "multibody/joints/revolute.hpp"
#include "multibody/joints/spherical.hpp"
#include "multibody/joints/universal.hpp"

namespace muldi::multibody {

using JointTypes = base::TypeList<Fixed, Spherical, Revolute, Cylindrical, Prismatic, Planar, Universal, Free>;

/// One joint type with what the scene says of it.
using JointType = base::VariantOf<JointTypes>;

}  // namespace muldi::multibody
