// Coordinate frame of a part, applied to values of a document. A result is a number if frame and value are numbers, otherwise a formula.
//
// The frame has origin (x, y) and angle θ in the frame of the file that contains the part. A point p of the part's file then lies at
//   x + (cos θ · p_x − sin θ · p_y),   y + (sin θ · p_x + cos θ · p_y)
// in this order of operations, for numbers and formulas. Without angle the position is x + p_x, y + p_y. Frames of nested parts are
// composed in the same way, and their angles added.
#pragma once

#include "mbd/io/toml_text.h"

#include <optional>
#include <string>

namespace steplap {

/// Returns a node without a value, at the location of `at`.
[[nodiscard]] Node node_at(const std::string& key, const Node& at);

/// Value of a field that a frame can transform: a number in SI units, or a formula for it.
struct NumberOrFormula {
  double value = 0.0;
  std::string formula; ///< formula without '='; "": the number applies

  [[nodiscard]] bool is_number() const { return formula.empty(); }
};

/// Reads a number, a number with its unit, or a formula. Returns nothing for any other value; the reader of the field reports that error.
[[nodiscard]] std::optional<NumberOrFormula> number_or_formula(const Node& node, const std::string& unit);

class PartFrame {
public:
  /// Creates the frame of the model itself.
  PartFrame() = default;
  /// Creates a frame given relative to the frame `outer`.
  PartFrame(const PartFrame& outer, const NumberOrFormula& x, const NumberOrFormula& y, const NumberOrFormula& angle);

  /// Returns true if the frame has a position or angle of its own, that is, differs from the model's frame.
  [[nodiscard]] bool is_placed() const { return is_placed_; }
  [[nodiscard]] bool is_turned() const { return is_turned_; }

  /// Transforms a point [x, y], or all points in nested lists, to the frame of the model. Other values stay unchanged.
  void place_points(Node& node) const;
  /// Rotates the components of a vector with this unit into the axes of the model.
  void turn_vector(Node& node, const std::string& unit) const;
  /// Adds the angle of the frame to an angle.
  void turn_angle(Node& node) const;

  /// Return the origin and the angle of the frame as nodes with this key, at the location of `where`.
  [[nodiscard]] Node origin_node(const std::string& key, const Node& where) const;
  [[nodiscard]] Node angle_node(const std::string& key, const Node& where) const;

private:
  [[nodiscard]] NumberOrFormula turned(const NumberOrFormula& first, const NumberOrFormula& second, bool is_y,
                                       const std::string& unit) const;
  [[nodiscard]] NumberOrFormula placed(const NumberOrFormula& first, const NumberOrFormula& second, bool is_y) const;

  NumberOrFormula x_, y_, angle_;
  NumberOrFormula cos_{1.0, ""}, sin_;
  bool is_placed_ = false, is_turned_ = false;
};

} // namespace steplap
