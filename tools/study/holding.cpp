#include "tools/study/holding.h"

#include "mbd/base/shown_text.h"
#include "mbd/run/quantity_text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace steplap::study {

namespace {

double wanted_width(const Crossing& c, double tolerance, double range) {
  constexpr double k_floor = 1e-6; // relative to the range: smallest magnitude for the relative tolerance, needed for a border at zero
  return tolerance * std::max({std::abs(c.low), std::abs(c.high), k_floor * range});
}

HoldingEnd range_end(double value) {
  HoldingEnd end;
  end.value = value;
  end.is_range_end = true;
  return end;
}

std::string end_text(const HoldingEnd& end, const std::string& unit, bool is_up, int digits, std::optional<double> confidence) {
  std::string text = rounded_quantity(end.value, unit, is_up, digits);
  if (end.is_range_end) return text + " (the end of the range)";
  if (confidence && !std::isnan(end.low))
    text += " (with " + rounded_text(100.0 * *confidence, 4) + " % confidence " + rounded_quantity(end.low, unit, false, digits) + " to " +
            rounded_quantity(end.high, unit, true, digits) + ")";
  return text;
}

} // namespace

std::vector<Crossing> closed_crossings(const LineFunction& function, const LineSamples& samples, double tolerance) {
  std::vector<Crossing> crossings;
  for (std::size_t i = 1; i < samples.x.size(); ++i)
    if ((samples.g[i - 1] < 0.0) != (samples.g[i] < 0.0))
      crossings.push_back({samples.x[i - 1], samples.x[i], samples.g[i - 1], samples.g[i]});
  const double range = samples.x.back() - samples.x.front();
  constexpr int k_most = 8; // passes; the tolerance is relative to the border's value, which each pass refines
  for (int pass = 0; pass < k_most; ++pass) {
    double width = range;
    bool is_wide = false;
    for (const Crossing& c : crossings) {
      width = std::min(width, wanted_width(c, tolerance, range));
      is_wide = is_wide || c.high - c.low > wanted_width(c, tolerance, range);
    }
    if (!is_wide) break;
    close_crossings(crossings, width, [&](const std::vector<std::size_t>&, const std::vector<double>& at) { return function(at); });
  }
  return crossings;
}

std::vector<HoldingInterval> holding_intervals(const LineSamples& samples, const std::vector<Crossing>& crossings) {
  std::vector<HoldingInterval> intervals;
  const std::size_t count = samples.x.size();
  std::size_t next = 0; // index of the next crossing
  const auto end_at = [&](std::size_t inside, std::size_t outside) {
    if (crossings.empty()) return HoldingEnd{samples.x[inside], samples.x[inside], samples.x[inside], false, samples.x[outside]};
    const Crossing& c = crossings[next++];
    const bool is_below = c.g_low < 0.0;
    return HoldingEnd{is_below ? c.high : c.low, c.low, c.high, false, is_below ? c.low : c.high};
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (samples.g[i] < 0.0) continue;
    if (i == 0) intervals.push_back({range_end(samples.x[0]), {}});
    else if (samples.g[i - 1] < 0.0) intervals.push_back({end_at(i, i - 1), {}});
    if (i + 1 == count) intervals.back().to = range_end(samples.x[i]);
    else if (samples.g[i + 1] < 0.0) intervals.back().to = end_at(i, i + 1);
  }
  return intervals;
}

std::string rounded_quantity(double value, const std::string& unit, bool is_up, int digits) {
  constexpr double k_exact = 1e-6; // a value this close to a round one, relative to the last digit, is not rounded to the next
  const std::string known = unit == "*" ? "" : unit;
  const UnitPrefix prefix = prefix_for(value, known);
  const double scaled = value * std::pow(10.0, prefix.exponent);
  const double last = scaled == 0.0 ? 1.0 : std::pow(10.0, std::floor(std::log10(std::abs(scaled))) + 1.0 - digits);
  const double steps = is_up ? std::ceil(scaled / last - k_exact) : std::floor(scaled / last + k_exact);
  const std::string text = rounded_text(steps * last + 0.0, digits);
  return known.empty() ? text : text + " " + prefix.text + known;
}

std::string intervals_text(const std::vector<HoldingInterval>& intervals, const std::string& unit, int digits,
                           std::optional<double> confidence) {
  std::string text;
  for (const HoldingInterval& i : intervals) {
    if (!text.empty()) text += &i == &intervals.back() ? " and " : ", ";
    if (i.from.value == i.to.value) text += "at " + rounded_quantity(i.from.value, unit, false, 12);
    else text += "from " + end_text(i.from, unit, true, digits, confidence) + " to " + end_text(i.to, unit, false, digits, confidence);
  }
  return text;
}

} // namespace steplap::study
