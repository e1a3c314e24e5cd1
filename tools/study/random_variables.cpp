#include "tools/study/random_variables.h"

namespace steplap::study {

void check_random(const LoadedStudy& loaded, bool takes_ranges, std::vector<Diagnostic>& problems) {
  bool is_any = false;
  for (const Variable& v : loaded.study.variables) {
    is_any = is_any || v.has_distribution() || (takes_ranges && !v.range.empty());
    if (!v.values.empty())
      problems.push_back({v.where, "variable '" + v.name + "': a list of values is for sweeps; give a distribution, or 'value'"});
    if (!v.range.empty() && !takes_ranges)
      problems.push_back({v.where, "variable '" + v.name + "' has a range but no distribution: how likely its values are is not known"});
  }
  if (!is_any)
    problems.push_back({loaded.study.where, "a study of the kind '" + loaded.study.kind + "' needs a [[variable]] with a distribution"});
}

} // namespace steplap::study
