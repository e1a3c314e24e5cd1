// Repetition: `repeat = 40` in an entry of a document creates 40 entries in its place, each with its index in formulas and names.
//
//   [[body]]
//   name = "sleeper {i+1}"          # in texts, whole-number formulas of the index are in braces
//   position = ["= i * '0.6 m'", 0.0] # in formulas the index is a name; it hides a parameter of the same name
//   repeat = 40                     # i = 0 … 39
//
// If a name has no braces, the index is appended: "sleeper 0". The document is then read as if the entries had been written out.
#pragma once

#include "mbd/io/document.h"

#include <string>
#include <vector>

namespace steplap {

/// Returns the names of arrays whose entries may be repeated.
[[nodiscard]] const std::vector<std::string>& repeated_arrays();

/// Largest number of entries that repetitions and parts of one model may create; far beyond what can be run.
inline constexpr std::size_t k_most_entries = 100000;

/// Expands the repetitions of `root`. An entry with an invalid `repeat` is left out, and the error appended to `problems`. `made` counts
/// the created entries over several calls; beyond k_most_entries no more are created.
void write_out_repetitions(Node& root, std::size_t& made, std::vector<Diagnostic>& problems);

} // namespace steplap
