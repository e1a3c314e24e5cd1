// `repeat = 40` in an entry of a document: so many entries in its place, each with its index in its formulas and names.
//
//   [[body]]
//   name = "sleeper {i+1}"          # in texts, whole numbers made of the index stand in braces
//   position = ["= i * '0.6 m'", 0.0] # in formulas it is a name like a parameter's, and goes before one
//   repeat = 40                     # i = 0 … 39
//
// A name without braces gets the index at its end: "sleeper 0". Whoever reads the document afterwards sees the entries written out.
#pragma once

#include "mbd/io/document.h"

#include <string>
#include <vector>

namespace steplap {

/// Arrays whose entries may be repeated.
[[nodiscard]] const std::vector<std::string>& repeated_arrays();

/// Entries that one model may get by repetitions and parts, all together: far beyond what is run.
inline constexpr std::size_t k_most_entries = 100000;

/// Writes the repetitions of `root` out. What is wrong is appended to `problems`, and that entry left out. `made` counts the entries
/// made; beyond k_most_entries nothing more is.
void write_out_repetitions(Node& root, std::size_t& made, std::vector<Diagnostic>& problems);

} // namespace steplap
