// Generates example records in the formats of recorder families, for tests and demonstrations.
#pragma once

#include <string>
#include <vector>

namespace steplap {

/// A kind of example record.
struct RecordKind {
  std::string name; ///< name such as "gcdc"
  std::string doc;
};
[[nodiscard]] const std::vector<RecordKind>& record_kinds();

/// Returns the text of an example record: ten seconds at rest with gravity along z, sensor noise, and two half-sine shocks along x: 3.1 g
/// for 50 ms at 3 s, 1.6 g for 120 ms at 6.5 s (lists of peaks contain the shocks only). The text is the same on every computer. `kind`
/// must be one of record_kinds().
[[nodiscard]] std::string make_record(const std::string& kind);

} // namespace steplap
