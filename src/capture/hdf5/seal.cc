#include "seal.h"

#include <fstream>
#include <string>
#include <vector>

#include "stereomotion/capture/sha256.h"
#include "stereomotion/core/output_error.h"

namespace stereomotion {
namespace {

namespace fs = std::filesystem;

const std::string& Mark() {
  static const std::string mark = "\nstereomotion-seal/1 ";
  return mark;
}

constexpr std::size_t kDigits = 64;

// Of the first bytes of a file; empty where it cannot be read.
std::string DigestOfStart(std::ifstream& stream, std::uintmax_t bytes) {
  constexpr std::uintmax_t kPiece = 1 << 20;
  std::vector<char> piece(kPiece);
  Sha256 hash;
  stream.seekg(0);
  for (std::uintmax_t rest = bytes; rest > 0;) {
    const std::uintmax_t count = std::min(rest, kPiece);
    if (!stream.read(piece.data(), static_cast<std::streamsize>(count))) return "";
    hash.Add(piece.data(), count);
    rest -= count;
  }
  return hash.HexDigest();
}

enum class SealState { kNone, kBroken, kWhole };

SealState StateOf(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  const std::uintmax_t seal_bytes = Mark().size() + kDigits;
  if (error || bytes < seal_bytes) return SealState::kNone;
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(bytes - seal_bytes));
  std::string seal(seal_bytes, '\0');
  if (!stream.read(seal.data(), static_cast<std::streamsize>(seal_bytes))) return SealState::kNone;
  if (seal.compare(0, Mark().size(), Mark()) != 0) return SealState::kNone;
  const bool fits = seal.substr(Mark().size()) == DigestOfStart(stream, bytes - seal_bytes);
  return fits ? SealState::kWhole : SealState::kBroken;
}

}  // namespace

void Seal(const fs::path& file) {
  const std::string seal = Mark() + Sha256OfFile(file);
  std::ofstream stream(file, std::ios::binary | std::ios::app);
  stream << seal;
  stream.close();
  if (!stream) throw OutputError(file.string() + ": cannot be written; is the disk full?");
}

bool IsSealBroken(const fs::path& file) { return StateOf(file) == SealState::kBroken; }

bool IsSealWhole(const fs::path& file) { return StateOf(file) == SealState::kWhole; }

}  // namespace stereomotion
