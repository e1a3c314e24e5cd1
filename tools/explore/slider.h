// What can be varied while one looks: every number of a model that has a path, with a range that makes sense to begin with.
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

/// One number of a model.
struct Slider {
  std::string path;    ///< as `--set` takes it (mbd/model/model_path.h): "element.front foot.stiffness"
  std::string group;   ///< "parameters", "friction", "pressure", "peak", "duration", "gap", "stiffness"; "" of what is only found by search
  std::string unit;    ///< SI; "" without a unit, or where any will do
  std::string meaning; ///< one line
  double value = 0.0;  ///< of the file, SI
  double least = 0.0;  ///< where the slider begins, SI
  double most = 0.0;   ///< where it ends, SI; larger than `least`
  bool is_whole = false;      ///< whole numbers only
  bool has_own_range = false; ///< the file gives the range; else it was chosen around the value
  bool needs_file = false;    ///< a change is read with the file; else it can be set in a model that has been read
};

/// Of a model as given (mbd/io/reader.h): free parameters first, in their order, then all other numbers in the order of the model.
/// Numbers that follow from parameters by a formula are left out, as they are varied by these.
[[nodiscard]] std::vector<Slider> sliders_of(const Model& given);

} // namespace steplap
