#include "transformer/recorder/event_pictures.h"

#include "transformer/recorder/fields.h"

#include "mbd/base/shown_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace steplap {

namespace {

// Largest number of events; points per curve, more than the width of the picture in pixels.
constexpr std::size_t k_most = 8, k_points = 600;
constexpr double k_width = 940.0, k_row = 200.0, k_head = 34.0;
// Colours of the axes; dashes distinguish the curves without colours.
constexpr std::array<const char*, 3> k_colours = {"#1b6ca8", "#c1440e", "#3c7d3f"};
constexpr std::array<const char*, 3> k_dashes = {"", "7 3", "2 3"};

double peak_of(const ShockEvent& event) { return std::abs(event.axes[event.worst].peak); }

/// A diagram on the page with its two scales.
struct Frame {
  double left, top, width, height;
  double x0, x1, y0, y1;
  [[nodiscard]] double x(double value) const { return left + width * (value - x0) / (x1 - x0); }
  [[nodiscard]] double y(double value) const { return top + height * (y1 - value) / (y1 - y0); }
};

std::string coordinate(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

void write(std::string& out, double x, double y, const char* anchor, const std::string& words, const char* style = "") {
  out += "<text x=\"" + coordinate(x) + "\" y=\"" + coordinate(y) + "\" text-anchor=\"" + anchor + "\"" + style + ">" + words + "</text>\n";
}

void line(std::string& out, double x0, double y0, double x1, double y1, const char* colour) {
  out += "<path d=\"M" + coordinate(x0) + " " + coordinate(y0) + "L" + coordinate(x1) + " " + coordinate(y1) +
         "\" fill=\"none\" stroke=\"" + colour + "\"/>\n";
}

template <class Point> void curve(std::string& out, std::size_t count, std::size_t axis, Point point) {
  out += std::string("<path fill=\"none\" stroke=\"") + k_colours[axis] + "\" stroke-width=\"1.4\" stroke-dasharray=\"" + k_dashes[axis] +
         "\" d=\"";
  for (std::size_t k = 0; k < count; ++k) {
    const std::array<double, 2> at = point(k);
    out += (k == 0 ? "M" : "L") + coordinate(at[0]) + " " + coordinate(at[1]);
  }
  out += "\"/>\n";
}

// Returns a tick distance of 1, 2 or 5 times a power of ten that gives about four ticks.
double tick_step(double span) {
  const double power = std::pow(10.0, std::floor(std::log10(span / 4.0))), share = span / 4.0 / power;
  return power * (share < 1.5 ? 1.0 : share < 3.5 ? 2.0 : share < 7.5 ? 5.0 : 10.0);
}

void ticks(std::string& out, const Frame& f) {
  line(out, f.left, f.top + f.height, f.left + f.width, f.top + f.height, "#444");
  line(out, f.left, f.top, f.left, f.top + f.height, "#444");
  const double across = tick_step(f.x1 - f.x0), up = tick_step(f.y1 - f.y0);
  for (double v = std::ceil(f.x0 / across) * across; v <= f.x1 + 1e-9 * across; v += across)
    write(out, f.x(v), f.top + f.height + 14.0, "middle", rounded_text(std::abs(v) < 1e-9 * across ? 0.0 : v, 3));
  for (double v = std::ceil(f.y0 / up) * up; v <= f.y1 + 1e-9 * up; v += up) {
    line(out, f.left, f.y(v), f.left + f.width, f.y(v), "#ddd");
    write(out, f.left - 5.0, f.y(v) + 4.0, "end", rounded_text(std::abs(v) < 1e-9 * up ? 0.0 : v, 3));
  }
}

// Draws the ticks of logarithmic scales at decades. The values of the frame are logarithms.
void decades(std::string& out, const Frame& f) {
  line(out, f.left, f.top + f.height, f.left + f.width, f.top + f.height, "#444");
  line(out, f.left, f.top, f.left, f.top + f.height, "#444");
  for (double v = std::ceil(f.x0 - 1e-9); v <= f.x1 + 1e-9; v += 1.0) {
    line(out, f.x(v), f.top, f.x(v), f.top + f.height, "#ddd");
    write(out, f.x(v), f.top + f.height + 14.0, "middle", rounded_text(std::pow(10.0, v), 3));
  }
  for (double v = std::ceil(f.y0 - 1e-9); v <= f.y1 + 1e-9; v += 1.0) {
    line(out, f.left, f.y(v), f.left + f.width, f.y(v), "#ddd");
    write(out, f.left - 5.0, f.y(v) + 4.0, "end", rounded_text(std::pow(10.0, v), 3));
  }
}

} // namespace

void EventPictures::add(const ShockEvent& event, const Window& window, const std::vector<std::vector<ShockPoint>>& spectra) {
  const auto is_greater = [](const Drawn& a, const Drawn& b) { return peak_of(a.event) > peak_of(b.event); };
  if (drawn_.size() == k_most && peak_of(event) <= peak_of(drawn_.back().event)) return;
  Drawn drawn{event, {}, {}, spectra};
  const std::size_t count = window.times.size(), stride = std::max<std::size_t>(1, (2 * count + k_points - 1) / k_points);
  // Keeps the sample furthest from zero in each interval, so that peaks are not lost.
  for (std::size_t from = 0; from < count; from += stride)
    for (std::size_t i = 0; i < event.axes.size(); ++i) {
      const auto begin = window.filtered[i].begin() + static_cast<std::ptrdiff_t>(from),
                 end = window.filtered[i].begin() + static_cast<std::ptrdiff_t>(std::min(count, from + stride));
      drawn.values[i].push_back(*std::max_element(begin, end, [](double a, double b) { return std::abs(a) < std::abs(b); }));
      if (i == 0) drawn.times.push_back(window.times[from] - window.times.front());
    }
  drawn_.insert(std::upper_bound(drawn_.begin(), drawn_.end(), drawn, is_greater), std::move(drawn));
  if (drawn_.size() > k_most) drawn_.pop_back();
}

std::string EventPictures::svg(const RecordLayout& layout, double bandwidth) const {
  if (drawn_.empty()) return "";
  std::vector<const Drawn*> order;
  for (const Drawn& each : drawn_) order.push_back(&each);
  std::sort(order.begin(), order.end(), [](const Drawn* a, const Drawn* b) { return a->event.number < b->event.number; });
  const double height = k_head + k_row * static_cast<double>(order.size()) + 6.0;
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + coordinate(k_width) + "\" height=\"" + coordinate(height) +
                    "\" viewBox=\"0 0 " + coordinate(k_width) + " " + coordinate(height) +
                    "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"none\">\n<rect width=\"100%\" height=\"100%\" "
                    "fill=\"white\"/>\n<g fill=\"#222\" stroke=\"none\">\n";
  write(out, 48.0, 20.0, "start", "acceleration in g, up to " + rounded_text(bandwidth, 3) + " Hz, over ms");
  write(out, 560.0, 20.0, "start", "shock response spectra in g over Hz, Q = 10");
  out += "</g>\n";
  for (std::size_t i = 0; i < layout.axes.size(); ++i) {
    const double x = 330.0 + 50.0 * static_cast<double>(i);
    curve(out, 2, i, [&](std::size_t k) { return std::array<double, 2>{x + 24.0 * static_cast<double>(k), 16.0}; });
    write(out, x + 30.0, 20.0, "start", std::string(1, layout.axes[i].axis), " fill=\"#222\"");
  }
  for (std::size_t n = 0; n < order.size(); ++n) {
    const Drawn& d = *order[n];
    const double top = k_head + k_row * static_cast<double>(n) + 22.0, end = std::max(1e-9, d.times.back());
    double low = 0.0, high = 0.0, most = 1e-6;
    for (const auto& values : d.values)
      for (const double value : values) low = std::min(low, value / k_gravity), high = std::max(high, value / k_gravity);
    const double room = std::max(0.05 * (high - low), 1e-9);
    const Frame wave{48.0, top, 440.0, 140.0, 0.0, 1e3 * end, low - room, high + room};
    const AxisEvent& worst = d.event.axes[d.event.worst];
    out += "<g fill=\"#222\" stroke=\"none\" font-weight=\"bold\">\n";
    write(out, 48.0, top - 6.0, "start",
          "event " + std::to_string(d.event.number) + " at " + rounded_text(worst.peak_time, 7) + " s: " + layout.axes[d.event.worst].axis +
              " " + rounded_text(worst.peak / k_gravity, 3) + " g, " + rounded_text(1e3 * worst.duration, 3) + " ms, " +
              rounded_text(worst.velocity_change, 3) + " m/s");
    out += "</g>\n<g fill=\"#222\" stroke-width=\"1\">\n";
    std::string scales;
    ticks(scales, wave);
    for (std::size_t i = 0; i < d.event.axes.size(); ++i)
      curve(scales, d.times.size(), i, [&](std::size_t k) {
        return std::array<double, 2>{wave.x(1e3 * d.times[k]), wave.y(d.values[i][k] / k_gravity)};
      });
    double slow = 1e9, fast = 1.0;
    for (const auto& spectrum : d.spectra)
      for (const ShockPoint& p : spectrum)
        slow = std::min(slow, p.frequency), fast = std::max(fast, p.frequency), most = std::max(most, p.acceleration / k_gravity);
    const double ceiling = std::log10(most) + 0.1;
    const Frame spectra{560.0, top, 360.0, 140.0, std::log10(std::min(slow, 0.5 * fast)), std::log10(fast), ceiling - 2.5, ceiling};
    decades(scales, spectra);
    for (std::size_t i = 0; i < d.spectra.size(); ++i)
      curve(scales, d.spectra[i].size(), i, [&](std::size_t k) {
        return std::array<double, 2>{
            spectra.x(std::log10(d.spectra[i][k].frequency)),
            spectra.y(std::max(spectra.y0, std::log10(std::max(1e-12, d.spectra[i][k].acceleration / k_gravity))))};
      });
    out += scales + "</g>\n";
  }
  return out + "</svg>\n";
}

} // namespace steplap
