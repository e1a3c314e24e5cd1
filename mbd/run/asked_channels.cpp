#include "mbd/run/asked_channels.h"

#include "mbd/base/name_pattern.h"
#include "mbd/run/findings.h"
#include "mbd/system/actions.h"

#include <algorithm>

namespace steplap {

namespace {

constexpr std::size_t k_large_scene = 100'000; // channels; the search for their extremes then takes seconds

} // namespace

AskedChannels::AskedChannels(const Model& model, const System& system)
    : is_everything_(system.channels.size() <= k_large_scene || is_judged(model) || action_group(system)) {
  if (is_everything_) return;
  const auto add = [this](const std::vector<std::string>& patterns) {
    patterns_.insert(patterns_.end(), patterns.begin(), patterns.end());
  };
  add(model.output.channels);
  add(model.output.also);
  for (const Plot& plot : model.plots) {
    add(plot.channels);
    add(plot.bounds);
  }
  for (const DefinedChannel& formula : model.channels) patterns_.push_back(formula.name);
}

bool AskedChannels::contains(const Channel& channel) const {
  const auto matches = [&channel](const std::string& pattern) { return matches_pattern(channel.name, pattern); };
  return is_everything_ || channel.role != ChannelRole::none || std::any_of(patterns_.begin(), patterns_.end(), matches);
}

void restrict_extremes(const Model& model, System& system) {
  const AskedChannels asked(model, system);
  for (Channel& channel : system.channels) channel.has_extremes = channel.has_extremes && asked.contains(channel);
}

} // namespace steplap
