// STEPLAP_TESTS_SANITIZED: code runs under AddressSanitizer, some ten to twenty times slower: GCC and clang say so each in
// its own way.
#pragma once

#if defined(__SANITIZE_ADDRESS__)
#define STEPLAP_TESTS_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define STEPLAP_TESTS_SANITIZED
#endif
#endif

namespace steplap::testing {

/// Cases that differ in numbers alone, not in the code that they go through, are tested once under the sanitizers.
#ifdef STEPLAP_TESTS_SANITIZED
inline constexpr bool k_is_sanitized = true;
#else
inline constexpr bool k_is_sanitized = false;
#endif

} // namespace steplap::testing
