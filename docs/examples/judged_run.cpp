// Runs a model with error estimate and verdict, and writes the same files as `steplap simulate`:
//   judged_run braked_block.toml out/braked_block [simulation.end=0.5 …]
#include <steplap/judged_run.h>

#include <cmath>
#include <cstdio>

using namespace steplap;

int main(int argc, char** argv) try {
  if (argc < 3) {
    std::fprintf(stderr, "usage: judged_run MODEL.toml FOLDER [path=value …]\n");
    return 2;
  }
  RunOptions options;
  options.note = [](const Finding& finding) { std::printf("note: %s\n", text_with_place(finding).c_str()); };
  const Report report = judged_run(load_model(argv[1], {argv + 3, argv + argc}), options);

  for (const CriterionResult& criterion : report.judgement.criteria)
    std::printf("%s, %s: %s\n", criterion.name.c_str(), criterion.text.c_str(), name_of(criterion.outcome));
  if (!report.judgement.distrust.empty()) std::printf("not to be trusted: %s\n", report.judgement.distrust.c_str());
  std::printf("verdict: %s\n", name_of(report.judgement.verdict));

  const Columns columns = report.columns(); // matrix with one row per output time: columns.names, columns.values
  std::printf("%ld rows of %ld columns to t = %g s\n", static_cast<long>(columns.values.rows()), static_cast<long>(columns.values.cols()),
              report.run.result.final_state.t);
  report.write(argv[2], true);
  return report.run.failure ? 4 : 0;
} catch (const ModelError& error) { // error.diagnostics() gives file, line and column of each error
  std::fprintf(stderr, "%s\n", error.what());
  return 3;
} catch (const std::exception& error) { // FileError has a path; NumericalFailure: the run could not start
  std::fprintf(stderr, "%s\n", error.what());
  return 4;
}
