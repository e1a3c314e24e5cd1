// Ranges of a run by the names of their channels: for who asks for many of them.
#pragma once

#include "mbd/simulation/extremes.h"

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace steplap {

/// Finds ranges by name in constant time. Refers to the ranges and their channels, which have to outlive it.
class RangeIndex {
public:
  /// Of all channels of a run (RunResult::ranges).
  explicit RangeIndex(const std::vector<ChannelRange>& ranges) {
    by_name_.reserve(ranges.size());
    for (const ChannelRange& range : ranges) by_name_.emplace(range.channel->name, &range);
  }

  /// nullptr if there is no such channel, or no range of it.
  [[nodiscard]] const ChannelRange* find(const std::string& channel) const {
    const auto found = by_name_.find(channel);
    return found == by_name_.end() ? nullptr : found->second;
  }

private:
  std::unordered_map<std::string_view, const ChannelRange*> by_name_;
};

} // namespace steplap
