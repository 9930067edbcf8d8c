#include "results/hdf5_attribute.hpp"

#include <hdf5.h>

namespace muldi::results::hdf5 {
namespace {

/// The type of every text attribute, made once.
hid_t text_type() {
  static const hid_t type = H5Tcopy(H5T_C_S1);
  static const bool ready = H5Tset_size(type, H5T_VARIABLE) >= 0 && H5Tset_cset(type, H5T_CSET_UTF8) >= 0;
  return ready ? type : H5I_INVALID_HID;
}

}  // namespace

std::optional<AttributeValue> read_attribute(const Id& attribute) {
  const Id type(H5Aget_type(attribute.get()));
  const Id space(H5Aget_space(attribute.get()));
  const auto size = H5Sget_simple_extent_npoints(space.get());
  if (!type.valid() || size != 1) return {};
  const H5T_class_t kind = H5Tget_class(type.get());
  if (kind == H5T_STRING) {
    if (H5Tis_variable_str(type.get()) > 0) {
      char* text = nullptr;
      if (H5Aread(attribute.get(), type.get(), &text) < 0) return {};
      std::string result = text == nullptr ? "" : text;
      H5free_memory(text);
      return result;
    }
    std::string text(H5Tget_size(type.get()), '\0');
    if (H5Aread(attribute.get(), type.get(), text.data()) < 0) return {};
    return text.substr(0, text.find('\0'));
  }
  std::int64_t integer = 0;
  if (kind == H5T_INTEGER && H5Aread(attribute.get(), H5T_NATIVE_INT64, &integer) >= 0) return integer;
  double real = 0.0;
  if (kind == H5T_FLOAT && H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &real) >= 0) return real;
  return {};
}

bool write_attribute(const Id& owner, const std::string& name, const AttributeValue& value) {
  const auto write = [&](hid_t type_on_disk, hid_t type, const void* values) {
    const Id space(H5Screate(H5S_SCALAR));
    const Id id(H5Acreate2(owner.get(), name.c_str(), type_on_disk, space.get(), H5P_DEFAULT, H5P_DEFAULT));
    return id.valid() && H5Awrite(id.get(), type, values) >= 0;
  };
  if (const auto* real = std::get_if<double>(&value)) return write(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, real);
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return write(H5T_STD_I64LE, H5T_NATIVE_INT64, integer);
  const char* text = std::get<std::string>(value).c_str();
  return write(text_type(), text_type(), &text);
}

}  // namespace muldi::results::hdf5
