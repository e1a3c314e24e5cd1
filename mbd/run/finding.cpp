#include "mbd/run/finding.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace steplap {

std::string text_with_place(const Finding& finding) {
  if (finding.where.line == 0) return finding.text;
  return finding.text + " (" + finding.where.file + ":" + std::to_string(finding.where.line) + ")";
}

bool caps_verdict(const Finding& finding) {
  // Findings without effect on the strength of a machine: unused entries, output settings, distribution of reactions.
  constexpr std::array<std::string_view, 14> k_harmless = {
      "renamed_key",    "unused_signal", "unused_marker",         "unused_parameter", "unused_step",
      "no_channel",     "plot_left_out", "extremes_left_out",     "shared_reactions", "shared_friction",
      "restless_start", "load_is_zero",  "channel_without_value", "high_friction"};
  return finding.level == FindingLevel::warning && std::find(k_harmless.begin(), k_harmless.end(), finding.code) == k_harmless.end();
}

} // namespace steplap
