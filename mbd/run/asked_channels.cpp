#include "mbd/run/asked_channels.h"

#include "mbd/base/name_pattern.h"
#include "mbd/run/findings.h"
#include "mbd/system/actions.h"

#include <algorithm>

namespace steplap {

void restrict_extremes(const Model& model, System& system) {
  if (system.channels.size() <= k_large_scene || is_judged(model) || action_group(system)) return;
  std::vector<std::string> asked = model.output.channels;
  asked.insert(asked.end(), model.output.also.begin(), model.output.also.end());
  for (const Plot& plot : model.plots)
    for (const auto* patterns : {&plot.channels, &plot.bounds}) asked.insert(asked.end(), patterns->begin(), patterns->end());
  for (const DefinedChannel& formula : model.channels) asked.push_back(formula.name);
  for (Channel& channel : system.channels) {
    const bool is_asked = channel.role != ChannelRole::none || std::any_of(asked.begin(), asked.end(), [&](const std::string& pattern) {
                            return matches_pattern(channel.name, pattern);
                          });
    channel.has_extremes = channel.has_extremes && is_asked;
  }
}

bool is_not_asked(const Channel& channel, std::size_t count) { return count > k_large_scene && !channel.has_extremes; }

} // namespace steplap
