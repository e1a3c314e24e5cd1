// Command `steplap new`: writes a commented model, with its dimensions as options.
//
// templates/*.toml are the models. Each line "name = { value = …, range = …, meaning = … } # source" in [parameters] becomes an option
// --name, whose value replaces the value in the line.
#pragma once

#include "tools/steplap/command.h"

#include <string_view>

namespace steplap {

/// A parameter of a template that has a range and is therefore an option.
struct TemplateParameter {
  std::string name;  ///< name in the file: "window_height"
  std::string value; ///< value in the template, "1.7 m"
  std::string low, high;
  std::string meaning, source;
  std::size_t begin = 0, end = 0; ///< position of the value in the text

  /// Returns "--window-height".
  [[nodiscard]] std::string option() const;
};

/// A model template.
struct ModelTemplate {
  std::string name;      ///< name of the template, "transformer"
  std::string_view text; ///< text of the model file
  [[nodiscard]] std::vector<TemplateParameter> parameters() const;
};

[[nodiscard]] const std::vector<ModelTemplate>& model_templates();

} // namespace steplap
