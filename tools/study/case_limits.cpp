#include "tools/study/case_limits.h"

#include "mbd/model/completion.h"
#include "mbd/run/findings.h"
#include "mbd/run/load_cases.h"
#include "tools/study/expression.h"
#include "tools/study/sample_simulator.h"
#include "transformer/program.h"

#include <algorithm>
#include <cctype>

namespace steplap::study {

namespace {

using SharedStudyModel = std::shared_ptr<const StudyModel>;

// Returns a valid name for expressions: "limits_1_g_forward" for "1 g forward".
std::string identifier_of(const std::string& name, const Study& study) {
  std::string text = name;
  for (char& c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  if (!name_problem(text).empty()) text.insert(0, "limits_");
  const auto is_taken = [&](const std::string& wanted) {
    return study.index_of_variable(wanted) >= 0 ||
           std::any_of(study.limit_states.begin(), study.limit_states.end(), [&](const LimitState& l) { return l.name == wanted; });
  };
  std::string unique = text;
  for (int k = 2; is_taken(unique); ++k) unique = text + "_" + std::to_string(k);
  return unique;
}

void refuse_own_values(const LoadCase& one, const std::vector<std::string>& overrides, const Study& study,
                       std::vector<Diagnostic>& problems) {
  for (const Variable& v : study.variables)
    for (const std::string& path : v.paths)
      for (const std::string& setting : overrides)
        if (const std::string set = setting.substr(0, setting.find('=')); path == set || path.starts_with(set + "."))
          problems.push_back({one.place("set"), "case '" + one.name + "' sets '" + set + "' itself, so that variable '" + v.name +
                                                    "' would replace its value: leave one of them out"});
}

SharedStudyModel case_model(const StudyModel& model, const LoadCase& one, const Study& study, std::vector<Diagnostic>& problems) {
  const std::vector<std::string> overrides = one.overrides(model.given.header.gravity);
  refuse_own_values(one, overrides, study, problems);
  try {
    std::shared_ptr<StudyModel> made = read_study_model(model.path, overrides);
    made->file_name = model.name;
    made->name = one.name;
    made->load = one;
    check_case_criteria(one, completed(made->given), problems);
    return made;
  } catch (const ModelError& error) {
    add_case_problems(one, error, problems);
    return nullptr;
  }
}

void refuse_without_limits(const StudyModel& model, std::vector<Diagnostic>& problems) {
  if (steplap::is_judged(completed(model.given))) return;
  const Location where{model.path, 1, 1};
  problems.push_back({where, "model '" + model.name + "' has no limits: add an [[acceptance]], or give the study a [[limit_state]]"});
}

Response reserve_of(const StudyModel& model, const Study& study) {
  Response reserve;
  reserve.name = "reserve_" + identifier_of(model.name, study);
  reserve.model = model.name;
  reserve.what = "reserve";
  reserve.measure = Measure::reserve;
  reserve.where = model.load ? model.load->where : Location{model.path, 1, 1};
  return reserve;
}

void add_limits_of(const StudyModel& model, Study& study) {
  LimitState limit;
  Response reserve = reserve_of(model, study);
  limit.name = identifier_of(model.name, study);
  limit.where = reserve.where;
  limit.expression = reserve.name;
  study.responses.push_back(std::move(reserve));
  study.limit_states.push_back(std::move(limit));
}

void refuse_equal_names(const std::vector<SharedStudyModel>& models, const Study& study, std::vector<Diagnostic>& problems) {
  for (std::size_t i = 0; i < models.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (models[i]->name == models[j]->name)
        problems.push_back({models[i]->load ? models[i]->load->where : study.where,
                            "two load cases are called '" + models[i]->name + "': their results could not be distinguished"});
}

// Adds one model and one reserve response for each load case of `model`. Returns the formula of the least reserve, "min(a, b, …)".
std::string add_reserves_of(const StudyModel& model, LoadedStudy& loaded, std::vector<Response>& responses, const Location& where,
                            std::vector<Diagnostic>& problems) {
  const std::vector<LoadCase> cases = load_cases_of(model.given);
  if (cases.empty()) problems.push_back({where, "model '" + model.name + "' has no load cases: give each as [[case]]"});
  std::string names;
  for (const LoadCase& one : cases)
    if (SharedStudyModel made = case_model(model, one, loaded.study, problems)) {
      responses.push_back(reserve_of(*made, loaded.study));
      names += (names.empty() ? "" : ", ") + responses.back().name;
      loaded.models.push_back(std::move(made));
    }
  return "min(" + names + ")";
}

bool is_needed(const StudyModel& model, const Study& study) {
  const auto is_of_it = [&](const auto& one) { return one.model == model.name; };
  return model.load || std::any_of(study.responses.begin(), study.responses.end(), is_of_it) ||
         std::any_of(study.histories.begin(), study.histories.end(), is_of_it);
}

} // namespace

void add_reserves_of_cases(LoadedStudy& loaded) {
  Study& study = loaded.study;
  const std::vector<SharedStudyModel> models = loaded.models;
  const auto is_of_cases = [](const Response& r) { return r.what == k_reserve_of_cases; };
  if (std::none_of(study.responses.begin(), study.responses.end(), is_of_cases)) return;
  std::vector<Diagnostic> problems;
  std::vector<Response> responses;
  for (Response& r : study.responses) {
    const auto model = std::find_if(models.begin(), models.end(), [&](const SharedStudyModel& m) { return m->name == r.model; });
    if (is_of_cases(r) && model != models.end()) {
      r.expression = add_reserves_of(**model, loaded, responses, r.where, problems);
      r.measure = Measure::expression;
      r.model.clear();
    }
    responses.push_back(std::move(r));
  }
  refuse_equal_names(loaded.models, study, problems);
  if (!problems.empty()) throw ModelError(std::move(problems));
  study.responses = std::move(responses);
  std::erase_if(loaded.models, [&](const SharedStudyModel& model) { return !is_needed(*model, study); });
}

void add_limits_of_cases(LoadedStudy& loaded) {
  std::vector<Diagnostic> problems;
  std::vector<SharedStudyModel> models;
  for (const SharedStudyModel& model : loaded.models) {
    const std::vector<LoadCase> cases = load_cases_of(model->given);
    for (const LoadCase& one : cases)
      if (SharedStudyModel made = case_model(*model, one, loaded.study, problems)) models.push_back(std::move(made));
    if (!cases.empty()) continue;
    models.push_back(model);
    refuse_without_limits(*model, problems);
  }
  refuse_equal_names(models, loaded.study, problems);
  if (!problems.empty()) throw ModelError(std::move(problems));
  loaded.models = std::move(models);
  for (const SharedStudyModel& model : loaded.models) add_limits_of(*model, loaded.study);
}

const StudyModel* model_of_limit(const LoadedStudy& loaded, std::size_t limit) {
  const auto& responses = loaded.study.responses;
  if (limit >= responses.size() || responses[limit].measure != Measure::reserve) return nullptr;
  const auto found = std::find_if(loaded.models.begin(), loaded.models.end(),
                                  [&](const SharedStudyModel& model) { return model->name == responses[limit].model; });
  return found == loaded.models.end() ? nullptr : found->get();
}

std::string reason_of_verdict(const LoadedStudy& loaded, const StudyModel& model, const double* values) {
  try {
    Model whole = completed(model_with(loaded, model, values));
    std::unique_ptr<System> system = compile(whole);
    if (model.load) keep_case_criteria(*model.load, whole);
    return overview_of(judged_run(load_completed(std::move(whole), std::move(system), model.path))).reason;
  } catch (const NumericalFailure& failure) {
    return failure.what();
  } catch (const ModelError& error) {
    return error.what();
  }
}

} // namespace steplap::study
