// What the harnesses of tests/fuzz share. A harness reads bytes as a careless or hostile user would give them. A ModelError
// or another refusal in words is an answer; anything else that is thrown, a crash, a hang and a message that carries
// control characters to the terminal are findings.
#pragma once

#include "mbd/base/diagnostics.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace steplap::fuzz {

inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "finding: %s\n", what);
  std::abort();
}

/// An error names its file and can be shown on a terminal.
inline void require_readable(const ModelError& error) {
  require(!error.diagnostics().empty(), "an error without a message");
  for (const Diagnostic& d : error.diagnostics()) {
    require(!d.message.empty(), "an empty message");
    for (const char c : d.text())
      require((static_cast<unsigned char>(c) >= 0x20 || c == '\n') && c != 0x7f, "a control character in a message");
  }
}

} // namespace steplap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
