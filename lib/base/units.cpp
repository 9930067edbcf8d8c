#include "base/units.hpp"

#include <udunits2.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <utility>

#include "base/error.hpp"
#include "base/log.hpp"
#include "base/text.hpp"

namespace muldi::base {
namespace {

struct UnitFree {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
using UnitHandle = std::unique_ptr<ut_unit, UnitFree>;

constexpr int n_bases = 5;
constexpr std::array<const char*, n_bases> base_symbols{"m", "kg", "s", "A", "rad"};

struct Definition {
  const char* symbol;
  double factor;
  const char* of;
};
constexpr double pi = 3.14159265358979323846;
/// In order: each may use those before it.
constexpr Definition definitions[] = {
    {"g", 1e-3, "kg"},     {"t", 1e3, "kg"},         {"l", 1e-3, "m3"},      {"min", 60.0, "s"},
    {"h", 3600.0, "s"},    {"deg", pi / 180, "rad"}, {"rev", 2 * pi, "rad"}, {"rpm", 1.0, "rev/min"},
    {"Hz", 1.0, "1/s"},    {"N", 1.0, "kg m/s2"},    {"Pa", 1.0, "N/m2"},    {"bar", 1e5, "Pa"},
    {"J", 1.0, "N m"},     {"W", 1.0, "J/s"},        {"C", 1.0, "A s"},      {"V", 1.0, "W/A"},
    {"F", 1.0, "C/V"},     {"Ohm", 1.0, "V/A"},      {"S", 1.0, "A/V"},      {"H", 1.0, "V s/A"},
    {"T", 1.0, "V s/m2"},  {"meter", 1.0, "m"},      {"gram", 1.0, "g"},     {"second", 1.0, "s"},
    {"ampere", 1.0, "A"},  {"radian", 1.0, "rad"},   {"degree", 1.0, "deg"}, {"newton", 1.0, "N"},
    {"pascal", 1.0, "Pa"}, {"joule", 1.0, "J"},      {"watt", 1.0, "W"},     {"volt", 1.0, "V"},
    {"ohm", 1.0, "Ohm"},   {"hertz", 1.0, "Hz"},
};
struct Prefix {
  const char* symbol;
  double factor;
};
constexpr Prefix prefixes[] = {{"a", 1e-18}, {"f", 1e-15}, {"p", 1e-12}, {"n", 1e-9}, {"u", 1e-6},
                               {"m", 1e-3},  {"c", 1e-2},  {"d", 1e-1},  {"h", 1e2},  {"k", 1e3},
                               {"M", 1e6},   {"G", 1e9},   {"T", 1e12}};

/// The UDUNITS-2 system of this program and what it has read so far.
class Units {
 public:
  Units() {
    log_debug("a text with a unit: making the unit system");
    ut_set_error_message_handler(ut_ignore);
    system_ = ut_new_system();
    MULDI_EXPECT(system_ != nullptr, "UDUNITS-2 makes a unit system");
    for (const char* symbol : base_symbols) {
      const UnitHandle unit(ut_new_base_unit(system_));
      ut_map_symbol_to_unit(symbol, UT_ASCII, unit.get());
      ut_map_unit_to_symbol(unit.get(), symbol, UT_ASCII);
    }
    for (const Prefix& prefix : prefixes) ut_add_symbol_prefix(system_, prefix.symbol, prefix.factor);
    for (const Definition& definition : definitions) {
      const UnitHandle of(ut_parse(system_, definition.of, UT_ASCII));
      const UnitHandle unit(ut_scale(definition.factor, of.get()));
      ut_map_symbol_to_unit(definition.symbol, UT_ASCII, unit.get());
    }
  }
  Units(const Units&) = delete;
  Units& operator=(const Units&) = delete;

  std::optional<Unit> parse(std::string_view text) {
    const std::lock_guard lock(mutex_);
    std::string key(text);
    const auto found = read_.find(key);
    if (found != read_.end()) return found->second;
    const UnitHandle handle(ut_parse(system_, key.c_str(), UT_ASCII));
    std::optional<Unit> unit;
    if (handle != nullptr) unit = reduced(handle.get());
    return read_.emplace(std::move(key), unit).first->second;
  }

 private:
  /// A unit walked down to its base units.
  struct Walk {
    Unit unit;
    bool plain = true;  ///< neither an offset nor a logarithm
  };

  static ut_status take_basic(const ut_unit* unit, void* walk) {
    const int one = 1;
    return take_product(nullptr, 1, &unit, &one, walk);
  }
  static ut_status take_product(const ut_unit*, int count, const ut_unit* const* bases, const int* powers, void* walk) {
    Dimension& dimension = static_cast<Walk*>(walk)->unit.dimension;
    int* const exponents[n_bases] = {&dimension.length, &dimension.mass, &dimension.time, &dimension.current,
                                     &dimension.angle};
    for (int i = 0; i < count; ++i) {
      const char* symbol = ut_get_symbol(bases[i], UT_ASCII);
      for (int b = 0; b < n_bases; ++b) {
        if (symbol != nullptr && std::strcmp(symbol, base_symbols[b]) == 0) *exponents[b] += powers[i];
      }
    }
    return UT_SUCCESS;
  }
  static ut_status take_scaled(const ut_unit*, double scale, const ut_unit* of, double offset, void* walk) {
    Walk& w = *static_cast<Walk*>(walk);
    w.unit.si *= scale;
    if (offset != 0.0) w.plain = false;
    return ut_accept_visitor(of, &visitor, walk);
  }
  static ut_status refuse_time(const ut_unit*, const ut_unit*, double, void* walk) {
    static_cast<Walk*>(walk)->plain = false;
    return UT_SUCCESS;
  }
  static ut_status refuse_logarithm(const ut_unit*, double, const ut_unit*, void* walk) {
    static_cast<Walk*>(walk)->plain = false;
    return UT_SUCCESS;
  }
  static constexpr ut_visitor visitor{take_basic, take_product, take_scaled, refuse_time, refuse_logarithm};

