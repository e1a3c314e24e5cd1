// Limits of what a computation may be asked for. Whoever asks for more gets an error that names the limit.
#pragma once

namespace steplap {

/// Largest number of threads of a study, an assessment or samples; each takes some 50 MB.
inline constexpr long k_most_threads = 1024;

/// Largest factor by which the rate of a record may be raised. Steps between samples a tenth as long as needed would be 10.
inline constexpr double k_most_resampling = 100.0;

} // namespace steplap
