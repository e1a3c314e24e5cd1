#include "mbd/run/report.h"

#include "mbd/base/stop.h"
#include "mbd/run/blows.h"
#include "mbd/run/findings.h"
#include "mbd/run/plausible_run.h"
#include "mbd/run/quantity_text.h"
#include "mbd/run/result_files.h"
#include "mbd/run/slip_ties.h"
#include "mbd/run/with_settings.h"
#include "mbd/trust/judge.h"
#include "mbd/trust/weighed_errors.h"

namespace steplap {

const ChannelRange* Report::find(const std::string& channel) const {
  for (const ChannelRange& range : ranges())
    if (range.channel->name == channel) return &range;
  return nullptr;
}

// The ranges contain all channels of the system, in its order; their index is that of the error.
std::optional<double> Report::error_of(const ChannelRange& range, double ChannelError::*which) const {
  if (!estimate.errors) return {};
  return estimate.errors->channels[static_cast<std::size_t>(&range - ranges().data())].*which;
}

std::optional<double> Report::event_error(std::size_t i) const {
  return estimate.errors ? std::optional(estimate.errors->event_times[i]) : std::nullopt;
}

std::optional<double> Report::dissipated_error() const {
  return estimate.errors ? std::optional(estimate.errors->dissipated) : std::nullopt;
}

std::optional<double> Report::work_error() const { return estimate.errors ? std::optional(estimate.errors->work) : std::nullopt; }

Columns Report::columns() const {
  const Trajectory& trajectory = *run.result.trajectory;
  Columns block{{"t"}, {"s"}, {}};
  for (const Channel* channel : trajectory.channels()) {
    block.names.push_back(channel->name);
    block.units.push_back(channel->unit);
  }
  block.values.resize(static_cast<Eigen::Index>(trajectory.size()), static_cast<Eigen::Index>(block.names.size()));
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const auto row = trajectory.row(i);
    for (std::size_t c = 0; c < row.size(); ++c) block.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = row[c];
  }
  return block;
}

std::string Report::json() const { return summary_json(*this, {}); }

void Report::write(const std::string& folder, bool is_overwriting) const { write_results(folder, result_files(*this), is_overwriting); }

namespace {

// Applies the error estimate to the verdict. If the estimate failed or is too expensive, criteria that are met stay open. If the user left
// it out, the verdict is unchanged.
void weigh(Report& report) {
  const Run& run = report.run;
  if (report.estimate.errors) weigh_errors(report.judgement, run.loaded->model, *run.loaded->system, run.result, *report.estimate.errors);
  if (report.estimate.status == EstimateStatus::failed) leave_open(report.judgement, "the finer run failed");
  if (report.estimate.status == EstimateStatus::too_expensive) leave_open(report.judgement, report.estimate.reason);
}

void add_finding(Report& report, const Finding& finding, const RunOptions& options) {
  if (options.note) options.note(finding);
  report.findings.push_back(finding);
}

// Runs the second method if the verdict is "hold", because only this verdict can change.
void ask_second_opinion(Report& report, const RunOptions& options) {
  const bool is_stopped = options.stop && !options.stop().empty();
  if (!options.has_second_opinion || report.judgement.verdict != Verdict::hold || is_stopped) return;
  report.second_opinion = second_opinion(report.run, options, !report.estimate.errors);
  if (const std::string& what = report.second_opinion->disagreement; !what.empty())
    distrust(report.judgement, "a second method disagrees beyond both errors: " + what);
  // A "hold" requires that the numbers were checked to the end, by the error estimate or by the second method.
  const SecondOpinion& second = *report.second_opinion;
  if (second.reaches(report.run.result.final_state.t) || report.estimate.errors) return;
  add_cap(report.judgement, second.none_because.empty()
                                ? "nothing has checked its numbers after t = " + quantity_text(second.known_until, "s") +
                                      ": the errors are not estimated (" + report.estimate.reason + "), and " + second.method +
                                      " cannot be compared from there on"
                                : "nothing has checked its numbers: the errors are not estimated (" + report.estimate.reason +
                                      "), and no second method can run the scene (" + second.none_because + ")");
}

} // namespace

Report report_on(Run run, std::vector<Finding> before, const RunOptions& options) {
  const StopScope stopping(options.stop);
  Report report;
  report.run = std::move(run);
  const LoadedModel& loaded = *report.run.loaded;
  const RunResult& result = report.run.result;
  report.findings = std::move(before);
  for (const Finding& finding : findings_after(loaded, result)) add_finding(report, finding, options);
  if (!options.start) {
    for (const Finding& finding : distant_rest_findings(loaded, result)) add_finding(report, finding, options);
    if (report.run.rest)
      for (const Finding& finding : start_slides(loaded, *report.run.rest)) add_finding(report, finding, options);
  }
  for (const Event& event : result.events) ++report.event_counts[words_of(event.kind)];
  const RunStatistics& s = result.statistics;
  if (s.energy_exchanged > 0.0) report.relative_energy_residual = s.energy_residual / s.energy_exchanged;
  report.judgement = judge(loaded.model, *loaded.system, result, report.run.failure ? report.run.failure->text : "");
  leave_impacts_open(report.judgement, loaded, result);
  if (!report.run.failure)
    for (const Finding& finding : findings_at_end(loaded, result, report.judgement)) add_finding(report, finding, options);
  for (const ElementEntry& entry : loaded.model.elements)
    if (const auto assess = loaded.views->of(*entry.kind).assess) report.joints.push_back(assess(*entry.element, loaded.model, result));
  for (const Finding& finding : report.findings) {
    if (finding.code == "contact_too_deep") distrust(report.judgement, text_with_place(finding));
    else if (report.judgement.has_criteria && caps_verdict(finding)) add_cap(report.judgement, text_with_place(finding));
  }
  if (!options.has_extremes) // without extremes it is unknown whether the capacity of a monitored joint was exceeded
    add_cap(report.judgement, "extremes were not looked for, by which a run is judged and trusted");
  const bool is_decisive = report.judgement.has_criteria && report.judgement.verdict == Verdict::hold;
  report.estimate = estimate_errors(report.run, options, is_decisive);
  if (report.estimate.balance) {
    add_finding(report, balance_finding(loaded, *report.estimate.balance), options);
    add_cap(report.judgement, text_with_place(report.findings.back()));
  }
  if (const std::string& why = report.estimate.balance_unknown; !why.empty()) add_finding(report, balance_unknown_finding(why), options);
  const GlobalErrorEstimate* const errors = report.estimate.errors ? &*report.estimate.errors : nullptr;
  for (const Finding& finding : slip_ties(report.run, options, report.judgement, errors)) {
    add_finding(report, finding, options);
    if (caps_verdict(finding)) add_cap(report.judgement, text_with_place(finding));
  }
  weigh(report);
  ask_second_opinion(report, options);
  if (const std::string why = options.stop && !report.run.failure ? options.stop() : ""; !why.empty())
    add_cap(report.judgement, why + " before all checks of the finished run were made");
  return report;
}

Report judged_run(std::shared_ptr<const LoadedModel> as_loaded, const RunOptions& options) {
  std::shared_ptr<const LoadedModel> loaded = with_settings(std::move(as_loaded), options);
  std::vector<Finding> before = findings_before(*loaded);
  if (options.note)
    for (const Finding& finding : before) options.note(finding);
  Run run = run_model(std::move(loaded), options);
  return report_on(std::move(run), std::move(before), options);
}

} // namespace steplap
