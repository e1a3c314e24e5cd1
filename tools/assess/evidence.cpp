#include "tools/assess/evidence.h"

namespace steplap::assess {

const char* name_of(Evidence item) {
  static constexpr const char* k_names[] = {"clipped", "gaps",     "peaks", "cut",       "comments", "fall",      "dead",  "unit",
                                            "axis",    "coverage", "clock", "bandwidth", "place",    "vibration", "planes"};
  return k_names[static_cast<int>(item)];
}

const std::vector<Evidence>& all_evidence() {
  static const std::vector<Evidence> all = [] {
    std::vector<Evidence> items;
    for (int i = 0; i <= static_cast<int>(Evidence::planes); ++i) items.push_back(static_cast<Evidence>(i));
    return items;
  }();
  return all;
}

} // namespace steplap::assess
