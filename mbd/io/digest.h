// SHA-256 of what is read and written, by which a result knows its inputs and a reader knows that a file is as it was written;
// and base64, which carries numbers into pages. The only room that knows OpenSSL.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace steplap {

/// Of a content that comes part by part.
class Sha256 {
public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::string_view part);
  /// 64 hexadecimal digits, as sha256sum prints them; nothing can be added afterwards.
  [[nodiscard]] std::string hex();

private:
  struct Context;
  std::unique_ptr<Context> context_;
};

[[nodiscard]] std::string sha256(std::string_view content);
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

} // namespace steplap
