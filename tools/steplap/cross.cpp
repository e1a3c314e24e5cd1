#include "tools/steplap/cross.h"

#include "mbd/base/number_text.h"
#include "mbd/run/prominence.h"
#include "mbd/run/quantity_text.h"
#include "mbd/trust/cross_check.h"
#include "mbd/trust/judge.h"
#include "tools/steplap/log.h"
#include "tools/steplap/text_table.h"

#include <algorithm>
#include <cmath>
#include <ostream>

namespace steplap {

namespace {

using Align = TextTable::Align;

constexpr std::size_t k_shown_disagreements = 6;

std::string where_text(const Disagreement& d) {
  if (d.ratio == 0.0) return "-";
  std::string text = d.where;
  if (d.doubt == DisagreementKind::event || d.doubt == DisagreementKind::channel || d.doubt == DisagreementKind::law)
    text += " at " + time_text(d.t) + " s";
  if (text.empty() || d.doubt == DisagreementKind::self || d.doubt == DisagreementKind::momentum)
    text = std::string(name_of(d.doubt)) + (text.empty() ? "" : ", " + text);
  return text;
}

std::string ratio_text(double ratio) { return std::isfinite(ratio) ? small_text(ratio) : "beyond all"; }

std::string partner(const CrossRun& run) {
  const Disagreement& d = run.worst;
  return d.second.empty() ? "" : d.first == run.setting.integrator ? d.second : d.first;
}

void print_runs(std::ostream& out, const CrossCheck& check) {
  TextTable table({Align::left, Align::right, Align::right, Align::right, Align::right, Align::right, Align::left, Align::left});
  table.set_head("runs", {"method", "steps", "CPU s", "own error", "known to s", "worst", "with", "where"});
  for (const CrossRun& run : check.runs) {
    if (!run.failure.empty()) {
      table.add_row({run.setting.text(), "stops", Cell(small_text(run.cpu_seconds), run.cpu_seconds), "", "", "", "", ""});
      continue;
    }
    table.add_row({run.setting.text(), count_cell(static_cast<std::size_t>(run.result.statistics.steps)),
                   Cell(small_text(run.cpu_seconds), run.cpu_seconds), Cell(small_text(run.estimate), run.estimate),
                   Cell(time_text(run.known_until), run.known_until), Cell(ratio_text(run.worst.ratio), run.worst.ratio), partner(run),
                   where_text(run.worst)});
  }
  out << table;
}

void print_disagreements(std::ostream& out, const CrossCheck& check) {
  const std::size_t shown = std::min(check.disagreements.size(), k_shown_disagreements);
  for (std::size_t i = 0; i < shown; ++i) {
    const Disagreement& d = check.disagreements[i];
    out << "  " << d.first << (d.second.empty() ? "" : " and " + d.second) << (d.second.empty() ? ": " : " disagree: ") << where_text(d)
        << (d.text.empty() ? "" : ": " + d.text) << "\n";
  }
  if (check.disagreements.size() > shown) out << "  and " << check.disagreements.size() - shown << " more\n";
}

std::size_t finished_runs(const CrossCheck& check) {
  return static_cast<std::size_t>(std::count_if(check.runs.begin(), check.runs.end(), [](const CrossRun& r) { return r.failure.empty(); }));
}

// Two of six methods that reach the end may have in common what stops the others.
bool has_opinions(const CrossCheck& check) { return finished_runs(check) >= 2 && 2 * finished_runs(check) > check.runs.size(); }

std::string conclusion(const CrossCheck& check, double end) {
  if (finished_runs(check) < 2) return "NOT TO BE TRUSTED: there are no two opinions";
  if (!has_opinions(check))
    return "NOT TO BE TRUSTED: only " + std::to_string(finished_runs(check)) + " of " + std::to_string(check.runs.size()) +
           " methods reach the end";
  if (check.outcome == CrossOutcome::disagree) return "NOT TO BE TRUSTED: methods disagree beyond their error estimates";
  if (check.outcome == CrossOutcome::vague && check.known_until == 0.0)
    return "no disagreement, but time stepping has no opinion: its steps are too coarse for what happens here";
  if (check.outcome == CrossOutcome::vague)
    return "no disagreement, but no comparison is possible after " + time_text(check.known_until) + " s of " + number_text(end) +
           " s: small differences grow as large as the motion";
  const std::size_t finished = finished_runs(check);
  return (finished < check.runs.size() ? "all " + std::to_string(finished) + " that reach the end agree" : std::string("all agree")) +
         "; the worst disagreement is " + small_text(check.worst_ratio) + " of what the estimates allow";
}

CrossCheckOptions options_for(const LoadedModel& loaded, const System& system, double cpu_limit) {
  CrossCheckOptions options;
  options.cpu_limit = cpu_limit;
  options.is_event_counted = is_main_event;
  options.free_groups = free_groups(loaded.model, system);
  options.verdict = [&loaded, &system](const RunResult& run) { return std::string(name_of(judge(loaded.model, system, run, "").verdict)); };
  options.progress = [](const std::string& text) { log_detail(text); };
  return options;
}

bool cross_check_one(const LoadedModel& loaded, double cpu_limit, Console& console) {
  const SimulationOptions base = sampled_for_comparison(loaded.model);
  const std::unique_ptr<System> system = compile(loaded.model); // separate, because options of this check add channels to it
  add_audit_channels(*system, loaded.model);
  const CrossCheck check = cross_check(*system, initial_state_of(loaded), base, options_for(loaded, *system, cpu_limit));
  const bool is_trusted = check.outcome != CrossOutcome::disagree && has_opinions(check);
  for (const CrossRun& run : check.runs)
    if (!run.failure.empty()) log_warning("'" + loaded.path + "': " + run.setting.text() + ": " + run.failure);
  if (console.verbosity == Verbosity::quiet) return is_trusted;
  console.out << About{loaded.path} << loaded.path << ": t = 0 to " << number_text(base.end) << " s\n";
  print_runs(console.out, check);
  print_disagreements(console.out, check);
  console.out << loaded.name << ": " << conclusion(check, base.end) << "\n";
  return is_trusted;
}

} // namespace

ExitCode cross_check_models(const std::vector<std::shared_ptr<const LoadedModel>>& models, double cpu_limit, Console& console) {
  ExitCode code = ExitCode::done;
  const double start = thread_cpu_seconds();
  auto models_left = static_cast<double>(models.size());
  for (const auto& loaded : models) {
    const double granted = (cpu_limit - (thread_cpu_seconds() - start)) / models_left--;
    try {
      if (!cross_check_one(*loaded, granted, console)) code = ExitCode::numerical_failure;
    } catch (const NumericalFailure& failure) {
      log_error("'" + loaded->path + "': " + failure.what());
      code = ExitCode::numerical_failure;
    }
  }
  return code;
}

} // namespace steplap
