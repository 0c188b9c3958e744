#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace stereomotion {

/// Computes a SHA-256 digest (FIPS 180-4) piece by piece.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;
  void Add(const void* data, std::size_t size);
  /// Ends the digest and returns it as 64 lower-case hexadecimal digits; call it once.
  [[nodiscard]] std::string HexDigest();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// Digests a whole file; empty where it cannot be read.
std::string Sha256OfFile(const std::filesystem::path& file);

}  // namespace stereomotion
