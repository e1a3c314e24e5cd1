// Finds the channels of each element kind by compiling sample elements: its example, with each choice and each optional field. The list
// therefore always agrees with the results of a run.
#pragma once

#include "mbd/system/system.h"

namespace steplap {

struct KindChannel {
  std::string name;               ///< name without the element's: "force"; a number at its end is written N
  std::vector<std::string> units; ///< several if the unit depends on a choice
  std::string meaning, sign, codes;
  bool is_on_request = false;
};

/// Returns the channels in the order in which elements create them, optional ones last; empty if the kind has none.
[[nodiscard]] std::vector<KindChannel> channels_of_kind(const Catalogue& catalogue, const ElementKind& kind);
/// Returns the channels of bodies. The functions below return optional channels of markers and of the whole model.
[[nodiscard]] std::vector<KindChannel> channels_of_bodies(const Catalogue& catalogue);
[[nodiscard]] std::vector<KindChannel> channels_of_markers(const Catalogue& catalogue);
[[nodiscard]] std::vector<KindChannel> channels_of_model(const Catalogue& catalogue);

/// Returns a complete model in TOML: two boxes 'a' and 'b' with the example of the kind.
[[nodiscard]] std::string example_model(const ElementKind& kind);
/// Returns the tables of the example up to the first element of the kind, that is, this element and what it refers to.
[[nodiscard]] std::string example_text(const ElementKind& kind);

/// Returns the units as text: "N or N m"; "-" if there are none.
[[nodiscard]] std::string units_text(const KindChannel& channel);

} // namespace steplap
