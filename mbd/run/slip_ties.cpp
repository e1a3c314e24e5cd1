#include "mbd/run/slip_ties.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/trust/global_error.h"
#include "mbd/trust/judge.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace steplap {

namespace {

// Utilisations closer to 1 than this depend on rounding of coefficients, stiffness and dimensions.
constexpr double k_knife_edge = 1e-5;

// Returns the error of the time, s, of the event at which the tie occurred; 0 if unknown.
double time_error(const SimultaneousSlip& tie, const RunResult& result, const GlobalErrorEstimate* errors) {
  if (!errors) return 0.0;
  for (std::size_t i = 0; i < result.events.size() && i < errors->event_times.size(); ++i)
    if (result.events[i].t == tie.t && result.events[i].element == tie.slips)
      return std::isfinite(errors->event_times[i]) ? errors->event_times[i] : 0.0;
  return 0.0;
}

Finding finding_of(const SimultaneousSlip& tie, const LoadedModel& loaded) {
  Finding finding;
  for (const ElementEntry& entry : loaded.model.elements)
    if (entry.element->name == tie.sticks) finding.where = entry.element->where;
  const double per_cent = std::max(100.0 * (1.0 - tie.share), 1e-9);
  finding.text = "'" + tie.slips + "' slips at t = " + rounded_text(tie.t, 6) + " s, where '" + tie.sticks + "' is within " +
                 rounded_text(per_cent, 2) + " % of what it holds";
  return finding;
}

} // namespace

std::vector<Finding> slip_ties(const Run& run, const RunOptions& options, const Judgement& judgement, const GlobalErrorEstimate* errors,
                               int most_runs) {
  if (run.failure || !judgement.has_criteria) return {};
  std::map<std::pair<std::string, std::string>, SimultaneousSlip> nearest;
  for (const SimultaneousSlip& tie : run.result.ties) {
    if (!(1.0 - tie.share <= k_knife_edge + std::abs(tie.rate) * time_error(tie, run.result, errors))) continue;
    SimultaneousSlip& known = nearest.try_emplace({std::min(tie.slips, tie.sticks), std::max(tie.slips, tie.sticks)}, tie).first->second;
    if (tie.share > known.share) known = tie;
  }
  if (nearest.empty()) return {};
  std::vector<SimultaneousSlip> ties;
  for (auto& [names, tie] : nearest) ties.push_back(tie);
  std::stable_sort(ties.begin(), ties.end(), [](const SimultaneousSlip& a, const SimultaneousSlip& b) { return a.share > b.share; });
  const LoadedModel& loaded = *run.loaded;
  const Verdict verdict = judge(loaded.model, *loaded.system, run.result, "").so_far;
  std::vector<Finding> findings;
  for (const SimultaneousSlip& tie : ties) {
    if (most_runs-- == 0) break;
    SimulationOptions other = simulation_options(loaded, options);
    other.other_slip = tie;
    Finding finding = finding_of(tie, loaded);
    finding.code = "slip_tie";
    finding.level = FindingLevel::note;
    if (options.estimating == Estimating::never) {
      finding.text += "; whether the verdict depends on which slips first was not found out, as no further runs are to be made";
      findings.push_back(std::move(finding));
      continue;
    }
    try {
      Simulation simulation(*loaded.system, options.start ? *options.start : initial_state_of(loaded), std::move(other));
      simulation.run();
      const RunResult result = std::move(simulation).result();
      const Verdict otherwise = judge(loaded.model, *loaded.system, result, "").so_far;
      if (otherwise == verdict) {
        finding.text += "; the verdict is the same whichever slips first";
      } else {
        finding.level = FindingLevel::warning;
        finding.text += ". If '" + tie.sticks + "' slips first, the verdict is \"" + name_of(otherwise) + "\" instead of \"" +
                        name_of(verdict) + "\": it changes if the friction of '" + tie.sticks +
                        "' is lower by that share. Give coefficients that "
                        "are known better, or decide by the worse of the two";
      }
    } catch (const NumericalFailure& failure) {
      finding.text += "; whether the verdict depends on which slips first is not known: " + std::string(failure.what());
    }
    findings.push_back(std::move(finding));
  }
  return findings;
}

} // namespace steplap
