// Records made by the program, in the way in which each family of recorders writes them, so that the whole way can be tried.
#pragma once

#include <string>
#include <vector>

namespace steplap {

struct RecordKind {
  std::string name; ///< "gcdc"
  std::string doc;
};
[[nodiscard]] const std::vector<RecordKind>& record_kinds();

/// The text of a record of the kind: ten seconds at rest with gravity along z, noise of the sensor, and two half-sine shocks along x: 3.1 g for
/// 50 ms at 3 s, 1.6 g for 120 ms at 6.5 s (lists of peaks: the shocks alone). The same text on every machine. Kind must be known.
[[nodiscard]] std::string make_record(const std::string& kind);

} // namespace steplap
