// Drawing primitives for core drawings: panels with their own scales, dimension lines and labels with leader lines.
//
// All output is text of an SVG image, in pixels. Coordinates within a panel are in m, y upwards. Colours are style classes of the image
// (core_drawing.cpp), which has a dark variant.
#pragma once

#include "mbd/base/types.h"

#include <ostream>
#include <string>
#include <vector>

namespace steplap {

/// Returns `text` with the special characters of SVG escaped.
[[nodiscard]] std::string escaped_svg(const std::string& text);
/// Returns a pixel coordinate as text with two decimals.
[[nodiscard]] std::string pixels(double value);
/// Returns a length as text in mm with one decimal and without unit.
[[nodiscard]] std::string plain_millimetres(double metres);

/// Rectangle of a panel in the image, pixels.
struct PanelFrame {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0; ///< upper left corner, size
};

/// Margins inside a panel around its contents, pixels.
struct PanelEdges {
  double left = 34.0, right = 34.0, top = 34.0, bottom = 34.0; ///< pixels on each side
};

/// A rectangular part of the image with its own scale.
class SheetPanel {
public:
  /// Draws the frame and the title. The scale is chosen so that at least the rectangle from `low` to `high`, m, is visible inside `edges`.
  SheetPanel(std::ostream& out, const PanelFrame& frame, const std::string& title, const Vec2& low, const Vec2& high,
             const PanelEdges& edges, bool is_to_scale = true);

  /// Returns the image position, pixels, of a point p, m.
  [[nodiscard]] Vec2 at(const Vec2& p) const;
  /// Returns a horizontal length in pixels.
  [[nodiscard]] double length(double metres) const { return metres * scale_.x(); }
  /// Returns the panel's rectangle in the image.
  [[nodiscard]] const PanelFrame& frame() const { return frame_; }

  /// Draws a closed polygon. In all drawing functions `kind` is a style class.
  void polygon(const std::vector<Vec2>& ring, const std::string& kind);
  /// Draws an axis-parallel rectangle, corners in m.
  void rectangle(double x0, double x1, double y0, double y1, const std::string& kind);
  /// Draws a straight line, end points in m.
  void line(const Vec2& a, const Vec2& b, const std::string& kind);
  /// Draws a circle with centre and diameter in m.
  void circle(const Vec2& centre, double diameter, const std::string& kind);
  /// Writes text at a point, shifted downwards by `down` pixels.
  void text(const Vec2& place, const std::string& words, const std::string& anchor = "middle", double down = 4.0);
  /// Writes one line of text along the lower edge of the frame and, if `above` is given, one along the upper edge.
  void note(const std::string& below, const std::string& above = "");

  /// Draws a horizontal dimension line from a to b with arrows, `off` pixels below the lower of both points (above if negative).
  void dimension_across(const Vec2& a, const Vec2& b, double off, const std::string& words);
  /// Draws a vertical dimension line from a (lower) to b (upper), `off` pixels to the right of the right one (to the left if negative).
  void dimension_upwards(const Vec2& a, const Vec2& b, double off, const std::string& words);

  /// Label at the right edge, with a leader line to its point.
  struct Label {
    Vec2 place;        ///< point, m
    std::string words; ///< text of the label
  };
  /// Writes the labels in the order of their points, without overlap. If there is not enough room, an evenly spaced selection is written.
  void labels_at_right(std::vector<Label> labels, double x);

private:
  void arrow(const Vec2& tip, const Vec2& direction);
  void line_between(const Vec2& a, const Vec2& b, const std::string& kind);

  std::ostream& out_;
  PanelFrame frame_;
  Vec2 low_, scale_, offset_;
};

} // namespace steplap
