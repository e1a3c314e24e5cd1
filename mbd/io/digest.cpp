// Calls OpenSSL's SHA-256 functions directly. The newer EVP functions first read the configuration of the machine and build tables of all
// algorithms, which takes as long as the digest of 170 kB.
#define OPENSSL_API_COMPAT 10101 // in this version these functions are not deprecated
#include "mbd/io/digest.h"

#include <openssl/evp.h>
#include <openssl/sha.h>

#include <array>
#include <stdexcept>

namespace steplap {

struct Sha256::Context {
  SHA256_CTX state{};
};

namespace {

// Throws if a call of OpenSSL failed, because a wrong digest would not be noticed.
void require(int is_done) {
  if (is_done != 1) throw std::runtime_error("OpenSSL cannot compute a SHA-256");
}

} // namespace

Sha256::Sha256() : context_(std::make_unique<Context>()) { require(SHA256_Init(&context_->state)); }
Sha256::~Sha256() = default;

void Sha256::add(std::string_view part) { require(SHA256_Update(&context_->state, part.data(), part.size())); }

std::string Sha256::hex() {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  require(SHA256_Final(digest.data(), &context_->state));
  std::string text;
  for (const unsigned char byte : digest)
    for (const int nibble : {byte >> 4, byte & 15}) text += "0123456789abcdef"[nibble];
  return text;
}

std::string sha256(std::string_view content) {
  Sha256 digest;
  digest.add(content);
  return digest.hex();
}

std::string base64(std::span<const std::byte> bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),        // NOLINT: bytes
                                     reinterpret_cast<const unsigned char*>(bytes.data()), // NOLINT
                                     static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

} // namespace steplap
