#include "tools/study/kinds.h"

#include "tools/study/designs.h"
#include "tools/study/reliability.h"

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
      {"reliability", "how likely failure is, by sampling and by design points", check_reliability, run_reliability}};
  return kinds;
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const StudyKind& kind : study_kinds()) names.push_back(kind.name);
  return names;
}

} // namespace steplap::study
