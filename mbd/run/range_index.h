// Finds channel ranges of a run by name.
#pragma once

#include "mbd/simulation/extremes.h"

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace steplap {

/// Hash table of channel ranges by name. Refers to the ranges and their channels, which must outlive it.
class RangeIndex {
public:
  /// `ranges`: those of all channels of a run (RunResult::ranges).
  explicit RangeIndex(const std::vector<ChannelRange>& ranges) {
    by_name_.reserve(ranges.size());
    for (const ChannelRange& range : ranges) by_name_.emplace(range.channel->name, &range);
  }

  /// Returns the range of a channel; nullptr if the channel does not exist or has no range.
  [[nodiscard]] const ChannelRange* find(const std::string& channel) const {
    const auto found = by_name_.find(channel);
    return found == by_name_.end() ? nullptr : found->second;
  }

private:
  std::unordered_map<std::string_view, const ChannelRange*> by_name_;
};

} // namespace steplap
