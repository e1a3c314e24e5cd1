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
