#include "study/report_findings.h"

#include "run/quantity_text.h"

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

enum class UnitOf { none, subject, variable, quotient, unknown };

struct Part {
  const char* role;
  const char* quantity; ///< as it begins; what follows is the name of a variable if it ends with a blank
  UnitOf unit;
};

constexpr Part k_parts[] = {
    {"probability", "probability", UnitOf::none},
    {"probability", "share of failures", UnitOf::none},
    {"beta", "beta", UnitOf::none},
    {"moment", "mean", UnitOf::subject},
    {"moment", "standard deviation", UnitOf::subject},
    {"extreme", "lowest", UnitOf::subject},
    {"extreme", "highest", UnitOf::subject},
    {"base", "value", UnitOf::subject},
    {"critical", "critical value", UnitOf::subject},
    {"elasticity", "elasticity to ", UnitOf::none},
    {"elasticity", "derivative by ", UnitOf::quotient},
    {"mu*", "mu* of ", UnitOf::subject},
    {"sigma", "sigma of ", UnitOf::subject},
    {"first order", "first order of ", UnitOf::none},
    {"total", "total of ", UnitOf::none},
    {"swing", "swing by ", UnitOf::subject},
    {"importance", "importance of ", UnitOf::none},
    {"need", "largest change", UnitOf::none},
    {"residual", "residual", UnitOf::subject}, // of a measured record
    {"sum of squares", "sum of squares", UnitOf::none}, // of residuals over their noise
    {"correlation", "correlation", UnitOf::none},
    {"condition", "condition", UnitOf::none},
    {"not told", "not told", UnitOf::none},
    {"another fit", "another fit", UnitOf::none},
    {"factor", "factor", UnitOf::none}, // of a probability by theory to one by sampling
    {"unseen", "unseen radius", UnitOf::none},
};

// "design point 2", "border 1 point 17": the number behind the first word or words.
long place_in(const std::string& subject, const std::string& noun) {
  long place = 0;
  if (subject.starts_with(noun + " "))
    std::from_chars(subject.data() + noun.size() + 1, subject.data() + subject.size(), place);
  return place;
}

std::string quotient(const std::string& above, const std::string& below) {
  if (below.empty()) return above;
  return (above.empty() ? "1" : above) + "/" +
         (below.find(' ') == std::string::npos && below.find('/') == std::string::npos ? below : "(" + below + ")");
}

// The part, and the unit in SI.
void find_part(const Finding& f, const std::vector<ReportColumn>& columns, FindingView& view) {
  if (const ReportColumn* column = find_column(columns, f.quantity);
      column && (f.method == "map" || f.method == "form")) {
    view.role = f.method == "map" ? "border" : "design point";
    view.variable = f.quantity;
    view.unit = column->unit;
    return;
  }
  if (f.quantity.ends_with(" quantile")) {
    view.role = "quantile";
    view.unit = unit_of(columns, f.subject);
    return;
  }
  for (const Part& part : k_parts) {
    const std::string begin = part.quantity;
    if (!f.quantity.starts_with(begin)) continue;
    if (part.unit == UnitOf::subject && !find_column(columns, f.subject)) continue; // of another kind's making
    view.role = part.role;
    if (begin.back() == ' ') view.variable = f.quantity.substr(begin.size());
    if (part.unit == UnitOf::subject) view.unit = unit_of(columns, f.subject);
    if (part.unit == UnitOf::quotient)
      view.unit = quotient(unit_of(columns, f.subject), unit_of(columns, view.variable));
    return;
  }
  view.role = "estimate";
  view.unit = "SI";
}

// As a C program writes it, but small numbers with an exponent.
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

// "1.8e-04" is "1.8e-4"; no minus before zero.
std::string tidied(std::string text) {
  if (const auto e = text.find('e'); e != std::string::npos) {
    std::size_t digit = e + 2;
    while (digit + 1 < text.size() && text[digit] == '0') text.erase(digit, 1);
    if (text[e + 1] == '+') text.erase(e + 1, 1);
  }
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

// To the place of ten to `last`.
std::string rounded(double value, int last) {
  constexpr int k_most = 12;
  const double size = std::abs(value);
  if (std::isinf(value)) return value > 0.0 ? "∞" : "-∞";
  if (size == 0.0) return "0";
  const int first = static_cast<int>(std::floor(std::log10(size)));
  char text[64];
  const bool is_zero = size < 0.5 * std::pow(10.0, last); // beside its interval
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

// Of an interval, or of what is known of one, the place of its width's second digit.
bool last_place(double value, double low, double high, int& last) {
  const bool has_low = std::isfinite(low), has_high = std::isfinite(high);
  const double width = has_low && has_high ? high - low
                       : has_low           ? std::abs(value - low)
                       : has_high          ? std::abs(high - value)
                                           : 0.0;
  if (!(width > 0.0)) return false;
  last = static_cast<int>(std::floor(std::log10(width))) - 1;
  return true;
}

int digits_of(const Finding& f, const std::string& role) {
  constexpr int k_exact = 6, k_estimated = 4;
  if (role == "beta") return 5;
  if (role == "correlation" || role == "condition" || role == "not told" || role == "another fit") return 3;
  if (role == "residual") return k_estimated;
  return role == "moment" || role == "quantile" || role == "probability" || role == "sigma" ? k_estimated
         : f.method == "needs"                                                              ? 3
                                                                                            : k_exact;
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
  find_part(f, columns, view);
  view.place = std::max(place_in(f.subject, "border"), place_in(f.subject, "design point"));
  const auto finite = [](double x) { return std::isfinite(x) ? std::abs(x) : 0.0; };
  const UnitPrefix prefix = prefix_for(std::max({finite(f.value), finite(f.low), finite(f.high)}), view.unit);
  const double factor = std::pow(10.0, prefix.exponent), low = factor * f.low, high = factor * f.high;
  view.unit = prefix.text + view.unit;
  if (view.role == "swing") { // between the ends of a bar, which are no interval
    if (std::isfinite(f.value)) view.value = tidied(plain(factor * f.value, digits_of(f, view.role)));
    if (std::isfinite(f.value)) view.interval = tidied(plain(low, 6)) + " to " + tidied(plain(high, 6));
    return view;
  }
  view.value = estimate_text(factor * f.value, low, high, digits_of(f, view.role));
  int last = 0;
  if (std::isnan(f.low) && std::isnan(f.high)) return view;
  const bool is_known = last_place(factor * f.value, low, high, last);
  const auto end = [&](double x) {
    return std::isnan(x) ? std::string("?") : is_known ? rounded(x, last) : tidied(plain(x, 6));
  };
  view.interval = end(low) + " … " + end(high);
  return view;
}

} // namespace steplap::study
