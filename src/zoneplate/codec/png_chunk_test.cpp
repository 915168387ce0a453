#include "zoneplate/codec/png_chunk.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(PngChunk, EndsInTheChecksumOfNameAndData) {
  // The specification's own end of a file, and the check value of its CRC ("123456789" gives cbf43926).
  Bytes out{1};
  put_png_chunk(out, "IEND", {});
  EXPECT_EQ(out, (Bytes{1, 0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82}));
  const Bytes digits{'5', '6', '7', '8', '9'};
  out.clear();
  put_png_chunk(out, "1234", digits);
  EXPECT_EQ(out, (Bytes{0, 0, 0, 5, '1', '2', '3', '4', '5', '6', '7', '8', '9', 0xcb, 0xf4, 0x39, 0x26}));
  Bytes known;
  put_png_chunk(known, "1234", digits, 0xcbf43926);
  EXPECT_EQ(known, out);
  EXPECT_EQ(png_checksum(7, {}), 7u);
}

}  // namespace
}  // namespace zoneplate
