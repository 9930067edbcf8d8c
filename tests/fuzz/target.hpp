#pragma once
/// What every fuzz target defines, for libFuzzer and for replay.cpp.
#include <cstddef>
#include <cstdint>
#include <string_view>

/// Reads one hostile input; an input may be refused by base::InputError. All else that is thrown, and any broken
/// promise, is a fault.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);

namespace muldi::fuzz {

inline std::string_view as_text(const std::uint8_t* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace muldi::fuzz
