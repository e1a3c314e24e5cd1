#include "tools/study/limit_function.h"

#include "tools/study/reliability.h"

#include <cmath>

namespace steplap::study {

double length_of(const double* u, std::size_t n) {
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += u[i] * u[i];
  return std::sqrt(sum);
}

LimitFunction::LimitFunction(StudyRun& run)
    : run_(run), settings_(settings_of<ReliabilitySettings>(run.study())), is_any_(settings_.combination == "any") {
  std::vector<std::string> names = settings_.limit_states;
  if (names.empty())
    for (const LimitState& l : run.study().limit_states) names.push_back(l.name);
  for (const std::string& name : names) places_.push_back(static_cast<std::size_t>(run.loaded.index_of_number(name)));
  for (const std::string& name : names) subject_ += (subject_.empty() ? "" : is_any_ ? " or " : " and ") + name;
}

const std::vector<LimitValue>& LimitFunction::at(const std::vector<double>& points) {
  const std::size_t n = dimension(), width = run_.study().variables.size(), count = points.size() / n;
  values_.resize(count * width);
  for (std::size_t i = 0; i < count; ++i) run_.law.values_at(&points[i * n], &values_[i * width]);
  const std::vector<StoredSample>& rows = run_.evaluator.evaluate(values_);
  limits_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Outcome& outcome = rows[i].outcome;
    LimitValue& limit = limits_[i];
    limit.is_missing = outcome.status != SampleStatus::ok && outcome.status != SampleStatus::undecided;
    limit.g = outcome.numbers[places_[0]];
    for (const std::size_t place : places_)
      limit.g = is_any_ ? std::min(limit.g, outcome.numbers[place]) : std::max(limit.g, outcome.numbers[place]);
    limit.is_bad = limit.is_missing || (outcome.status == SampleStatus::undecided && limit.g == 0.0);
    bad_ += limit.is_bad;
    if (limit.is_bad || limit.g >= 0.0) continue;
    const double distance = length_of(&points[i * n], n);
    if (distance >= nearest_) continue;
    nearest_ = distance;
    nearest_point_.assign(&points[i * n], &points[i * n] + n);
  }
  return limits_;
}

LimitValue LimitFunction::at_point(const std::vector<double>& u) { return at(u).front(); }

} // namespace steplap::study
