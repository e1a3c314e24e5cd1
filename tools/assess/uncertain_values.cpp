#include "tools/assess/uncertain_values.h"

#include "mbd/base/number_text.h"
#include "mbd/model/model_path.h"
#include "tools/study/counter_random.h"
#include "transformer/core/uncertain.h"

#include <algorithm>

namespace steplap::assess {

namespace {

constexpr std::uint32_t k_stream = 28; // number of the random stream; studies use others

study::Variable variable_of(const Uncertain& u, const Model& model) {
  study::Variable v;
  v.name = u.name;
  v.paths = u.paths;
  v.is_factor = u.is_factor;
  v.distribution = u.distribution;
  v.cov = u.cov;
  v.where = u.where;
  const auto read = [&](const char* field, const std::string& text) { return value_of_text(u, field, text, model); };
  v.mean = read("mean", u.mean);
  v.standard_deviation = read("standard_deviation", u.standard_deviation);
  v.low = read("low", u.low), v.high = read("high", u.high), v.mode = read("mode", u.mode);
  v.lower = read("lower", u.lower), v.upper = read("upper", u.upper);
  return v;
}

// Returns true if both tables define the same distribution.
bool is_same_law(const study::Variable& a, const study::Variable& b) {
  return a.is_factor == b.is_factor && a.distribution == b.distribution && a.mean == b.mean &&
         a.standard_deviation == b.standard_deviation && a.cov == b.cov && a.low == b.low && a.high == b.high && a.mode == b.mode &&
         a.lower == b.lower && a.upper == b.upper;
}

} // namespace

UncertainValues::UncertainValues(const std::vector<DrivenModel>& models) {
  study::Study study;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const Model& given = models[m].given;
    for (const Uncertain* const u : uncertain_of(given)) {
      study::Variable variable = variable_of(*u, given);
      const double own = number_of(given, u->paths.front());
      int known = study.index_of_variable(u->name);
      if (known < 0) {
        known = static_cast<int>(values_.size());
        UncertainValue value{u->name,          u->is_factor ? "" : unit_of(given, u->paths.front()),
                             u->source,        u->source_text,
                             u->paths.front(), u->is_factor ? 1.0 : own,
                             u->is_factor,     {}};
        values_.push_back(std::move(value));
        study.variables.push_back(std::move(variable));
      } else if (!is_same_law(study.variables[static_cast<std::size_t>(known)], variable)) {
        throw ModelError(u->where, "uncertain '" + u->name +
                                       "' has another distribution in another of the models: a name stands for one number. Give it another "
                                       "name, or the same distribution");
      }
      for (const std::string& path : u->paths)
        values_[static_cast<std::size_t>(known)].settings.push_back({m, path, u->is_factor ? number_of(given, path) : 1.0});
    }
  }
  if (values_.empty()) return;
  std::vector<Diagnostic> problems;
  law_.emplace(study, nominal(), problems);
  if (!problems.empty()) throw ModelError(std::move(problems));
}

std::vector<double> UncertainValues::nominal() const {
  std::vector<double> values;
  for (const UncertainValue& value : values_) values.push_back(value.nominal);
  return values;
}

std::vector<double> UncertainValues::draw(std::uint64_t seed, std::uint64_t number) const {
  const study::CounterRandom random(seed, k_stream);
  std::vector<double> u, values = nominal();
  for (std::size_t i = 0; i < values_.size(); ++i) u.push_back(random.normal(number, static_cast<std::uint32_t>(i)));
  law_->values_at(u.data(), values.data());
  return values;
}

double UncertainValues::quantile(std::size_t value, double p) const { return law_->quantile(value, p); }

std::string UncertainValues::law_text(std::size_t value) const { return law_->text(value); }

std::vector<std::string> UncertainValues::paths(std::size_t model) const {
  std::vector<std::string> paths;
  for (const UncertainValue& value : values_)
    for (const UncertainValue::Setting& setting : value.settings)
      if (setting.model == model) paths.push_back(setting.path);
  return paths;
}

std::vector<double> UncertainValues::numbers(std::size_t model, const std::vector<double>& values) const {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < values_.size(); ++i)
    for (const UncertainValue::Setting& setting : values_[i].settings)
      if (setting.model == model) numbers.push_back(setting.factor * values[i]);
  return numbers;
}

} // namespace steplap::assess
