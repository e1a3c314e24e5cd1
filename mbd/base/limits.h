// Limits of inputs whose cost grows without bound. Input beyond one is refused by an error that names the limit.
#pragma once

#include <cstddef>

namespace steplap {

/// Largest number of threads of a study, an assessment or samples; each takes some 50 MB.
inline constexpr long k_most_threads = 1024;

/// Largest factor by which the rate of a record may be raised. With ten samples for each one of the record, the curve is smooth already.
inline constexpr double k_most_resampling = 100.0;

/// Largest number of keys in a table of a model file, such as [parameters]. Keys are searched one by one: reading 10 000 takes 0.5 s.
inline constexpr std::size_t k_most_keys = 10'000;

/// Largest total size of the texts produced by repeating one entry, bytes: 200 per copy for the largest number of copies.
inline constexpr std::size_t k_most_repeated_text = 20'000'000;

/// Largest number of operations of all [[channel]] formulas together. A channel used in a formula is replaced by its own operations. A
/// chain of n channels, each defined by the one before, therefore has some 1.5 n² operations: 570 channels reach the limit, and take 0.7 s.
inline constexpr std::size_t k_most_channel_operations = 500'000;

/// Largest length of a chain of [[channel]] formulas, each of which uses the next.
inline constexpr int k_longest_channel_chain = 1000;

} // namespace steplap
