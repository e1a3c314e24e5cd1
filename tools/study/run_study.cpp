#include "tools/study/run_study.h"

#include "tools/study/kinds.h"
#include "tools/study/report_about.h"

#include <filesystem>
#include <stdexcept>

namespace steplap::study {

namespace {

// Notes the fitted distributions. If measurements contradict one, the answer is marked as not trusted.
void add_fits(const JointLaw& law, Answer& answer) {
  for (const JointLaw::Fit& fit : law.fits()) {
    answer.notes.push_back("Variable '" + fit.variable + "': " + fit.text + ".");
    if (fit.is_misfit) answer.degrade(Standing::not_trusted);
  }
}

// Notes the correlations, except for study kinds that set variables one by one and do not use the joint distribution.
void add_correlations(const Study& study, Answer& answer) {
  if (kind_of(study).draws_jointly) return;
  for (const Correlation& c : study.correlations)
    answer.notes.push_back("Variables are set one by one here, whatever the others are: the stated correlation of '" + c.between[0] +
                           "' and '" + c.between[1] + "' plays no part in it.");
}

Answer answer_of(const LoadedStudy& loaded, Store& store, const Ranks& ranks, const StudyOptions& options) {
  std::vector<Diagnostic> problems;
  const JointLaw law(loaded.study, loaded.nominal, problems); // the reader has already checked it
  store.describe(about_of(loaded, law));
  Evaluator evaluator(loaded, store, ranks, options.threads, [&options](const Pace& pace) {
    if (options.progress) options.progress(pace);
    if (!options.stop) return;
    if (const std::string why = options.stop(); !why.empty())
      throw StudyStopped(why + " after " + std::to_string(pace.samples) + " samples; repeat the command to continue");
  });
  StudyRun run{loaded, law, evaluator};
  Answer answer = kind_of(loaded.study).run(run);
  evaluator.store().forget_from(evaluator.asked() + 1);
  add_fits(law, answer);
  add_correlations(loaded.study, answer);
  return answer;
}

Answer run_first(const LoadedStudy& loaded, const std::string& path, const Ranks& ranks, const StudyOptions& options) {
  if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty()) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw StoreError(path, "the folder '" + folder.string() + "' cannot be made: " + error.message());
  }
  Store store(path, identity_of(loaded), options.mode);
  if (store.size() > 0 && options.note) options.note("going on with the " + std::to_string(store.size()) + " samples in '" + path + "'");
  Answer answer = answer_of(loaded, store, ranks, options);
  store.set_findings(answer.findings, answer.notes, name_of(answer.standing));
  return answer;
}

// Ends the work of the other ranks at the end of the scope, also after an exception.
class Dismissal {
public:
  explicit Dismissal(const Ranks& ranks) : ranks_(ranks) {}
  Dismissal(const Dismissal&) = delete;
  Dismissal& operator=(const Dismissal&) = delete;
  ~Dismissal() { Evaluator::dismiss(ranks_); }

private:
  const Ranks& ranks_;
};

} // namespace

std::optional<Answer> run_study(const LoadedStudy& loaded, const std::string& path, const Ranks& ranks, const StudyOptions& options) {
  if (options.threads < 1) throw std::invalid_argument("StudyOptions::threads is less than 1");
  if (!ranks.is_first()) {
    Evaluator::serve(loaded, ranks, options.threads);
    return std::nullopt;
  }
  const Dismissal others(ranks);
  return run_first(loaded, path, ranks, options);
}

} // namespace steplap::study
