// Lists the numbers of a model that can be varied interactively: all numbers with a path, each with an initial range.
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

/// One number of a model.
struct Slider {
  std::string path;      ///< path as used to override values (mbd/model/model_path.h): "element.front foot.stiffness"
  std::string group;     ///< "parameters", "friction", "pressure", "peak", "duration", "gap", "stiffness"; "": shown only in search results
  std::string unit;      ///< unit of the field; "" if it has none or accepts any
  std::string meaning;   ///< one line that describes the number
  double value = 0.0;    ///< value in the file, SI
  double least = 0.0;    ///< lower end of the slider, SI
  double most = 0.0;     ///< upper end, SI; larger than `least`
  bool is_whole = false; ///< true for integers
  bool has_own_range = false; ///< true if the file gives the range, false if it was chosen around the value
  bool needs_file = false;    ///< true if a change requires reading the file again, false if the value can be set in the loaded model
};

/// Returns the sliders of a model as given (mbd/io/reader.h): free parameters in their order, then all other numbers in the order of the
/// model. Numbers computed by a formula from parameters are omitted.
[[nodiscard]] std::vector<Slider> sliders_of(const Model& given);

} // namespace steplap
