// Large scenes: a grid of 40 000 masses has 719 400 channels. Searching and writing the extremes of all takes a third of the whole command.
#pragma once

#include "mbd/model/model.h"
#include "mbd/system/system.h"

#include <string>
#include <vector>

namespace steplap {

/// The channels whose extremes are searched. In a scene of more than 100 000 channels that nothing judges and that has no actions: those
/// that are plotted, named in `channels` or `also` of [output], or formulas, and margins and uses of friction and strength. Otherwise all.
class AskedChannels {
public:
  /// Reads what the model asks for.
  AskedChannels(const Model& model, const System& system);

  /// Returns true if the extremes of the channel are searched.
  [[nodiscard]] bool contains(const Channel& channel) const;
  /// Returns true if the channel has no extremes because nothing asks for them.
  [[nodiscard]] bool leave_out(const Channel& channel) const { return !channel.has_extremes && !contains(channel); }

private:
  bool is_everything_;
  std::vector<std::string> patterns_;
};

/// Sets Channel::has_extremes to false for all channels that are not asked for.
void restrict_extremes(const Model& model, System& system);

} // namespace steplap
