#include "tools/pages/figure.h"

#include "mbd/base/number_text.h"
#include "tools/pages/thinning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace steplap {

namespace {

constexpr std::size_t k_stretches = 2000;
// Colours of Okabe and Ito, which colour-blind readers can distinguish.
constexpr std::array k_colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

// Quotes a text for gnuplot's single quotes.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += "''";
    else result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return result + "'";
}

struct Prefix {
  double factor = 1.0;
  const char* text = "";
};

// Returns a unit prefix for the largest value of a panel; none for units that cannot take one.
Prefix prefix_for(const Panel& panel) {
  static const std::set<std::string> prefixable{"m", "N", "N m", "Pa", "rad", "J", "m/s", "rad/s"};
  static constexpr std::array<Prefix, 6> prefixes{{{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1.0, ""}, {1e-3, "m"}, {1e-6, "µ"}}};
  double largest = 0.0;
  for (const Curve& curve : panel.curves)
    for (const double value : *curve.values)
      if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  if (prefixable.count(panel.unit) == 0 || largest == 0.0) return {};
  for (const Prefix& prefix : prefixes)
    if (largest >= prefix.factor) return prefix;
  return prefixes.back();
}

std::string data_block(const Curve& curve, const std::string& name, double factor) {
  std::string text = name + " << EOD\n";
  for (const std::size_t i : thinned(*curve.values, k_stretches)) {
    const double value = curve.sign * (*curve.values)[i] / factor;
    text += number_text((*curve.times)[i]) + " " + (std::isfinite(value) ? number_text(value) : "NaN") + "\n";
  }
  return text + "EOD\n";
}

std::string panel_script(const Panel& panel, std::size_t number) {
  const Prefix prefix = prefix_for(panel);
  std::string data, plot;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    const std::string name = "$panel" + std::to_string(number) + "curve" + std::to_string(i);
    data += data_block(curve, name, prefix.factor);
    plot += (i == 0 ? "plot " : ", \\\n  ") + name + " using 1:2 with lines lw 1.8 dt " + std::to_string(curve.dash + 1) + " lc rgb " +
            quoted(k_colours[curve.colour % k_colours.size()]) + (curve.label.empty() ? " notitle" : " title " + quoted(curve.label));
  }
  const std::string unit = panel.unit.empty() ? "–" : prefix.text + panel.unit;
  return data + "set title " + quoted(panel.title) + "\nset ylabel " + quoted("[" + unit + "]") + "\n" + plot + "\n";
}

} // namespace

std::string gnuplot_script(const Figure& figure, const std::string& ending, const std::string& file) {
  const int count = static_cast<int>(figure.panels.size());
  const int rows = (count + figure.columns - 1) / figure.columns;
  const int width = figure.columns * figure.panel_width, height = rows * figure.panel_height;
  const std::string pixels = std::to_string(width) + "," + std::to_string(height);
  std::string text;
  if (ending == "svg") text = "set terminal svg size " + pixels + " font 'DejaVu Sans,13' background '#ffffff' noenhanced\n";
  if (ending == "png") text = "set terminal pngcairo size " + pixels + " font 'DejaVu Sans,11' noenhanced\n";
  if (ending == "pdf")
    text = "set terminal pdfcairo size " + number_text(width / 96.0) + "in," + number_text(height / 96.0) +
           "in font 'DejaVu Sans,9' noenhanced\n";
  text += "set output " + quoted(file) +
          "\nset encoding utf8\nset grid lc rgb '#dddddd'\nset xlabel 't [s]'\n"
          "set key above right\nset border lc rgb '#555555'\n";
  text += "set multiplot layout " + std::to_string(rows) + "," + std::to_string(figure.columns) + "\n";
  for (std::size_t i = 0; i < figure.panels.size(); ++i) text += panel_script(figure.panels[i], i);
  return text + "unset multiplot\nunset output\n";
}

} // namespace steplap
