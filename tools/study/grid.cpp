#include "tools/study/grid.h"

#include <cstddef>

namespace steplap::study {

void visit_grid(const std::vector<std::vector<double>>& levels, const std::function<void(const std::vector<double>&)>& visit) {
  std::vector<std::size_t> place(levels.size(), 0);
  std::vector<double> point(levels.size());
  for (bool is_over = false; !is_over;) {
    for (std::size_t i = 0; i < levels.size(); ++i) point[i] = levels[i][place[i]];
    visit(point);
    is_over = true;
    for (std::size_t i = levels.size(); i-- > 0 && is_over;) {
      is_over = ++place[i] == levels[i].size();
      if (is_over) place[i] = 0;
    }
  }
}

} // namespace steplap::study