  static std::optional<Unit> reduced(const ut_unit* unit) {
    Walk walk;
    const ut_status status = ut_accept_visitor(unit, &visitor, &walk);
    const bool good = status == UT_SUCCESS && walk.plain && std::isfinite(walk.unit.si) && walk.unit.si > 0.0;
    return good ? std::optional<Unit>(walk.unit) : std::nullopt;
  }

  ut_system* system_ = nullptr;  // lives as long as the program
  std::mutex mutex_;
  std::unordered_map<std::string, std::optional<Unit>> read_;
};

/// factor x number; a factor within round-off of a power of ten is taken as this power, so that "1 s" is 1000 ms
/// exactly.
double scaled(double number, double factor) {
  const double exponent = std::round(std::log10(factor));
  const double largest_exact = 22.0;  // 10^22 is the last power of ten that a double holds exactly
  if (std::abs(exponent) > largest_exact) return number * factor;
  double power = 1.0;
  for (int i = 0; i < static_cast<int>(std::abs(exponent)); ++i) power *= 10.0;
  const double exact = exponent < 0 ? 1.0 / power : power;
  if (std::abs(factor / exact - 1.0) > 1e-12) return number * factor;
  return exponent < 0 ? number / power : number * power;
}

}  // namespace

std::optional<Unit> parse_unit(std::string_view text) {
  text = trimmed(text);
  const bool starts_well = !text.empty() && (std::isalpha(static_cast<unsigned char>(text.front())) != 0 ||
                                             text.front() == '(' || text.substr(0, 2) == "1/");
  // '@' and words such as "since" shift the origin; the reduced form tells them. Other bytes end the parse.
  if (!starts_well) return {};
  static Units units;
  return units.parse(text);
}

UnitSystem UnitSystem::make(std::string_view length, std::string_view mass, std::string_view time,
                            std::string_view current, std::string& error) {
  const std::string_view names[4] = {length, mass, time, current};
  const Dimension dimensions[4] = {dimension::length, dimension::mass, dimension::time, dimension::current};
  UnitSystem system;
  for (int i = 0; i < 4; ++i) {
    if (system.names_[i] == names[i]) continue;
    const std::optional<Unit> unit = parse_unit(names[i]);
    if (!unit || unit->dimension != dimensions[i]) {
      error = in_quotes(names[i]) + " is no unit of " + dimension_name(dimensions[i]);
      return {};
    }
    system.names_[i] = names[i];
    system.si_[i] = unit->si;
  }
  return system;
}

double UnitSystem::si(Dimension dimension) const {
  const int exponents[4] = {dimension.length, dimension.mass, dimension.time, dimension.current};
  double value = 1.0;
  for (int i = 0; i < 4; ++i) value *= std::pow(si_[i], exponents[i]);
  return value;
}

double UnitSystem::from(double number, Unit unit) const { return scaled(number, unit.si / si(unit.dimension)); }

double UnitSystem::eps0() const { return from(8.8542e-12, {.si = 1.0, .dimension = dimension::permittivity}); }

QuantityResult parse_quantity(std::string_view text, Dimension dimension, const UnitSystem& system) {
  std::string_view rest = trimmed(text);
  const std::optional<double> whole = parse_number(rest);
  const std::optional<double> number = whole ? whole : take_number(rest);
  if (!number) return {.error = "needs a number, got " + in_quotes(text)};
  if (!std::isfinite(*number)) return {.error = "needs a finite number, got " + in_quotes(text)};
  if (whole) return {.value = *whole};
  const std::string_view name = trimmed(rest);
  const std::optional<Unit> unit = parse_unit(name);
  if (!unit) return {.error = "unknown unit " + in_quotes(name) + " in " + in_quotes(text)};
  Dimension without_angle = dimension;
  without_angle.angle = 0;
  const bool fits = unit->dimension == dimension || unit->dimension == without_angle;
  const std::string needs = dimension == dimension::none
                                ? "needs a number without unit"
                                : "needs " + dimension_name(dimension) + " (" + system.unit_name(dimension) + ")";
  if (!fits) return {.error = needs + ", got " + in_quotes(text) + " (" + dimension_name(unit->dimension) + ")"};
  if (dimension.angle != 0 && unit->dimension.angle == 0 && name.find("Hz") != name.npos) {
    return {.error = needs + ", got " + in_quotes(text) + ": write rev/s or rad/s"};
  }
  const double value = system.from(*number, *unit);
  if (!std::isfinite(value)) return {.error = "is too large: " + in_quotes(text)};
  return {.value = value};
}

}  // namespace muldi::base
