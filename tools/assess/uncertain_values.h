// Joint probability distribution of the uncertain numbers of all models. A name used in several models denotes one number.
#pragma once

#include "tools/assess/driven_model.h"
#include "tools/study/law.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// An uncertain number of the voyage.
struct UncertainValue {
  std::string name, unit, source, source_text;
  std::string path;     ///< path of the first field to which it applies
  double nominal = 0.0; ///< value given in the models
  bool is_factor = false;
  /// A model field that receives the number, multiplied by `factor`.
  struct Setting {
    std::size_t model = 0;
    std::string path;
    double factor = 1.0;
  };
  std::vector<Setting> settings;
};

/// All uncertain numbers with their distributions, assumed to be independent.
class UncertainValues {
public:
  /// Throws ModelError for an invalid distribution, or if models give different distributions for one name.
  explicit UncertainValues(const std::vector<DrivenModel>& models);

  [[nodiscard]] const std::vector<UncertainValue>& values() const { return values_; }
  [[nodiscard]] bool empty() const { return values_.empty(); }
  /// Returns the values given in the models.
  [[nodiscard]] std::vector<double> nominal() const;
  /// Returns the values of sample `number`, counted from 1. They depend on seed and number only.
  [[nodiscard]] std::vector<double> draw(std::uint64_t seed, std::uint64_t number) const;
  /// Returns the p-quantile of a value.
  [[nodiscard]] double quantile(std::size_t value, double p) const;
  /// Returns a description of a value's distribution.
  [[nodiscard]] std::string law_text(std::size_t value) const;
  /// Returns the paths of all fields of a model that are set, in the order of numbers().
  [[nodiscard]] std::vector<std::string> paths(std::size_t model) const;
  /// Returns the values of the fields paths(model), computed from the values of all uncertain numbers.
  [[nodiscard]] std::vector<double> numbers(std::size_t model, const std::vector<double>& values) const;

private:
  std::vector<UncertainValue> values_;
  std::optional<study::JointLaw> law_;
};

} // namespace steplap::assess
