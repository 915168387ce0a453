// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/dataset/npy.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>

namespace zoneplate {
namespace {

std::string header_of(const std::vector<std::uint8_t>& file) {
  const std::size_t size = file[8] + 256u * file[9];
  return std::string(file.begin() + 10, file.begin() + 10 + static_cast<std::ptrdiff_t>(size));
}

TEST(Npy, FollowsTheFormat) {
  const float values[6] = {0, 1, 2, 3, 4, -0.5f};
  const std::vector<std::uint8_t> file = encode_npy(std::array{1, 2, 3}, values);
  EXPECT_EQ(std::string(file.begin(), file.begin() + 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::string header = header_of(file);
  EXPECT_TRUE(header.starts_with("{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2, 3), }")) << header;
  EXPECT_EQ(header.back(), '\n');
  EXPECT_EQ((10 + header.size()) % 64, 0u);
  ASSERT_EQ(file.size(), 10 + header.size() + sizeof values);
  EXPECT_EQ(std::memcmp(file.data() + 10 + header.size(), values, sizeof values), 0);
}

TEST(Npy, AShapeOfOneLengthIsATuple) {
  const std::uint32_t numbers[2] = {7, 1u << 31};
  EXPECT_TRUE(header_of(encode_npy(std::array{2}, numbers))
                  .starts_with("{'descr': '<u4', 'fortran_order': False, 'shape': (2,), }"));
  const std::uint8_t bytes[2] = {0, 1};
  EXPECT_TRUE(header_of(encode_npy(std::array{2, 1}, bytes))
                  .starts_with("{'descr': '|u1', 'fortran_order': False, 'shape': (2, 1), }"));
}

}  // namespace
}  // namespace zoneplate
