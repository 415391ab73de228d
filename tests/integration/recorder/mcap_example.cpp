// mcap_example FILE COMPRESSION: writes an MCAP file with everything in it that we write, for an
// independent reader.

#include <cstdio>

#include "tests/support/mcap_example.hpp"

int main(int argc, char** argv) {
  const auto compression = argc == 3 ? slammot::mcap::compression_of(argv[2])
                                     : std::optional<slammot::mcap::Compression>();
  if (!compression) {
    std::fputs("mcap_example FILE none|lz4|zstd\n", stderr);
    return 2;
  }
  return slammot::testing::write_example(argv[1], slammot::testing::example_messages(200),
                                         *compression)
             ? 0
             : 1;
}
