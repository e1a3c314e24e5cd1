// Where a part stands, for the values of a document: numbers where its place and they are numbers, formulas where one of them is.
//
// A part's frame has the origin (x, y) and the angle θ in the frame of the file that takes it. A point p of the part's file then
// lies at
//   x + (cos θ · p_x − sin θ · p_y),   y + (sin θ · p_x + cos θ · p_y)
// in this order of operations, for numbers and for formulas; without an angle at x + p_x, y + p_y. Frames of parts in parts are
// put together in the same way, their angles added.
#pragma once

#include "mbd/io/toml_text.h"

#include <optional>
#include <string>

namespace steplap {

/// Without a value, where `at` stands.
[[nodiscard]] Node node_at(const std::string& key, const Node& at);

/// A number, in SI, or a formula that gives it.
struct PlacedNumber {
  double value = 0.0;
  std::string formula; ///< without its '='; "": it is the number

  [[nodiscard]] bool is_number() const { return formula.empty(); }
};

/// What a node says in `unit`: a number, a number with its unit, a formula. Nothing for what is none of them, which its reader tells.
[[nodiscard]] std::optional<PlacedNumber> placed_number(const Node& node, const std::string& unit);

class PartFrame {
public:
  /// The frame of the model itself.
  PartFrame() = default;
  /// A frame given in the frame `outer`.
  PartFrame(const PartFrame& outer, const PlacedNumber& x, const PlacedNumber& y, const PlacedNumber& angle);

  /// Does it lie or point elsewhere than the model's?
  [[nodiscard]] bool is_placed() const { return is_placed_; }
  [[nodiscard]] bool is_turned() const { return is_turned_; }

  /// Lays a point [x, y], or each of a list of points or of lists of them, over the frame. What is no point stays as it is.
  void place_points(Node& node) const;
  /// The same for a vector in `unit`, which only turns.
  void turn_vector(Node& node, const std::string& unit) const;
  /// Adds the frame's angle.
  void turn_angle(Node& node) const;

  /// Its origin and angle, at the place of `where`.
  [[nodiscard]] Node origin_node(const std::string& key, const Node& where) const;
  [[nodiscard]] Node angle_node(const std::string& key, const Node& where) const;

private:
  [[nodiscard]] PlacedNumber turned(const PlacedNumber& first, const PlacedNumber& second, bool is_y, const std::string& unit) const;
  [[nodiscard]] PlacedNumber placed(const PlacedNumber& first, const PlacedNumber& second, bool is_y) const;

  PlacedNumber x_, y_, angle_;
  PlacedNumber cos_{1.0, ""}, sin_;
  bool is_placed_ = false, is_turned_ = false;
};

} // namespace steplap
