// Limits of inputs whose cost grows without bound. Input beyond one is refused by an error that names the limit.
#pragma once

#include <cstddef>

namespace steplap {

/// Largest number of threads of a study, an assessment or samples; each takes some 50 MB.
inline constexpr long k_most_threads = 1024;

/// Largest factor by which the rate of a record may be raised. Ten samples for each of the record already interpolate it smoothly.
inline constexpr double k_most_resampling = 100.0;

/// Largest number of keys in a table of a model file, such as [parameters]. Keys are searched one by one: reading 10 000 takes 0.5 s.
inline constexpr std::size_t k_most_keys = 10'000;

/// Largest size of the texts that one repeated entry may make, bytes: 200 for each of the most entries.
inline constexpr std::size_t k_most_repeated_text = 20'000'000;

/// Largest number of operations of all [[channel]] formulas together. A formula contains the operations of the formulas that it names, so
/// that n channels, each of which names the one before, need some 1.5 n²: a chain of 570, which runs for 0.7 s, reaches the limit.
inline constexpr std::size_t k_most_channel_operations = 500'000;

/// Largest number of [[channel]] formulas of which each names the next.
inline constexpr int k_longest_channel_chain = 1000;

} // namespace steplap
