#include "tools/study/kinds.h"

#include <stdexcept>

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
  static const std::vector<StudyKind> kinds{sweep_kind(),  sample_kind(), reliability_kind(), sensitivity_kind(), critical_kind(),
                                            design_kind(), map_kind(),    needs_kind(),       fit_kind()};
  return kinds;
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const StudyKind& kind : study_kinds()) names.push_back(kind.name);
  return names;
}

const StudyKind* find_kind(const std::string& name) {
  for (const StudyKind& kind : study_kinds())
    if (kind.name == name) return &kind;
  return nullptr;
}

const StudyKind& kind_of(const Study& study) {
  if (const StudyKind* kind = find_kind(study.kind)) return *kind;
  throw std::logic_error("a kind of study that the reader let pass is not there");
}

} // namespace steplap::study
