// SHA-256 against the examples of FIPS 180-4, in one part and in many.
#include "mbd/io/digest.h"

#include <doctest/doctest.h>

#include <string>

using namespace steplap;

namespace {

std::string by_parts(std::string_view content, std::size_t length) {
  Sha256 digest;
  for (std::size_t at = 0; at < content.size(); at += length) digest.add(content.substr(at, length));
  return digest.hex();
}

} // namespace

TEST_CASE("SHA-256: the examples of FIPS 180-4, however they come") {
  const struct {
    std::string content, digest;
  } examples[] = {
      {"", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"},
      {"abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
      {"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq", "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"},
      {std::string(1000000, 'a'), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0"},
  };
  for (const auto& example : examples) {
    CHECK(sha256(example.content) == example.digest);
    for (const std::size_t length : {1, 63, 64, 65, 65536}) CHECK(by_parts(example.content, length) == example.digest);
  }
  // One bit anywhere changes it.
  std::string text(200, 'x');
  const std::string whole = sha256(text);
  for (char& c : text) {
    c ^= 1;
    CHECK(sha256(text) != whole);
    c ^= 1;
  }
}
