/// Tables of numbers; the first byte chooses the column.
#include <cmath>
#include <cstdlib>

#include "fuzz/target.hpp"
#include "scene/csv.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace muldi;
  if (size == 0) return 0;
  const scene::CsvColumns read = scene::read_csv(fuzz::as_text(bytes, size).substr(1), 1 + bytes[0] % 8);
  if (read.first.size() != read.other.size() || read.first.size() != read.lines.size()) std::abort();
  for (std::size_t i = 0; i < read.first.size(); ++i) {
    if (!std::isfinite(read.first[i]) || !std::isfinite(read.other[i])) std::abort();
  }
  return 0;
}
