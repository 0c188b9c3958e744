#include "tests/detection/fuzz_input.h"

/// libFuzzer's entry.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  stereomotion::testing::DetectFromBytes(data, size);
  return 0;
}
