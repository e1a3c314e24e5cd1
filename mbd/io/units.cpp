#include "mbd/io/units.h"

#include "mbd/base/diagnostics.h"
#include "mbd/formula/unit_dimension.h"
#include "mbd/io/unit_text.h"

#include <udunits2.h>

#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <unordered_map>

namespace steplap {

namespace {

struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
struct FreeConverter {
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
struct FreeSystem {
  void operator()(ut_system* system) const { ut_free_system(system); }
};
using UnitPtr = std::unique_ptr<ut_unit, FreeUnit>;
using ConverterPtr = std::unique_ptr<cv_converter, FreeConverter>;

// A unit decomposed into base units: their product, and their exponents by name.
struct BaseForm {
  UnitPtr product;
  std::map<std::string, int> powers; // without the radian
  int radian_power = 0;
};

struct Conversion {
  ConverterPtr converter; // null: see problem
  double factor = 1.0;    // applied after the converter
  std::string problem;
};

ut_status visit_basic(const ut_unit* unit, void* out) {
  auto& form = *static_cast<BaseForm*>(out);
  form.product.reset(ut_clone(unit));
  const char* name = ut_get_name(unit, UT_ASCII);
  const std::string text = name ? name : "?";
  if (text == "radian") form.radian_power = 1;
  else form.powers[text] = 1;
  return UT_SUCCESS;
}

ut_status visit_product(const ut_unit*, int count, const ut_unit* const* units, const int* powers, void* out) {
  auto& form = *static_cast<BaseForm*>(out);
  for (int i = 0; i < count; ++i) {
    if (powers[i] == 0) continue;
    const UnitPtr power(ut_raise(units[i], powers[i]));
    form.product.reset(form.product ? ut_multiply(form.product.get(), power.get()) : ut_clone(power.get()));
    const char* name = ut_get_name(units[i], UT_ASCII);
    const std::string text = name ? name : "?";
    if (text == "radian") form.radian_power = powers[i];
    else form.powers[text] = powers[i];
  }
  return UT_SUCCESS;
}

ut_status visit_galilean(const ut_unit*, double, const ut_unit* underlying, double, void* out);
ut_status visit_timestamp(const ut_unit*, const ut_unit*, double, void*) { return UT_BAD_ARG; }
ut_status visit_logarithmic(const ut_unit*, double, const ut_unit*, void*) { return UT_BAD_ARG; }

const ut_visitor k_visitor{visit_basic, visit_product, visit_galilean, visit_timestamp, visit_logarithmic};

ut_status visit_galilean(const ut_unit*, double, const ut_unit* underlying, double, void* out) {
  return ut_accept_visitor(underlying, &k_visitor, out);
}

// A common unit that the database lacks or interprets differently, with its meaning.
struct CommonUnit {
  const char* name;
  const char* meaning;
  bool takes_prefix; ///< prefixes are allowed: "kNm"
};
constexpr CommonUnit k_spoken_units[] = {{"deg", "degree", false},     {"rev", "2 PI radian", false}, {"mph", "mile/hour", false},
                                         {"Nm", "newton metre", true}, {"Ns", "newton second", true}, {"Nms", "newton metre second", true}};

class UnitSystem {
public:
  UnitSystem() {
    ut_set_error_message_handler(ut_ignore);
    system_.reset(ut_read_xml(nullptr));
    if (!system_) throw ModelError(Location{}, "the unit database of UDUNITS-2 was not found");
    for (const CommonUnit& spoken : k_spoken_units) {
      const UnitPtr unit(ut_parse(system_.get(), spoken.meaning, UT_ASCII));
      if (!unit) continue;
      if (spoken.takes_prefix) ut_map_symbol_to_unit(spoken.name, UT_ASCII, unit.get());
      else ut_map_name_to_unit(spoken.name, UT_ASCII, unit.get());
    }
  }

  UnitPtr parse(const std::string& text) const {
    if (!unit_text_problem(text).empty()) return nullptr;
    return UnitPtr(ut_parse(system_.get(), text.c_str(), UT_UTF8));
  }

  const Conversion& conversion(const std::string& given, const std::string& wanted) {
    Conversion& c = cache_[given + '\n' + wanted];
    if (!c.converter && c.problem.empty()) c = make_conversion(given, wanted);
    return c;
  }

  std::optional<std::array<double, 3>> powers(const std::string& given) const;

private:
  Conversion make_conversion(const std::string& given, const std::string& wanted) const;
  std::string unknown_unit(const std::string& given, const std::string& wanted) const;

