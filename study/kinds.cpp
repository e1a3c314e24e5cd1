#include "study/kinds.h"

#include "study/critical.h"
#include "study/designs.h"
#include "study/fit.h"
#include "study/needs.h"
#include "study/reliability.h"
#include "study/sensitivity.h"

namespace steplap::study {

const char* name_of(Standing standing) {
  switch (standing) {
  case Standing::done: return "done";
  case Standing::not_met: return "not met";
  case Standing::not_trusted: break;
  }
  return "not to be trusted";
}

const std::vector<StudyKind>& study_kinds() {
  static const std::vector<StudyKind> kinds{
      {"sweep", "values tried one after the other: a grid, a list, one variable at a time", check_sweep, run_sweep},
      {"sample", "samples drawn from the distributions: what the responses are like", check_sample, run_sample},
      {"reliability", "how likely failure is, by sampling and by design points", check_reliability, run_reliability},
      {"sensitivity", "how much each variable matters: elasticities, Morris' screening, Sobol indices, a tornado",
       check_sensitivity, run_sensitivity},
      {"critical", "the values of a variable at which an expression is zero", check_critical, run_critical},
      {"map", "the curve in the plane of two variables on which an expression is zero", check_map, run_map},
      {"needs", "what the scene needs: every element and body in turn left out, rigid or fixed", check_needs,
       run_needs},
      {"fit", "parameters from measured histories by least squares, with what they are known to", check_fit, run_fit}};
  return kinds;
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const StudyKind& kind : study_kinds()) names.push_back(kind.name);
  return names;
}

} // namespace steplap::study
