#include "tools/steplap/case_planes.h"

#include "elements/views/friction_plane.h"
#include "mbd/base/shown_text.h"
#include "mbd/run/report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

namespace steplap {

namespace {

constexpr double k_step = 1e-3;     // output step, s: 10 samples per period at 100 Hz; contacts of heavy machines vibrate more slowly
constexpr double k_samples = 200e3; // largest number of output samples; long runs get a larger step

/// Friction of one shared element during one load case in one plane.
struct CaseFriction {
  FrictionPlane plane;
  SampledFriction trace;
  std::optional<double> error; ///< sum of the estimated errors of friction and capacity, N; NaN: unknown; empty: not estimated
};

/// One of the two models, which shows the machine in one plane, with its load cases and their results.
struct Plane {
  std::shared_ptr<const LoadedModel> loaded;
  FrictionNames frictions;
  std::vector<LoadCase> cases;
  std::vector<std::map<std::string, CaseFriction>> traced; ///< friction histories: one map per load case, with the element's name as key

  explicit Plane(std::shared_ptr<const LoadedModel> model)
      : loaded(std::move(model)), frictions(friction_names(loaded->model)), cases(load_cases_of(loaded->model)), traced(cases.size()) {}
};

using Planes = std::array<Plane, 2>;
using CasePair = std::array<std::size_t, 2>;

std::vector<CasePair> shared_cases(const Planes& planes) {
  std::vector<CasePair> pairs;
  for (std::size_t i = 0; i < planes[0].cases.size(); ++i)
    for (std::size_t k = 0; k < planes[1].cases.size(); ++k)
      if (planes[0].cases[i].name == planes[1].cases[k].name) pairs.push_back({i, k});
  return pairs;
}

std::vector<std::string> shared_frictions(const Planes& planes) {
  std::vector<std::string> names;
  for (const auto& [name, elements] : planes[0].frictions)
    if (planes[1].frictions.contains(name)) names.push_back(name);
  return names;
}

Location first_friction(const Plane& plane) {
  for (const ElementEntry& entry : plane.loaded->model.elements)
    for (const auto& [name, elements] : plane.frictions)
      if (elements.front() == entry.element->name) return entry.element->where;
  return plane.cases.front().where;
}

void check_planes(const Planes& planes) {
  const std::string first = "'" + planes[0].loaded->path + "'";
  for (const Plane& plane : planes)
    if (plane.cases.empty()) throw ModelError(plane.loaded->model.header.where, "the model has no load cases: give each as [[case]]");
  std::vector<Diagnostic> problems;
  const std::vector<CasePair> pairs = shared_cases(planes);
  if (pairs.empty())
    problems.push_back({planes[1].cases.front().where,
                        "no [[case]] has the name of one in " + first + ": give the cases that act in both planes one name"});
  else if (shared_frictions(planes).empty())
    problems.push_back(
        {first_friction(planes[1]),
         "no friction has the name of one in " + first +
             ": give the friction that carries both planes one name, which a coulomb_stick may have as its 'shared_friction'"});
  for (const auto& [i, k] : pairs) {
    const LoadCase &one = planes[0].cases[i], &other = planes[1].cases[k];
    if (one.plane.empty() || other.plane.empty() || one.plane == other.plane)
      problems.push_back(
          {other.place("plane"), "case '" + other.name + "' is in " + first +
                                     ", too: its 'plane' has to be lengthwise in one of the models and transverse in the other"});
  }
  if (!problems.empty()) throw ModelError(std::move(problems));
}

// Returns gravity at rest, m/s²: the load case's `pull` (m/s²) is included in the model's gravity and counts as a load.
Vec2 gravity_of(const Model& model, const LoadCase& one) { return model.header.gravity - one.pull.value_or(Vec2::Zero()); }

// Returns the summed errors of friction and capacity of these elements, at both extremes of each channel, N. NaN: unknown; empty: not
// estimated.
std::optional<double> error_of(const Report& report, const std::vector<std::string>& elements) {
  if (!report.estimate.errors) return {};
  double sum = 0.0;
  for (const std::string& element : elements)
    for (const char* const name : {".friction", ".capacity"})
      if (const ChannelRange* const range = report.find(element + name))
        for (double ChannelError::*const end : {&ChannelError::low, &ChannelError::high}) sum += *report.error_of(*range, end);
  return sum;
}

void take_traces(const Report& report, const LoadCase& one, const std::vector<std::string>& shared, double step, const FrictionNames& names,
                 std::map<std::string, CaseFriction>& traced) {
  if (report.run.failure) return;
  const LoadedModel& loaded = *report.run.loaded;
  for (const std::string& name : shared) {
    const std::vector<std::string>& elements = names.at(name);
    std::optional<FrictionPlane> plane = friction_plane(*loaded.system, name, elements, gravity_of(loaded.model, one), loaded.path);
    if (!plane) continue;
    plane->model_name = loaded.name;
    const std::vector<SampledFriction> traces = friction_traces(loaded.model, *loaded.system, report.run.result, elements, 0.0, step);
    traced[name] = {*plane, sum_of_traces(traces), error_of(report, elements)};
  }
}

LoadCaseResults run_plane(Plane& plane, const std::string& path, const std::vector<std::string>& shared,
                          const std::vector<std::string>& overrides, const RunCatalogue& catalogue, const RunOptions& options) {
  const double end = plane.loaded->model.simulation.end;
  CaseReading reading;
  reading.step = std::min(end, std::max(k_step, end / k_samples));
  for (const std::string& name : shared)
    for (const std::string& channel : traced_channels(plane.frictions.at(name))) reading.channels.push_back(channel);
  reading.take = [&](std::size_t i, const Report& report) {
    take_traces(report, plane.cases[i], shared, reading.step, plane.frictions, plane.traced[i]);
  };
  return run_load_cases(path, overrides, catalogue, options, reading);
}

// Utilisation of a shared friction by the loads of both planes, as a limit of the load case. `doubt` is one sentence that says why this
// friction may slip; empty if it holds.
struct BothPlanes {
  CaseLimit limit;
  std::string doubt;
};

BothPlanes both_planes(const std::string& name, const CaseFriction& one, const CaseFriction& other) {
  BothPlanes both;
  CriterionResult& result = both.limit.result;
  const SharedContact contact{name, {&one.plane, &other.plane}, {one.trace.normal.front(), other.trace.normal.front()}};
  if (const std::string contradiction = contact.disagreement(); !contradiction.empty()) {
    both.doubt = "Of both planes: " + contradiction + ".";
    return both;
  }
  const SharedUse use = shared_use(contact, {one.trace, other.trace});
  result.value = both.limit.share = use.use;
  constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();
  const double force_error = one.error.value_or(k_unknown) + other.error.value_or(k_unknown);
  const double error = use.capacity > 0.0 ? use.error + force_error / use.capacity : 0.0;
  result.error = both.limit.share_error = error;
  result.t = use.at;
  result.reserve = 1.0 - use.use;
  const std::string asked = "Both planes together ask for " + rounded_text(100.0 * use.use, 4) + " % of the friction '" + name + "'";
  if (use.slips) both.doubt = asked + ", and how far they slide is not computed.";
  else if (const bool is_estimated = one.error && other.error; is_estimated && std::isnan(error))
    both.doubt = asked + ", and the error of that is unknown.";
  else if (use.use < 1.0 && use.use + error >= 1.0) both.doubt = asked + ", which is known to " + rounded_text(100.0 * error, 2) + " %.";
  return both;
}

BothPlanes both_planes(const std::string& name, const CaseResult& one, const CaseResult& other,
                       const std::map<std::string, CaseFriction>& traced, const std::map<std::string, CaseFriction>& other_traced) {
  BothPlanes both;
  const auto first = traced.find(name), second = other_traced.find(name);
  for (const CaseResult* result : {&one, &other})
    if (!result->failure.empty()) both.doubt = "The run of '" + result->load.name + "' did not reach its end.";
  if (!both.doubt.empty()) return both;
  if (first != traced.end() && second != other_traced.end()) return both_planes(name, first->second, second->second);
  both.doubt = "The friction '" + name + "' has no face of fixed direction, so what both planes ask of it is not known.";
  return both;
}

void add_limit(const BothPlanes& both, CaseResult& one) {
  one.limits.push_back(both.limit);
  one.judgement.criteria.push_back(both.limit.result);
  if (both.doubt.empty()) return;
  if (one.judgement.verdict == Verdict::hold) one.reason = both.doubt;
  add_cap(one.judgement, both.doubt);
}

void hold_against_both(const std::string& name, CaseResult& one, CaseResult& other, const std::map<std::string, CaseFriction>& traced,
                       const std::map<std::string, CaseFriction>& other_traced) {
  BothPlanes both = both_planes(name, one, other, traced, other_traced);
  CriterionResult& result = both.limit.result;
  both.limit.name = result.name = name + " in both planes";
  result.text = "both planes together use at most what the friction holds";
  result.where = name;
  result.limit = 1.0;
  result.outcome = both.doubt.empty() ? Verdict::hold : Verdict::open;
  add_limit(both, one);
  add_limit(both, other);
}

} // namespace

LoadCaseResults run_planes(const std::array<std::string, 2>& paths, const std::vector<std::string>& overrides,
                           const RunCatalogue& catalogue, const RunOptions& options) {
  const auto models = load_models({paths[0], paths[1]}, overrides, catalogue);
  Planes planes{Plane(models[0]), Plane(models[1])};
  check_planes(planes);
  const std::vector<std::string> shared = shared_frictions(planes);
  LoadCaseResults results = run_plane(planes[0], paths[0], shared, overrides, catalogue, options);
  LoadCaseResults second = run_plane(planes[1], paths[1], shared, overrides, catalogue, options);
  for (const auto& [i, k] : shared_cases(planes)) {
    CaseResult &one = results.cases[i], &other = second.cases[k];
    for (CaseResult* result : {&one, &other}) result->load.name += " (" + result->load.plane + ")";
    for (const std::string& name : shared) hold_against_both(name, one, other, planes[0].traced[i], planes[1].traced[k]);
  }
  results.models.push_back(second.models.front());
  std::move(second.cases.begin(), second.cases.end(), std::back_inserter(results.cases));
  return results;
}

} // namespace steplap
