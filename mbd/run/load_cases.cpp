#include "mbd/run/load_cases.h"

#include "mbd/base/name_pattern.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/read_input.h"
#include "mbd/run/findings.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <thread>
#include <tuple>

namespace steplap {

namespace {

using SharedModel = std::shared_ptr<const LoadedModel>;

bool applies(const LoadCase& one, const Criterion& criterion) {
  return one.criteria.empty() || std::any_of(one.criteria.begin(), one.criteria.end(),
                                             [&](const std::string& pattern) { return matches_pattern(criterion.name, pattern); });
}

SharedModel load_case(const LoadCase& one, const std::string& text, const std::string& path, const std::vector<std::string>& overrides,
                      const RunCatalogue& catalogue, std::vector<Diagnostic>& problems) {
  try {
    SharedModel loaded = load_model_text(text, path, overrides, catalogue);
    check_case_criteria(one, loaded->model, problems);
    if (one.criteria.empty()) return loaded;
    auto judged = std::make_shared<LoadedModel>(*loaded);
    keep_case_criteria(one, judged->model);
    return judged;
  } catch (const ModelError& error) {
    add_case_problems(one, error, problems);
    return nullptr;
  }
}

// Calls work(i) once for each i < count, on as many threads as there are processors. If calls throw, rethrows the exception of the lowest
// i.
template <class Work> void for_each_in_parallel(std::size_t count, const Work& work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> thrown(count);
  const auto take = [&] {
    for (std::size_t i = next++; i < count; i = next++) try {
        work(i);
      } catch (...) {
        thrown[i] = std::current_exception();
      }
  };
  {
    const std::size_t threads = std::min<std::size_t>(count, std::max(1U, std::thread::hardware_concurrency()));
    std::vector<std::jthread> helpers;
    for (std::size_t k = 1; k < threads; ++k) helpers.emplace_back(take);
    take();
  }
  for (const std::exception_ptr& exception : thrown)
    if (exception) std::rethrow_exception(exception);
}

// Returns the limit of each criterion. A judgement lists criteria of elements first, then criteria of the model.
std::vector<CaseLimit> limits_of(const Report& report, const std::vector<Utilisation>& utilisations) {
  const std::vector<CriterionResult>& criteria = report.judgement.criteria;
  const std::size_t of_elements = criteria.size() - report.run.loaded->model.criteria.size();
  std::vector<CaseLimit> limits;
  for (std::size_t i = 0; i < criteria.size(); ++i)
    limits.push_back({i < of_elements ? criteria[i].name + ": " + criteria[i].text : criteria[i].name, criteria[i], {}, {}});
  for (const Utilisation& used : utilisations)
    if (used.criterion) {
      limits[*used.criterion].share = used.share;
      limits[*used.criterion].share_error = used.error;
    }
  return limits;
}

SharedModel with_samples(const SharedModel& loaded, const CaseReading& reading) {
  if (!reading.take) return loaded;
  auto sampled = std::make_shared<LoadedModel>(*loaded);
  sampled->model.output.channels = reading.channels;
  sampled->model.output.step = reading.step;
  return sampled;
}

void run_case(const SharedModel& loaded, const RunOptions& options, const CaseReading& reading, std::size_t index, CaseResult& result) {
  try {
    const Report report = judged_run(with_samples(loaded, reading), options);
    if (reading.take) reading.take(index, report);
    const Overview overview = overview_of(report);
    result.judgement = report.judgement;
    result.reason = overview.reason;
    result.failure = report.run.failure ? report.run.failure->text : "";
    result.limits = limits_of(report, overview.utilisations);
  } catch (const NumericalFailure& failure) { // the run could not start
    result.judgement.verdict = Verdict::open;
    result.reason = result.failure = failure.what();
  }
}

bool is_less_severe(const CaseLimit& a, const CaseLimit& b) {
  return std::tuple(a.result.outcome, a.share.value_or(0.0)) < std::tuple(b.result.outcome, b.share.value_or(0.0));
}

// Returns true if `b` is more severe beyond both errors: of mirrored cases the first governs, whatever the rounding.
bool is_surely_less_severe(const CaseLimit& a, const CaseLimit& b) {
  const double errors = a.share_error.value_or(0.0) + b.share_error.value_or(0.0);
  const bool is_tie = a.result.outcome == b.result.outcome && std::abs(b.share.value_or(0.0) - a.share.value_or(0.0)) <= errors;
  return !is_tie && is_less_severe(a, b);
}

} // namespace

void add_case_problems(const LoadCase& one, const ModelError& error, std::vector<Diagnostic>& problems) {
  for (const Diagnostic& found : error.diagnostics()) {
    const std::string where = found.where.file.empty() ? "" : " (" + found.where.file + ")";
    problems.push_back({one.place("set"), "case '" + one.name + "': " + found.message + where});
  }
}

void check_case_criteria(const LoadCase& one, const Model& model, std::vector<Diagnostic>& problems) {
  std::vector<std::string> known;
  for (const Criterion& criterion : model.criteria) known.push_back(criterion.name);
  for (const std::string& pattern : one.criteria)
    if (std::none_of(known.begin(), known.end(), [&](const std::string& name) { return matches_pattern(name, pattern); }))
      problems.push_back(
          {one.place("criteria"), "case '" + one.name + "': no [[acceptance]] is called '" + pattern + "'" + did_you_mean(pattern, known)});
  if (!is_judged(model)) problems.push_back({one.where, "case '" + one.name + "' has no criteria: add an [[acceptance]] to the model"});
}

void keep_case_criteria(const LoadCase& one, Model& model) {
  std::erase_if(model.criteria, [&one](const Criterion& criterion) { return !applies(one, criterion); });
}

const CaseLimit* CaseResult::governing() const {
  return limits.empty() ? nullptr : &*std::max_element(limits.begin(), limits.end(), is_less_severe);
}

Verdict LoadCaseResults::verdict() const {
  Verdict worst = Verdict::hold;
  for (const CaseResult& one : cases) worst = std::max(worst, one.judgement.verdict);
  return worst;
}

namespace {

// Returns " Judged in no case: 'chains'." with all criteria of the models that no case judges; "" if there are none. A case whose run did not
// start has no limits.
std::string unjudged_text(const LoadCaseResults& results) {
  const auto judges = [](const CaseResult& one, const Criterion& criterion) {
    if (one.limits.empty()) return applies(one.load, criterion);
    return std::any_of(one.limits.begin(), one.limits.end(), [&](const CaseLimit& limit) { return limit.name == criterion.name; });
  };
  std::string names;
  for (const auto& model : results.models)
    for (const Criterion& criterion : model->model.criteria)
      if (std::none_of(results.cases.begin(), results.cases.end(), [&](const CaseResult& one) { return judges(one, criterion); }))
        names += (names.empty() ? "'" : ", '") + criterion.name + "'";
  return names.empty() ? names : " Judged in no case: " + names + ".";
}

} // namespace

std::string LoadCaseResults::reason() const {
  const auto decides = [this](const CaseResult& one) { return one.judgement.verdict == verdict(); };
  const std::string unjudged = unjudged_text(*this);
  if (verdict() == Verdict::hold) return counted(cases.size(), "case holds", "cases hold") + "." + unjudged;
  const auto first = std::find_if(cases.begin(), cases.end(), decides);
  const auto count = static_cast<std::size_t>(std::count_if(cases.begin(), cases.end(), decides));
  return "'" + first->load.name + "': " + first->reason +
         (count > 1 ? " " + counted(count - 1, "more case has", "more cases have") + " the same verdict." : "") + unjudged;
}

namespace {

// Refuses a value for all cases that a case replaces by its own: it would have no effect there.
void refuse_replaced(const LoadCase& one, const std::vector<std::string>& for_all, std::vector<Diagnostic>& problems) {
  const auto path_of = [](const std::string& setting) { return setting.substr(0, setting.find('=')); };
  for (const std::string& own : one.changes)
    for (const std::string& given : for_all)
      if (path_of(own) == path_of(given))
        problems.push_back({one.place("set"), "case '" + one.name + "' sets '" + path_of(own) +
                                                  "' itself, so that the value for all cases would not reach it: change it in the case"});
}

} // namespace

LoadCaseResults run_load_cases(const std::string& path, const std::vector<std::string>& overrides, const RunCatalogue& catalogue,
                               const RunOptions& options, const CaseReading& reading) {
  const std::string text = read_input(path, {}); // read once, so that all cases use the same text
  LoadCaseResults results{{load_model_text(text, shown_input(path), overrides, catalogue)}, {}};
  const Model& model = results.models.front()->model;
  const std::vector<LoadCase> cases = load_cases_of(model);
  if (cases.empty()) throw ModelError(model.header.where, "the model has no load cases: give each as [[case]]");
  std::vector<SharedModel> loaded;
  std::vector<Diagnostic> problems;
  for (const LoadCase& one : cases) {
    refuse_replaced(one, overrides, problems);
    std::vector<std::string> all = overrides;
    for (const std::string& own : one.overrides(model.header.gravity)) all.push_back(own);
    loaded.push_back(load_case(one, text, results.models.front()->path, all, catalogue, problems));
    results.cases.push_back({one, std::move(all), {}, "", "", {}});
  }
  if (!problems.empty()) throw ModelError(std::move(problems));
  for_each_in_parallel(cases.size(), [&](std::size_t i) { run_case(loaded[i], options, reading, i, results.cases[i]); });
  return results;
}

std::vector<LimitRow> limit_rows(const LoadCaseResults& results) {
  std::vector<LimitRow> rows;
  for (std::size_t k = 0; k < results.cases.size(); ++k)
    for (const CaseLimit& limit : results.cases[k].limits) {
      auto row = std::find_if(rows.begin(), rows.end(), [&](const LimitRow& r) { return r.name == limit.name; });
      if (row == rows.end()) row = rows.insert(rows.end(), {limit.name, std::vector<const CaseLimit*>(results.cases.size()), k});
      row->in_case[k] = &limit;
      if (is_surely_less_severe(*row->in_case[row->governing], limit)) row->governing = k;
    }
  return rows;
}

} // namespace steplap
