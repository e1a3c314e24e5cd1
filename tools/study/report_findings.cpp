#include "tools/study/report_findings.h"

#include "mbd/run/quantity_text.h"
#include "tools/study/kinds.h"

#include <charconv>
#include <cmath>

namespace steplap::study {

namespace {

const ReportColumn* find_column(const std::vector<ReportColumn>& columns, const std::string& name) {
  for (const ReportColumn& c : columns)
    if (c.name == name) return &c;
  return nullptr;
}

std::string unit_of(const std::vector<ReportColumn>& columns, const std::string& name) {
  const ReportColumn* column = find_column(columns, name);
  return column ? column->unit : "";
}

// Returns the number after `noun` in a subject: 2 in "design point 2"; 0 if the subject does not begin with the noun.
long place_in(const std::string& subject, const std::string& noun) {
  long place = 0;
  if (subject.starts_with(noun + " ")) std::from_chars(subject.data() + noun.size() + 1, subject.data() + subject.size(), place);
  return place;
}

std::string quotient(const std::string& above, const std::string& below) {
  if (below.empty()) return above;
  return (above.empty() ? "1" : above) + "/" +
         (below.find(' ') == std::string::npos && below.find('/') == std::string::npos ? below : "(" + below + ")");
}

// Returns true if the quantity of a finding matches the text of a part, which is a prefix or, if it begins with a blank, a suffix.
bool is_of(const Finding& f, const FindingPart& part) {
  return part.quantity.front() == ' ' ? f.quantity.ends_with(part.quantity) : f.quantity.starts_with(part.quantity);
}

// Finds the presentation of a finding and its SI unit. Searches all study kinds, because a quantity has the same meaning in each.
void find_part(const Finding& f, const std::vector<ReportColumn>& columns, FindingView& view, int& digits) {
  const ReportColumn* column = find_column(columns, f.quantity);
  const bool is_coordinate = column && column->role == "variable"; // a response may have the name of a quantity
  for (const StudyKind& kind : study_kinds())
    for (const PointRole& point : kind.points) {
      if (!is_coordinate || f.method != point.method) continue;
      view.role = point.role;
      view.variable = f.quantity;
      view.unit = column->unit;
      return;
    }
  for (const StudyKind& kind : study_kinds())
    for (const FindingPart& part : kind.parts) {
      if (!is_of(f, part)) continue;
      // the subject has no unit here; another kind may define this quantity
      if (part.unit == UnitOf::subject && !find_column(columns, f.subject)) continue;
      view.role = part.role;
      digits = part.digits;
      if (part.quantity.back() == ' ') view.variable = f.quantity.substr(part.quantity.size());
      if (part.unit == UnitOf::subject) view.unit = unit_of(columns, f.subject);
      if (part.unit == UnitOf::quotient) view.unit = quotient(unit_of(columns, f.subject), unit_of(columns, view.variable));
      return;
    }
  view.role = "estimate";
  view.unit = "SI";
}

// Formats with `digits` significant digits; values below 1e-3 get an exponent.
std::string plain(double value, int digits) {
  constexpr double k_small = 1e-3;
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  if (std::abs(value) >= k_small || value == 0.0 || std::string(text).find('e') != std::string::npos) return text;
  std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
  std::string number = text;
  const std::size_t e = number.find('e'), last = number.find_last_not_of('0', e - 1);
  return number.erase(number[last] == '.' ? last : last + 1, e - (number[last] == '.' ? last : last + 1));
}

// Changes "1.8e-04" to "1.8e-4" and removes the sign of −0.
std::string tidied(std::string text) {
  if (const auto e = text.find('e'); e != std::string::npos) {
    std::size_t digit = e + 2;
    while (digit + 1 < text.size() && text[digit] == '0') text.erase(digit, 1);
    if (text[e + 1] == '+') text.erase(e + 1, 1);
  }
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

// Rounds to a multiple of 10^last.
std::string rounded(double value, int last) {
  constexpr int k_most = 12;
  const double size = std::abs(value);
  if (std::isinf(value)) return value > 0.0 ? "∞" : "-∞";
  if (size == 0.0) return "0";
  const int first = static_cast<int>(std::floor(std::log10(size)));
  char text[64];
  const bool is_zero = size < 0.5 * std::pow(10.0, last); // the value is rounded to zero
  if (is_zero && last < -k_most) return "0";
  if (!is_zero && (first < -3 || first > 6)) {
    std::snprintf(text, sizeof text, "%.*e", std::clamp(first - last, 0, k_most - 1), value);
    return tidied(text);
  }
  if (last <= 0) {
    std::snprintf(text, sizeof text, "%.*f", std::clamp(-last, 0, k_most - 1 - std::max(first, 0)), value);
    return tidied(text);
  }
  const double unit = std::pow(10.0, last);
  std::snprintf(text, sizeof text, "%.0f", std::round(value / unit) * unit);
  return tidied(text);
}

// Determines the last digit to show as a power of ten: the second digit of the interval's width. If only one end is finite, half the
// interval is used. Returns false without an interval.
bool last_place(double value, double low, double high, int& last) {
  const bool has_low = std::isfinite(low), has_high = std::isfinite(high);
  const double width = has_low && has_high ? high - low : has_low ? std::abs(value - low) : has_high ? std::abs(high - value) : 0.0;
  if (!(width > 0.0)) return false;
  last = static_cast<int>(std::floor(std::log10(width))) - 1;
  return true;
}

} // namespace

std::string estimate_text(double value, double low, double high, int digits) {
  if (std::isnan(value)) return "";
  if (std::isinf(value)) return value > 0.0 ? "∞" : "-∞";
  int last = 0;
  return last_place(value, low, high, last) ? rounded(value, last) : tidied(plain(value, digits));
}

FindingView view_of(const Finding& f, const std::vector<ReportColumn>& columns) {
  FindingView view;
  int digits = 6;
  find_part(f, columns, view, digits);
  for (const StudyKind& kind : study_kinds())
    for (const PointRole& point : kind.points) view.place = std::max(view.place, place_in(f.subject, point.role));
  const auto finite = [](double x) { return std::isfinite(x) ? std::abs(x) : 0.0; };
  const UnitPrefix prefix = prefix_for(std::max({finite(f.value), finite(f.low), finite(f.high)}), view.unit);
  const double factor = std::pow(10.0, prefix.exponent), low = factor * f.low, high = factor * f.high;
  view.unit = prefix.text + view.unit;
  if (view.role == "swing") { // the ends are a range of values, not a confidence interval
    if (std::isfinite(f.value)) view.value = tidied(plain(factor * f.value, digits));
    if (std::isfinite(f.value)) view.interval = tidied(plain(low, 6)) + " to " + tidied(plain(high, 6));
    return view;
  }
  view.value = estimate_text(factor * f.value, low, high, digits);
  int last = 0;
  if (std::isnan(f.low) && std::isnan(f.high)) return view;
  const bool is_known = last_place(factor * f.value, low, high, last);
  const auto end = [&](double x) { return std::isnan(x) ? std::string("?") : is_known ? rounded(x, last) : tidied(plain(x, 6)); };
  view.interval = end(low) + " … " + end(high);
  return view;
}

} // namespace steplap::study
