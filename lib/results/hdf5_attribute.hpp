#pragma once
/// Attributes of files, groups and data sets: one number or one text.
#include <optional>
#include <string>

#include "results/hdf5_file.hpp"

namespace muldi::results::hdf5 {

/// The value of an open attribute; nothing where it is of another kind or cannot be read.
std::optional<AttributeValue> read_attribute(const Id& attribute);

/// Makes the attribute `name` of an open object; false if the library fails.
bool write_attribute(const Id& owner, const std::string& name, const AttributeValue& value);

}  // namespace muldi::results::hdf5
