// Creates gnuplot scripts of time histories, for papers and for computers without a browser.
#pragma once

#include "mbd/run/results.h"

#include <string>
#include <vector>

namespace steplap {

/// A curve of a panel.
struct Curve {
  std::string label;
  const std::vector<double>* times = nullptr;
  const std::vector<double>* values = nullptr; ///< values of the curve, SI
  int colour = 0, dash = 0;
  double sign = 1.0;
};

/// One diagram of a figure.
struct Panel {
  std::string title, unit;
  std::vector<Curve> curves;
};

/// A figure with several panels.
struct Figure {
  std::vector<Panel> panels; ///< panels in rows, from the top left
  int columns = 1;
  int panel_width = 760, panel_height = 300; ///< size of a panel, pixels
};

/// Returns a script that draws `figure` into the image `file`; `ending` is svg, png or pdf. All characters of names are shown literally.
/// Curves with more samples than visible are thinned; peaks are kept.
[[nodiscard]] std::string gnuplot_script(const Figure& figure, const std::string& ending, const std::string& file);

} // namespace steplap
