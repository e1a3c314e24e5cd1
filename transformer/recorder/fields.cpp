#include "transformer/recorder/fields.h"

#include "mbd/io/units.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

namespace steplap {

std::string_view trimmed_blanks(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

namespace {

std::string_view unquoted(std::string_view text) {
  text = trimmed_blanks(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') return trimmed_blanks(text.substr(1, text.size() - 2));
  return text;
}

void split_at_blanks(std::string_view line, std::vector<std::string_view>& fields) {
  for (std::size_t i = 0;;) {
    while (i < line.size() && (line[i] == ' ' || line[i] == '\t')) ++i;
    if (i == line.size()) return;
    const std::size_t start = i;
    while (i < line.size() && line[i] != ' ' && line[i] != '\t') ++i;
    fields.push_back(unquoted(line.substr(start, i - start)));
  }
}

} // namespace

bool split_fields(std::string_view line, char delimiter, std::vector<std::string_view>& fields) {
  fields.clear();
  const bool has_quotes = std::memchr(line.data(), '"', line.size()) != nullptr;
  if (delimiter == ' ') {
    split_at_blanks(line, fields);
    return true;
  }
  bool is_quoted = false;
  std::size_t start = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size()) {
      if (has_quotes && line[i] == '"') is_quoted = !is_quoted;
      if (is_quoted || line[i] != delimiter) continue;
    }
    const std::string_view field = line.substr(start, i - start);
    fields.push_back(has_quotes ? unquoted(field) : trimmed_blanks(field));
    start = i + 1;
  }
  return !is_quoted;
}

std::optional<double> parse_number(std::string_view field, char decimal) {
  std::array<char, 64> copy{};
  if (decimal == ',') {
    if (field.size() > copy.size() || field.find('.') != std::string_view::npos) return std::nullopt;
    std::replace_copy(field.begin(), field.end(), copy.begin(), ',', '.');
    field = {copy.data(), field.size()};
  }
  if (field.starts_with('+')) {
    field.remove_prefix(1);
    if (field.starts_with('-')) return std::nullopt;
  }
  double value = 0.0;
  const auto [end, status] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (status != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool is_missing(std::string_view field) {
  if (field.empty()) return true;
  if (field.size() > 9) return false;
  const std::string lower = lower_case(field);
  for (const char* word :
       {"nan", "-nan", "+nan", "n/a", "na", "#n/a", "-", "--", "null", "none", "1.#qnan", "-1.#ind", "1,#qnan", "-1,#ind"})
    if (lower == word) return true;
  return false;
}

bool begins_like_number(std::string_view field) {
  if (field.starts_with('+') || field.starts_with('-')) field.remove_prefix(1);
  if (field.starts_with('.') || field.starts_with(',')) field.remove_prefix(1);
  return !field.empty() && field.front() >= '0' && field.front() <= '9';
}

std::optional<AccelerationUnit> acceleration_unit(std::string_view text) {
  std::string unit(trimmed_blanks(text));
  if (unit.size() >= 2 && (unit.front() == '[' || unit.front() == '(')) unit = unit.substr(1, unit.size() - 2);
  const std::string lower = lower_case(unit);
  for (const char* word : {"g", "gn", "g0", "g_n", "gravity", "gees", "g-force", "g's", "gs"})
    if (lower == word) return AccelerationUnit{"g", k_gravity};
  for (const char* word : {"mg", "milli-g", "millig", "mgn", "mgal*1000"})
    if (lower == word) return AccelerationUnit{"mg", k_gravity / 1000.0};
  // Includes the bytes of "²" in UTF-8 and in Latin-1.
  for (const char* word : {"m/s^2", "m/s2", "m/s**2", "m/s\xC2\xB2", "m/s\xB2", "m/s/s", "m/(s^2)", "m s-2", "m s^-2", "m\xC2\xB7s-2",
                           "ms-2", "ms^-2", "mps2", "m/sec^2", "m/sec2"})
    if (lower == word) return AccelerationUnit{"m/s^2", 1.0};
  for (const char* word : {"mm/s^2", "mm/s2", "mm/s\xC2\xB2"})
    if (lower == word) return AccelerationUnit{"mm/s^2", 0.001};
  for (const char* word : {"count", "counts", "cnt", "cnts", "lsb", "raw", "digit", "digits", "adc"})
    if (lower == word) return AccelerationUnit{"counts", 0.0, true};
  if (unit.empty() || unit.size() > 20) return std::nullopt;
  const Quantity zero = parse_quantity("0 " + unit, "m/s^2"), one = parse_quantity("1 " + unit, "m/s^2");
  if (!one.problem.empty() || zero.value != 0.0 || !(one.value > 0.0)) return std::nullopt;
  return AccelerationUnit{unit, one.value};
}

std::optional<double> time_unit(std::string_view text) {
  std::string lower = lower_case(trimmed_blanks(text));
  if (lower.size() >= 2 && (lower.front() == '[' || lower.front() == '(')) lower = lower.substr(1, lower.size() - 2);
  struct Named {
    const char* name;
    double seconds;
  };
  constexpr Named k_units[] = {{"s", 1.0},       {"sec", 1.0},           {"secs", 1.0},    {"second", 1.0},        {"seconds", 1.0},
                               {"ms", 1e-3},     {"msec", 1e-3},         {"millis", 1e-3}, {"milliseconds", 1e-3}, {"millisecond", 1e-3},
                               {"us", 1e-6},     {"usec", 1e-6},         {"micros", 1e-6}, {"\xC2\xB5s", 1e-6},    {"\xCE\xBCs", 1e-6},
                               {"\xB5s", 1e-6},  {"microseconds", 1e-6}, {"ns", 1e-9},     {"nanos", 1e-9},        {"nanoseconds", 1e-9},
                               {"min", 60.0},    {"minutes", 60.0},      {"h", 3600.0},    {"hours", 3600.0},      {"d", 86400.0},
                               {"day", 86400.0}, {"days", 86400.0}};
  for (const Named& named : k_units)
    if (lower == named.name) return named.seconds;
  return std::nullopt;
}

Heading heading_of(std::string_view field) {
  field = unquoted(field);
  for (const char* pair : {"[]", "()", "{}"}) {
    const auto open = field.rfind(pair[0]), close = field.rfind(pair[1]);
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) continue;
    const std::string_view unit = trimmed_blanks(field.substr(open + 1, close - open - 1));
    if (open > 0) return {std::string(trimmed_blanks(field.substr(0, open))), std::string(unit)};
    return {std::string(trimmed_blanks(field.substr(close + 1))), std::string(unit)};
  }
  // Recognises units in names: "ax_mg", "t_ms", "X, g", "X in g".
  const auto last = field.find_last_of("_, /");
  if (last != std::string_view::npos && last > 0) {
    const std::string_view unit = field.substr(last + 1);
    if (acceleration_unit(unit) || time_unit(unit)) {
      std::string_view name = trimmed_blanks(field.substr(0, last));
      if (name.ends_with(" in")) name.remove_suffix(3);
      while (name.ends_with('_') || name.ends_with(',')) name.remove_suffix(1);
      return {std::string(name), std::string(unit)};
    }
  }
  return {std::string(field), ""};
}

} // namespace steplap
