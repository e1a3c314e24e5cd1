// Which channels the elements of a kind have: found out by making some, with each choice of theirs and each field that may be
// given or not. So the list never differs from what a run writes, and no kind can forget a channel of its own.
#pragma once

#include "mbd/system/system.h"

namespace steplap {

struct KindChannel {
  std::string name;               ///< behind the element's: "force"; a number at its end is written N
  std::vector<std::string> units; ///< several where it hangs on a choice
  std::string meaning, sign, codes;
  bool is_on_request = false;
};

/// In the order in which elements make them, those on request last. Empty for a kind that has none.
[[nodiscard]] std::vector<KindChannel> channels_of_kind(const Catalogue& catalogue, const ElementKind& kind);
/// Of bodies; on request of markers and of the whole.
[[nodiscard]] std::vector<KindChannel> channels_of_bodies(const Catalogue& catalogue);
[[nodiscard]] std::vector<KindChannel> channels_of_markers(const Catalogue& catalogue);
[[nodiscard]] std::vector<KindChannel> channels_of_whole(const Catalogue& catalogue);

/// "N or N m"; "-" for none.
[[nodiscard]] std::string units_text(const KindChannel& channel);

} // namespace steplap
