// Entry of libFuzzer, compiled once for each target: SLAMMOT_FUZZ_TARGET is its function
// (tests/fuzz/run).

#include <cstddef>
#include <cstdint>

#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  slammot::fuzz::SLAMMOT_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}
