#include "tools/study/limit_function.h"

#include "tools/study/reliability.h"

#include <algorithm>
#include <cmath>

namespace steplap::study {

double length_of(const double* u, std::size_t n) {
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += u[i] * u[i];
  return std::sqrt(sum);
}

LimitSystem::LimitSystem(const LoadedStudy& loaded, const std::vector<std::string>& names, bool is_any) : is_any_(is_any) {
  for (const std::string& name : names) places_.push_back(static_cast<std::size_t>(loaded.index_of_number(name)));
  for (const std::string& name : names) text_ += (text_.empty() ? "" : is_any_ ? " or " : " and ") + name;
}

LimitValue LimitSystem::value_of(const Outcome& outcome) const {
  LimitValue limit;
  limit.is_missing = outcome.status != SampleStatus::ok && outcome.status != SampleStatus::undecided;
  limit.g = outcome.numbers[places_[0]];
  for (const std::size_t place : places_)
    limit.g = is_any_ ? std::min(limit.g, outcome.numbers[place]) : std::max(limit.g, outcome.numbers[place]);
  limit.is_bad = limit.is_missing || (outcome.status == SampleStatus::undecided && limit.g == 0.0);
  return limit;
}

namespace {

// Returns the limit states whose failure is failure of the system; those used by [[evidence]] only are excluded.
std::vector<std::string> names_of_system(const Study& study) {
  const std::vector<std::string>& asked = settings_of<ReliabilitySettings>(study).limit_states;
  if (!asked.empty()) return asked;
  std::vector<std::string> names;
  for (const LimitState& l : study.limit_states)
    if (std::none_of(study.evidence.begin(), study.evidence.end(), [&](const Evidence& e) {
          return std::find(e.limit_states.begin(), e.limit_states.end(), l.name) != e.limit_states.end();
        }))
      names.push_back(l.name);
  return names;
}

} // namespace

LimitFunction::LimitFunction(StudyRun& run)
    : run_(run), settings_(settings_of<ReliabilitySettings>(run.study())),
      system_(run.loaded, names_of_system(run.study()), settings_.combination == "any") {}

const std::vector<LimitValue>& LimitFunction::at(const std::vector<double>& points) {
  const std::size_t n = dimension(), width = run_.study().variables.size(), count = points.size() / n;
  values_.resize(count * width);
  for (std::size_t i = 0; i < count; ++i) run_.law.values_at(&points[i * n], &values_[i * width]);
  const std::vector<StoredSample>& rows = run_.evaluator.evaluate(values_);
  limits_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    LimitValue& limit = limits_[i];
    limit = system_.value_of(rows[i].outcome);
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
