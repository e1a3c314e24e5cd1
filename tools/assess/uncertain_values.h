// The uncertain numbers of all models as one joint law: a name stands for one number, in however many models.
#pragma once

#include "tools/assess/driven_model.h"
#include "tools/study/law.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap::assess {

/// A number of the voyage that is not known exactly.
struct UncertainValue {
  std::string name, unit, source, source_text;
  std::string path;     ///< the first one
  double nominal = 0.0; ///< the models' own
  bool is_factor = false;
  /// Where it goes: factor times it, or it.
  struct Setting {
    std::size_t model = 0;
    std::string path;
    double factor = 1.0;
  };
  std::vector<Setting> settings;
};

/// All of them, with their distributions. Uncertain values are taken to be independent.
class UncertainValues {
public:
  /// Throws ModelError for a distribution that is none, and for one name with two laws.
  explicit UncertainValues(const std::vector<DrivenModel>& models);

  [[nodiscard]] const std::vector<UncertainValue>& values() const { return values_; }
  [[nodiscard]] bool empty() const { return values_.empty(); }
  [[nodiscard]] std::vector<double> nominal() const;
  /// Values of sample `number` (from 1), always the same for a seed.
  [[nodiscard]] std::vector<double> draw(std::uint64_t seed, std::uint64_t number) const;
  [[nodiscard]] double quantile(std::size_t value, double p) const;
  [[nodiscard]] std::string law_text(std::size_t value) const;
  /// Paths of a model that get values, and the numbers for them.
  [[nodiscard]] std::vector<std::string> paths(std::size_t model) const;
  [[nodiscard]] std::vector<double> numbers(std::size_t model, const std::vector<double>& values) const;

private:
  std::vector<UncertainValue> values_;
  std::optional<study::JointLaw> law_;
};

} // namespace steplap::assess
