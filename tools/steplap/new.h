// steplap new: a commented model to start from, with its dimensions as options.
//
// templates/*.toml are the models themselves. Each line "name = { value = …, range = …, meaning = … } # source" of their [parameters] is
// an option, --name, whose value takes the place of the one that stands there.
#pragma once

#include "tools/steplap/command.h"

#include <string_view>

namespace steplap {

/// A parameter of a template that has a range: what may be given as an option.
struct TemplateParameter {
  std::string name;  ///< as in the file: "window_height"
  std::string value; ///< "1.7 m"
  std::string low, high;
  std::string meaning, source;
  std::size_t begin = 0, end = 0; ///< where the value stands in the text

  /// "--window-height"
  [[nodiscard]] std::string option() const;
};

/// A model to start from.
struct ModelTemplate {
  std::string name;      ///< "transformer"
  std::string_view text; ///< the file
  [[nodiscard]] std::vector<TemplateParameter> parameters() const;
};

[[nodiscard]] const std::vector<ModelTemplate>& model_templates();

[[nodiscard]] Command new_command();

} // namespace steplap
