// Force and moment at a marker, constant or as signals, in ground or body axes.
#pragma once

#include "mbd/model/model.h"

#include <optional>

namespace steplap {

struct Load : Element {
  std::string at;
  std::optional<Vec2> force;            ///< constant part, N
  std::optional<double> couple;         ///< constant part, N m
  std::string force_x, force_y, torque; ///< names of signals that are added to the constant values
  std::string frame = "ground";
};

[[nodiscard]] const ElementKind& load_kind();

} // namespace steplap
