// SHA-256 of inputs and outputs, by which a result identifies its inputs and a reader can check a file; and base64, by which HTML pages
// contain binary numbers. This is the only module that depends on OpenSSL.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace steplap {

/// SHA-256 of a content that is added part by part.
class Sha256 {
public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::string_view part);
  /// Returns 64 hexadecimal digits as sha256sum prints them. Nothing can be added afterwards.
  [[nodiscard]] std::string hex();

private:
  struct Context;
  std::unique_ptr<Context> context_;
};

[[nodiscard]] std::string sha256(std::string_view content);
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

} // namespace steplap
