#include "elements/action_value.h"

#include "mbd/base/number_text.h"
#include "mbd/io/units.h"
#include "mbd/model/field_units.h"

#include <charconv>
#include <cmath>
#include <stdexcept>

namespace steplap {

namespace {

class ValueReader {
public:
  ValueReader(const ActionStepText& step, const Field& field, const ElementEntry& entry)
      : step_(step), field_(field), unit_(unit_in(entry.kind->fields, field, entry.element.get())),
        unit2_(field.unit2.empty() ? unit_ : field.unit2) {}

  [[nodiscard]] FieldValue value() const {
    switch (field_.type) {
    case FieldType::vec2: return point(step_.value, unit_, unit_);
    case FieldType::numbers: {
      std::vector<double> numbers;
      for (const std::string& item : items(step_.value)) numbers.push_back(number(item, unit_));
      return numbers;
    }
    case FieldType::points: {
      std::vector<Vec2> points;
      for (const std::string& item : items(step_.value)) points.push_back(point(item, unit_, unit2_));
      return points;
    }
    default: return number(step_.value, unit_);
    }
  }

private:
  [[nodiscard]] std::string subject() const { return "'" + step_.name + "." + step_.field + "'"; }

  [[nodiscard]] static std::string trimmed(const std::string& text) {
    const std::size_t first = text.find_first_not_of(' ');
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
  }

  [[noreturn]] void fail_as_list() const {
    const std::string example = field_.type == FieldType::points ? "[[0, 0], [1, 2]]" : "[1, 2]";
    throw std::invalid_argument(subject() + " cannot be '" + step_.value + "': write a list, as " + example);
  }

  // Of "[a, [b, c], d]": "a", "[b, c]", "d". A comma behind the last one may stand there.
  [[nodiscard]] std::vector<std::string> items(const std::string& text) const {
    const std::string whole = trimmed(text);
    if (whole.size() < 2 || whole.front() != '[' || whole.back() != ']') fail_as_list();
    std::vector<std::string> found{""};
    int depth = 0;
    for (const char c : whole.substr(1, whole.size() - 2)) {
      depth += c == '[' ? 1 : c == ']' ? -1 : 0;
      if (depth < 0) fail_as_list();
      if (c == ',' && depth == 0) found.emplace_back();
      else found.back() += c;
    }
    if (depth != 0) fail_as_list();
    if (trimmed(found.back()).empty()) found.pop_back();
    return found;
  }

  [[nodiscard]] Vec2 point(const std::string& text, const std::string& unit, const std::string& unit2) const {
    const std::vector<std::string> parts = items(text);
    if (parts.size() != 2) fail_as_list();
    const double x = number(parts[0], unit), y = number(parts[1], unit2);
    return {x, y};
  }

  [[nodiscard]] double number(const std::string& text, const std::string& unit) const {
    std::string written = trimmed(text);
    const bool is_quoted = written.size() > 1 && (written.front() == '\'' || written.front() == '"') && written.back() == written.front();
    if (is_quoted) written = trimmed(written.substr(1, written.size() - 2));
    double plain = 0.0; // SI, as a number of a file is
    const char *const begin = written.data(), *const end = begin + written.size();
    if (const auto read = std::from_chars(begin, end, plain); read.ec == std::errc() && read.ptr == end) return checked(plain, written);
    const Quantity quantity = parse_quantity(written, unit);
    if (!quantity.problem.empty()) throw std::invalid_argument(subject() + ": " + quantity.problem);
    return checked(quantity.value, written);
  }

  [[nodiscard]] double checked(double value, const std::string& written) const {
    const bool is_low = value < field_.minimum || (field_.is_minimum_excluded && value <= field_.minimum);
    if (is_low || value > field_.maximum || !std::isfinite(value))
      throw std::invalid_argument(subject() + " cannot be " + written + ": it is " +
                                  (is_low ? (field_.is_minimum_excluded ? "larger than " : "at least ") + number_text(field_.minimum)
                                          : "at most " + number_text(field_.maximum)));
    return value;
  }

  const ActionStepText& step_;
  const Field& field_;
  std::string unit_, unit2_;
};

} // namespace

bool can_be_set(const Field& field) {
  return field.type == FieldType::number || field.type == FieldType::vec2 || field.type == FieldType::numbers ||
         field.type == FieldType::points;
}

FieldValue action_value(const ActionStepText& step, const Field& field, const ElementEntry& entry) {
  return ValueReader(step, field, entry).value();
}

} // namespace steplap
