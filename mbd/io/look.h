// Model table [[look]]: appearance of a part of a body in drawings. It does not affect the motion.
//
//   [[look]]
//   name = "front wheels"
//   body = "front axle"
//   draw = "wheel"
//   radius = "0.4 m"
//   count = 5
//   pitch = "0.9 m"
#pragma once

#include "mbd/model/model.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

struct Look : TableObject {
  std::string body;             ///< name of a body, or "ground"
  Vec2 at = Vec2::Zero();       ///< middle of the part or of the row of parts, m, body frame; of a road or rail a point of its surface
  std::optional<Vec2> size;     ///< width and height of a winding, a wooden block or a foot, m
  std::optional<double> radius; ///< radius of a wheel, m
  std::optional<double> wall;   ///< thickness of a tank's wall, m
  std::optional<double> oil;    ///< level of the oil in a tank, m, y in the body frame
  long count = 1;               ///< number of equal parts in a row along the body's x axis
  std::optional<double> pitch;  ///< distance between neighbours in the row, m
};

/// Returns the middles of the parts in the row, m, body frame.
[[nodiscard]] std::vector<Vec2> places_of(const Look& look);

[[nodiscard]] const TableKind& look_kind();

} // namespace steplap
