// Force and moment at a marker, constant or as signals, in ground or body axes.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Load : Element {
  std::string at;
  Vec2 force = Vec2::Zero();
  double couple = 0.0;
  std::string force_x, force_y, torque; ///< names of signals that are added to the constant values
  std::string frame = "ground";
};

[[nodiscard]] const ElementKind& load_kind();

} // namespace steplap
