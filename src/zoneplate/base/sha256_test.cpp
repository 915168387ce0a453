// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/sha256.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace zoneplate {
namespace {

// FIPS 180-4's examples, and a million letters, of NIST's test vectors.
TEST(Sha256, GivesTheDigestsOfTheStandard) {
  EXPECT_EQ(sha256_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_of(std::string(1'000'000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DoesNotDependOnTheParts) {
  std::string text;
  for (int i = 0; i < 300; ++i) text += static_cast<char>(i * 37);
  const auto* first = reinterpret_cast<const std::uint8_t*>(text.data());
  for (std::size_t part = 1; part < 200; ++part) {
    Sha256 digest;
    for (std::size_t at = 0; at < text.size(); at += part) digest.add({first + at, std::min(part, text.size() - at)});
    EXPECT_EQ(digest.hex(), sha256_of(text)) << part;
  }
}

}  // namespace
}  // namespace zoneplate
