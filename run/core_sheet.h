// Paper for drawings of cores: panels with a scale each, dimension lines, labels beside what is too thin to hold them.
//
// Everything is text of an SVG image, in pixels; y of a panel points upwards, in m. Colours are classes of the image's
// style (core_drawing.cpp), which has a dark variant.
#pragma once

#include "mbd/base/types.h"

#include <ostream>
#include <string>
#include <vector>

namespace steplap {

/// Text for an SVG image.
[[nodiscard]] std::string escaped_svg(const std::string& text);
/// A pixel to a hundredth.
[[nodiscard]] std::string pixels(double value);
/// A length in mm to a tenth, without its unit, as drawings have it.
[[nodiscard]] std::string plain_millimetres(double metres);

/// Where a panel lies in the image, pixels.
struct PanelFrame {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0; ///< upper left corner, size
};

/// Room that a panel keeps free around what it shows, pixels.
struct PanelEdges {
  double left = 34.0, right = 34.0, top = 34.0, bottom = 34.0; ///< pixels on each side
};

/// A frame of the image with a scale of its own.
class SheetPanel {
public:
  /// Draws frame and title. Shows at least the rectangle from `low` to `high`, in the middle of what `edges` leave.
  SheetPanel(std::ostream& out, const PanelFrame& frame, const std::string& title, const Vec2& low, const Vec2& high,
             const PanelEdges& edges, bool is_to_scale = true);

  /// Where a place, m, is in the image, pixels.
  [[nodiscard]] Vec2 at(const Vec2& p) const;
  /// Of a length across, pixels.
  [[nodiscard]] double length(double metres) const { return metres * scale_.x(); }
  /// Where the panel lies.
  [[nodiscard]] const PanelFrame& frame() const { return frame_; }

  /// A closed ring; `kind`: class of the style, here and below.
  void polygon(const std::vector<Vec2>& ring, const std::string& kind);
  /// Upright, m.
  void rectangle(double x0, double x1, double y0, double y1, const std::string& kind);
  /// Straight, m.
  void line(const Vec2& a, const Vec2& b, const std::string& kind);
  /// By its diameter, m.
  void circle(const Vec2& centre, double diameter, const std::string& kind);
  /// `down`: pixels below the place.
  void text(const Vec2& place, const std::string& words, const std::string& anchor = "middle", double down = 4.0);
  /// Along the lower edge of the frame, under what is drawn; another one along the upper edge.
  void note(const std::string& below, const std::string& above = "");

  /// From a to b, both on one horizontal line, with arrows; `off`: pixels below the lower of them (negative: above).
  void dimension_across(const Vec2& a, const Vec2& b, double off, const std::string& words);
  /// From a (lower) to b (upper); `off`: pixels to the right of the right one (negative: to the left).
  void dimension_upwards(const Vec2& a, const Vec2& b, double off, const std::string& words);

  /// A label to be written at the right edge, with a line to its place.
  struct Label {
    Vec2 place;        ///< m
    std::string words; ///< what is written
  };
  /// Writes as many labels as there is room for, in the order of their places, none on another; of more, evenly chosen ones.
  void labels_at_right(std::vector<Label> labels, double x);

private:
  void arrow(const Vec2& tip, const Vec2& direction);
  void line_between(const Vec2& a, const Vec2& b, const std::string& kind);

  std::ostream& out_;
  PanelFrame frame_;
  Vec2 low_, scale_, offset_;
};

} // namespace steplap
