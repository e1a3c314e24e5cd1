#include "tools/study/influence.h"

#include "mbd/base/shown_text.h"
#include "tools/study/reliability.h"

#include <algorithm>
#include <cmath>

namespace steplap::study {

namespace {

constexpr double k_half = 0.5, k_move = 0.1; // of the standard deviation, and of the mean

std::string name_of(const JointLaw::Change& change) {
  if (change.stretch != 1.0) return "probability with half the scatter of ";
  return change.shift > 0.0 ? "probability with a mean 10 % larger of " : "probability with a mean 10 % smaller of ";
}

std::string too_few(double effective) {
  return "not known from these samples: " + rounded_text(effective, 3) + " effective failures carry it, too few";
}

bool is_better(const Finding& a, const Finding& b) { return a.value < b.value || (std::isfinite(a.value) && std::isnan(b.value)); }

} // namespace

Influence::Influence(const JointLaw& law) : law_(&law) {
  for (std::size_t place = 0; place < law.dimension(); ++place) {
    Variable variable;
    variable.changed.push_back({{0.0, k_half}});
    const double move = k_move * std::abs(law.mean(place));
    if (move > 0.0) variable.changed.insert(variable.changed.end(), {Changed{{-move, 1.0}}, Changed{{move, 1.0}}});
    variables_.push_back(std::move(variable));
  }
}

void Influence::add(const double* u, double weight, const LimitValue& value) {
  ++count_;
  bad_ += value.is_bad;
  if (!value.is_bad && value.g >= 0.0) return;
  for (std::size_t place = 0; place < variables_.size(); ++place)
    for (Changed& changed : variables_[place].changed) {
      const double w = weight * law_->density_ratio(u, place, changed.change);
      changed.unsafe.add(w);
      changed.safe.add(value.is_bad ? 0.0 : w);
    }
  if (value.is_bad) return;
  failures_.add(weight);
  std::vector<double> values(law_->nominal().size());
  law_->values_at(u, values.data());
  for (std::size_t place = 0; place < variables_.size(); ++place) {
    Variable& variable = variables_[place];
    const double x = (values[law_->random()[place]] - law_->mean(place)) / law_->standard_deviation(place);
    variable.sum += weight * x;
    variable.square_sum += weight * weight * x;
    variable.squares += weight * weight * x * x;
  }
}

Finding Influence::changed_probability(const LimitFunction& limit, std::size_t place, const Changed& changed) const {
  const Study& study = limit.study();
  WeightedMean safe = changed.safe, unsafe = changed.unsafe;
  safe.add_zeros(count_ - safe.count());
  unsafe.add_zeros(count_ - unsafe.count());
  const WeightedMean &low = study.failed == "unsafe" ? unsafe : safe, &high = study.failed == "safe" ? safe : unsafe;
  Finding f{"", limit.subject(), name_of(changed.change) + study.variables[law_->random()[place]].name};
  constexpr double k_negligible = 0.01; // of the probability
  if (low.effective() < k_fewest_failures) f.status = too_few(low.effective());
  else if (law_->unreachable_share(place, changed.change) > k_negligible * low.mean())
    f.status = "not known from these samples: the changed distribution takes values that the present one does not take";
  if (!f.status.empty()) return f;
  const double confidence = limit.settings().confidence;
  f.value = high.mean();
  f.low = low.interval(confidence).low;
  f.high = high.interval(confidence).high;
  return f;
}

// The mean of the values x of failures is m = Σ w x/Σ w, with the variance Σ w² (x − m)²/(Σ w)² to first order in the scatter of both sums.
Finding Influence::failing_mean(const LimitFunction& limit, std::size_t place) const {
  const Variable& variable = variables_[place];
  Finding f{"", limit.study().variables[law_->random()[place]].name, "mean given failure"};
  const double weights = failures_.mean() * static_cast<double>(failures_.count()), mean = variable.sum / weights,
               square_weights = weights * weights / failures_.effective();
  const double variance = variable.squares - 2.0 * mean * variable.square_sum + mean * mean * square_weights;
  const double half = student_quantile(failures_.effective() - 1.0, 0.5 * (1.0 + limit.settings().confidence)) *
                      std::sqrt(std::max(0.0, variance)) / weights;
  const auto value = [&](double x) { return law_->mean(place) + law_->standard_deviation(place) * x; };
  f.value = value(mean);
  f.low = value(mean - half);
  f.high = value(mean + half);
  if (bad_ > 0) f.status = counted(static_cast<std::size_t>(bad_), "sample", "samples") + " without a result left out";
  return f;
}

// `changed`: with half the scatter, and with another mean, if there is one.
std::string Influence::sentence(const LimitFunction& limit, std::size_t place, double present, const std::vector<Finding>& changed) const {
  const auto text = [](double p) { return rounded_text(p, 3); };
  std::string words = "'" + limit.study().variables[law_->random()[place]].name +
                      "' matters most: half its scatter would change the probability from " + text(present) + " to " +
                      text(changed.front().value);
  const auto safest = std::min_element(changed.begin() + 1, changed.end(), is_better);
  if (safest != changed.end() && std::isfinite(safest->value))
    words += (safest == changed.begin() + 1 ? ", a mean 10 % smaller to " : ", a mean 10 % larger to ") + text(safest->value);
  return words + ".";
}

void Influence::add_findings(const LimitFunction& limit, const Finding& estimate, Answer& answer) const {
  if (failures_.effective() < k_fewest_failures) return;
  Finding most; // with half the scatter of the variable that matters most
  std::string note;
  bool is_any_unknown = false; // what is not known may matter most
  for (std::size_t place = 0; place < variables_.size(); ++place) {
    std::vector<Finding> findings;
    for (const Changed& changed : variables_[place].changed) findings.push_back(changed_probability(limit, place, changed));
    is_any_unknown = is_any_unknown || std::isnan(findings.front().value);
    if (is_better(findings.front(), most)) {
      most = findings.front();
      note = sentence(limit, place, estimate.value, findings);
    }
    findings.push_back(failing_mean(limit, place));
    for (Finding& f : findings) {
      f.method = estimate.method;
      f.samples = count_;
      answer.findings.push_back(std::move(f));
    }
  }
  if (!is_any_unknown) answer.notes.push_back(note);
}

} // namespace steplap::study
