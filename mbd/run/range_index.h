// Finds channel ranges of a run by name.
#pragma once

#include "mbd/simulation/extremes.h"

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace steplap {

/// Hash table of channel ranges by name, made at the first question: many scenes ask none. Refers to the ranges and their channels, which
/// must outlive it. Not for use by several threads.
class RangeIndex {
public:
  /// `ranges`: those of all channels of a run (RunResult::ranges).
  explicit RangeIndex(const std::vector<ChannelRange>& ranges) : ranges_(ranges) {}

  /// Returns the range of a channel; nullptr if the channel does not exist or has no range.
  [[nodiscard]] const ChannelRange* find(const std::string& channel) const {
    if (by_name_.empty()) {
      by_name_.reserve(ranges_.size());
      for (const ChannelRange& range : ranges_) by_name_.emplace(range.channel->name, &range);
    }
    const auto found = by_name_.find(channel);
    return found == by_name_.end() ? nullptr : found->second;
  }

private:
  const std::vector<ChannelRange>& ranges_;
  mutable std::unordered_map<std::string_view, const ChannelRange*> by_name_;
};

} // namespace steplap
