// Finds the uncertain numbers that change the decision if varied alone within the middle 99 % of their distribution, and the values at
// which it changes, by bisection between the nominal value and each end.
#include "tools/assess/hangs_on.h"

#include "mbd/base/shown_text.h"
#include "mbd/run/quantity_text.h"

#include <cmath>
#include <optional>

namespace steplap::assess {

namespace {

constexpr double k_tail = 0.005;   // tail probability of the ends of the distribution
constexpr double k_located = 0.01; // accuracy, relative to the distance from the nominal value to the end

struct ChangedDecision {
  double value = 0.0;
  VoyageSummary summary;
};

VoyageSummary with(const Assessment& a, std::size_t which, double value) {
  std::vector<double> values = a.uncertain->nominal();
  values[which] = value;
  return voyage_with(a.models, a.histories, *a.uncertain, values, a.shared).summary;
}

std::optional<ChangedDecision> changed_decision_towards(const Assessment& a, std::size_t which, double end) {
  const Decision own = decision_of(a, a.summary);
  const double start = a.uncertain->values()[which].nominal;
  ChangedDecision turn{end, with(a, which, end)};
  if (decision_of(a, turn.summary) == own) return {};
  double same = 0.0, other = 1.0;
  while (other - same > k_located) {
    const double middle = 0.5 * (same + other), value = start + middle * (end - start);
    VoyageSummary summary = with(a, which, value);
    if (decision_of(a, summary) == own) same = middle;
    else other = middle, turn = {value, std::move(summary)};
  }
  return turn;
}

} // namespace

void find_dependence(const AssessmentOptions& options, Assessment& a) {
  if (a.events.empty() || a.uncertain->empty() || options.sampling.samples <= 0 || !a.summary.unknown.empty()) return;
  const std::vector<UncertainValue>& values = a.uncertain->values();
  for (std::size_t i = 0; i < values.size(); ++i)
    for (const double p : {k_tail, 1.0 - k_tail}) {
      if (options.progress) options.progress("dependence of the decision", static_cast<long>(i), static_cast<long>(values.size()));
      const std::optional<ChangedDecision> turn = changed_decision_towards(a, i, a.uncertain->quantile(i, p));
      if (!turn) continue;
      const std::string why = turn->summary.slips && !a.summary.slips ? turn->summary.first_slip
                              : !turn->summary.unknown.empty()        ? turn->summary.unknown
                                                                      : turn->summary.limits.unmet;
      const Decision own = decision_of(a, a.summary);
      const std::string by_itself =
          own == a.decision ? "The decision" : "By the models' own values the decision would be \"" + std::string(name_of(own)) + "\". It";
      a.hangs_on.push_back(by_itself + " depends on the " + values[i].name + ": at " + quantity_text(turn->value, values[i].unit) +
                           " instead of " + quantity_text(values[i].nominal, values[i].unit) + " it is \"" +
                           name_of(decision_of(a, turn->summary)) + "\"" + (why.empty() ? "" : ", as " + why) + ".");
    }
  if (!a.hangs_on.empty()) return;
  std::string text = "No uncertain value alone, anywhere in the middle 99 % of its distribution, makes the decision another";
  std::size_t most = 0;
  for (std::size_t i = 1; i < a.shares.size(); ++i)
    if (a.shares[i] > a.shares[most]) most = i;
  if (!a.shares.empty())
    text += "; the margin of the joints hangs most on the " + values[most].name + " (" + rounded_text(100.0 * a.shares[most], 2) +
            " % of its scatter)";
  a.hangs_on.push_back(text + ".");
}

} // namespace steplap::assess
