// Model table [[drawing]]: the outline of a body from a layer of a DXF drawing (mbd/io/dxf.h).
//
//   [[drawing]]
//   name = "outline of the tank"
//   body = "tank"
//   file = "unit7.dxf"
//   layer = "TANK"
//   origin = ["1.5 m", "0 m"]   # where the body's origin is in the drawing
#pragma once

#include "mbd/model/model.h"

#include <string>

namespace steplap {

struct DrawnOutline : TableObject {
  std::string body, file, layer;
  std::string unit;           ///< unit of the drawing; "": as it states
  Vec2 origin = Vec2::Zero(); ///< origin of the body's frame in the drawing, m
  std::string sha256;         ///< required SHA-256 of the file; "": any
};

[[nodiscard]] const TableKind& drawn_outline_kind();

} // namespace steplap
