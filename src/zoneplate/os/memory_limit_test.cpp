// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/memory_limit.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <string>

#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/shade/texture/texture.h"

namespace zoneplate {
namespace {

TEST(MemoryLimit, AFailedAllocationNamesWhatGrew) {
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_DATA, &old), 0);
  const Rgba8Image image(2048, 2048);  // 16 MB, and 43 MB of mip levels
  limit_memory(std::uint64_t{24} << 20);
  std::string what;
  try {
    const Texture texture(image, TexelMeaning::Color);
  } catch (const OutOfMemory& error) {
    what = error.what();
  }
  ::setrlimit(RLIMIT_DATA, &old);
  EXPECT_EQ(what, "texture levels");
}

}  // namespace
}  // namespace zoneplate