  std::unique_ptr<ut_system, FreeSystem> system_;
  std::unordered_map<std::string, Conversion> cache_;
};

bool names_hertz(const std::string& unit) { return unit.find("Hz") != std::string::npos || unit.find("hertz") != std::string::npos; }

// "1/min" as an angular velocity may count turns as "Hz" does; "1/s" is accepted, because formulas give angular velocities in it.
bool is_rate(const BaseForm& form) { return form.powers.size() == 1 && form.powers.contains("second"); }
bool is_one(const cv_converter& converter) { return cv_convert_double(&converter, 1.0) == 1.0; }

Conversion failed(std::string problem) { return {nullptr, 1.0, std::move(problem)}; }

Conversion UnitSystem::make_conversion(const std::string& given, const std::string& wanted) const {
  if (given == "g" && (wanted == "*" || wanted == "m/s^2"))
    return failed("is in grams: write 'gravity' for the acceleration, or 'kg' for a mass");
  const UnitPtr from = parse(given);
  BaseForm form;
  if (!from || ut_accept_visitor(from.get(), &k_visitor, &form) != UT_SUCCESS) return failed(unknown_unit(given, wanted));
  if (!form.product) form.product.reset(ut_get_dimensionless_unit_one(system_.get()));
  if (wanted == "*") return {ConverterPtr(ut_get_converter(from.get(), form.product.get())), 1.0, ""};
  const UnitPtr to(ut_parse(system_.get(), wanted.c_str(), UT_UTF8));
  BaseForm target;
  if (!to || ut_accept_visitor(to.get(), &k_visitor, &target) != UT_SUCCESS)
    return failed("a field is kept in the unknown unit '" + wanted + "'");
  if (form.powers != target.powers)
    return failed(wanted.empty() ? "has the unit '" + given + "', but the value has no dimension"
                                 : "has the unit '" + given + "', but a unit like '" + wanted + "' is needed");
  ConverterPtr converter(ut_get_converter(from.get(), to.get()));
  if (target.radian_power != 0 && form.radian_power == 0 && (names_hertz(given) || (is_rate(target) && !is_one(*converter))))
    return failed("is a frequency, but an angular velocity is needed: write 'rad/s', or 'rpm' for "
                  "turns per minute");
  const bool turns = wanted == "Hz" && form.radian_power == 1;
  return {std::move(converter), turns ? 0.5 / std::numbers::pi : 1.0, ""};
}

// Returns a message about an unknown unit, with a suggestion if a product was probably meant: "N m" for "Nm".
std::string UnitSystem::unknown_unit(const std::string& given, const std::string& wanted) const {
  std::string text = "has the unknown unit '" + given + "'";
  const bool may_be_product = given.find(' ') == std::string::npos && given.size() < 12;
  for (std::size_t i = 1; may_be_product && i < given.size(); ++i) {
    const std::string product = given.substr(0, i) + " " + given.substr(i);
    if (parse(given.substr(0, i)) && parse(product) && make_conversion(product, wanted).converter)
      return text + " (did you mean '" + product + "'?)";
  }
  return text;
}

// Returns the exponents of kg, m and s; nothing for an unknown unit or one with other base units.
std::optional<std::array<double, 3>> UnitSystem::powers(const std::string& given) const {
  const UnitPtr unit = parse(given);
  BaseForm form;
  if (!unit || ut_accept_visitor(unit.get(), &k_visitor, &form) != UT_SUCCESS) return std::nullopt;
  std::array<double, 3> powers{};
  for (const auto& [name, power] : form.powers) {
    const std::size_t k = name == "kilogram" ? 0 : name == "meter" ? 1 : name == "second" ? 2 : 3;
    if (k == 3) return std::nullopt;
    powers[k] = power;
  }
  return powers;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::string example(const std::string& unit) { return unit.empty() || unit == "*" ? "'0.5'" : "'0.5 " + unit + "'"; }

// Conversion of a frequent unit without the database, since reading the database takes longer than the rest of the program's start. The
// results are bit-identical to those of the database, as a test checks.
struct FrequentUnit {
  const char* given;
  const char* wanted;
  double factor;
};
constexpr FrequentUnit k_usual_units[] = {{"mm", "m", 0.001},
                                          {"m", "m", 1.0},
                                          {"cm", "m", 0.01},
                                          {"t", "kg", 1000.0},
                                          {"kg", "kg", 1.0},
                                          {"s", "s", 1.0},
                                          {"ms", "s", 0.001},
                                          {"km/h", "m/s", 1000.0 / 3600.0},
                                          {"m/s", "m/s", 1.0},
                                          {"gravity", "m/s^2", 9.80665},
                                          {"N", "N", 1.0},
                                          {"kN", "N", 1000.0},
                                          {"MN", "N", 1e6},
                                          {"N/m", "N/m", 1.0},
                                          {"kN/m", "N/m", 1000.0},
                                          {"MN/m", "N/m", 1e6},
                                          {"GN/m", "N/m", 1e9},
                                          {"N s/m", "N s/m", 1.0},
                                          {"kN s/m", "N s/m", 1000.0},
                                          {"MPa", "Pa", 1e6},
                                          {"kPa", "Pa", 1000.0},
                                          {"Pa", "Pa", 1.0},
                                          {"rad/s", "rad/s", 1.0},
                                          {"Hz", "Hz", 1.0},
                                          {"gravity", "*", 9.80665},
                                          {"m/s^2", "*", 1.0},
                                          {"m/s", "*", 1.0},
                                          {"km/h", "*", 1000.0 / 3600.0},
                                          {"mm", "*", 0.001},
                                          {"m", "*", 1.0},
                                          {"kN", "*", 1000.0},
                                          {"N", "*", 1.0}};

const FrequentUnit* find_usual(const std::string& given, const std::string& wanted) {
  for (const FrequentUnit& usual : k_usual_units)
    if (given == usual.given && wanted == usual.wanted) return &usual;
  return nullptr;
}

Quantity without_unit(double value, const std::string& text, const std::string& unit) {
  if (unit.empty() || unit == "*") return {value, ""};
  return {0.0, "'" + text + "' names no unit: write " + text + " without quotes for " + unit + ", or add a unit"};
}

} // namespace

namespace {

// Returns the UDUNITS database, which is read at the first call. Not thread-safe.
UnitSystem& unit_system() {
  static UnitSystem system;
  return system;
}
std::mutex& unit_system_mutex() {
  static std::mutex mutex;
  return mutex;
}

} // namespace

std::optional<std::array<double, 3>> powers_in(const std::string& original) {
  const std::string text = trimmed(original);
  const char* begin = text.c_str() + (text.rfind('+', 0) == 0 ? 1 : 0);
  const char* end = text.c_str() + text.size();
  double number = 0.0;
  const auto [rest, status] = std::from_chars(begin, end, number);
  if (status != std::errc()) return std::nullopt;
  const std::string given = trimmed(std::string(rest, end));
  if (given.empty()) return std::array<double, 3>{};
  if (!unit_text_problem(given).empty()) return std::nullopt;
  const std::lock_guard lock(unit_system_mutex());
  if (const auto powers = unit_system().powers(given)) return powers;
  const std::optional<UnitDimension> counted = dimension_of(given); // amperes and kelvins count as numbers
  return counted ? std::optional(counted->powers) : std::nullopt;
}

std::vector<std::pair<std::string, std::string>> usual_units() {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const FrequentUnit& usual : k_usual_units) pairs.emplace_back(usual.given, usual.wanted);
  return pairs;
}

Quantity parse_quantity(const std::string& original, const std::string& unit, UnitSource source) {
  const std::string text = trimmed(original);
  const char* begin = text.c_str() + (text.rfind('+', 0) == 0 ? 1 : 0);
  const char* end = text.c_str() + text.size();
  double number = 0.0;
  const auto [rest, status] = std::from_chars(begin, end, number);
  if (status != std::errc()) return {0.0, "'" + text + "' is not a number with a unit, such as " + example(unit)};
  if (rest != end && *rest == ',') return {0.0, "'" + text + "': the decimal sign is a point, as in " + example(unit)};
  if (!std::isfinite(number)) return {0.0, "'" + text + "' is not finite"};
  const std::string given = trimmed(std::string(rest, end));
  if (given.empty()) return without_unit(number, text, unit);

  if (const FrequentUnit* usual = source == UnitSource::usual_first ? find_usual(given, unit) : nullptr) {
    const double value = usual->factor * number;
    return std::isfinite(value) ? Quantity{value, ""} : Quantity{0.0, "'" + text + "' is not finite"};
  }
  if (const std::string problem = unit_text_problem(given); !problem.empty()) return {0.0, "'" + text + "' " + problem};
  const std::lock_guard lock(unit_system_mutex());
  const Conversion& conversion = unit_system().conversion(given, unit);
  if (!conversion.problem.empty()) return {0.0, "'" + text + "' " + conversion.problem};
  const double value = conversion.factor * cv_convert_double(conversion.converter.get(), number);
  if (!std::isfinite(value)) return {0.0, "'" + text + "' is not finite"};
  return {value, ""};
}

} // namespace steplap
