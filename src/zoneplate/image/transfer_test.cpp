// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/transfer.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer_rows.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

constexpr float quiet_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float plus_infinity = std::numeric_limits<float>::infinity();

/// The definition, in extended precision.
long double true_encode(long double x) {
  return x <= 0.0031308L ? 12.92L * x : 1.055L * std::pow(x, 1 / 2.4L) - 0.055L;
}
long double true_decode(long double x) { return x <= 0.04045L ? x / 12.92L : std::pow((x + 0.055L) / 1.055L, 2.4L); }

TEST(Transfer, FollowsTheDefinition) {
  long double worst = 0;
  for (int i = 0; i <= 200000; ++i) {
    const float x = static_cast<float>(i) / 200000;
    worst = std::max({worst, std::abs(encode_srgb(x) - true_encode(x)), std::abs(decode_srgb(x) - true_decode(x))});
  }
  EXPECT_LT(worst, 1e-6L);
  for (const float x : {0.0f, 1.0f}) {
    EXPECT_EQ(encode_srgb(x), x);
    EXPECT_EQ(decode_srgb(x), x);
  }
}

TEST(Transfer, ClampsWhatLiesOutside) {
  for (const float x : {-1.0f, -0.0f, quiet_nan, -plus_infinity}) {
    EXPECT_EQ(encode_srgb(x), 0);
    EXPECT_EQ(decode_srgb(x), 0);
    EXPECT_EQ(encode_srgb8(x), 0);
  }
  for (const float x : {1.5f, plus_infinity}) {
    EXPECT_EQ(encode_srgb(x), 1);
    EXPECT_EQ(decode_srgb(x), 1);
    EXPECT_EQ(encode_srgb8(x), 255);
  }
}

TEST(Transfer, SixteenBitCodesAreDecodedByTheDefinition) {
  const std::vector<float> table = decoded_srgb16();
  ASSERT_EQ(table.size(), 65536u);
  for (std::size_t code = 0; code < table.size(); ++code) {
    const auto expected = static_cast<double>(true_decode(static_cast<long double>(code) / 65535));
    ASSERT_NEAR(table[code], expected, expected * 0x1p-24 * 1.001) << code;
  }
  for (std::size_t code = 0; code < 256; ++code)
    EXPECT_EQ(table[code * 257], decode_srgb8(static_cast<std::uint8_t>(code)));
}

TEST(Transfer, EightBitCodesComeBack) {
  for (int code = 0; code < 256; ++code) {
    const auto byte = static_cast<std::uint8_t>(code);
    EXPECT_EQ(decode_srgb8(byte), static_cast<float>(true_decode(code / 255.0L)));
    EXPECT_EQ(encode_srgb8(decode_srgb8(byte)), byte);
  }
}

TEST(Transfer, EightBitCodesAreRoundedExactly) {
  const auto rounded = [](float x) { return static_cast<int>(255 * true_encode(x) + 0.5L); };
  // Values around each change of code, and many others.
  for (int code = 1; code < 256; ++code) {
    const float change = static_cast<float>(true_decode((code - 0.5L) / 255));
    std::uint32_t bits = std::bit_cast<std::uint32_t>(change) - 20;
    for (int i = 0; i < 40; ++i, ++bits) {
      const float x = std::bit_cast<float>(bits);
      ASSERT_EQ(encode_srgb8(x), rounded(x)) << x;
    }
  }
  for (std::uint32_t i = 0; i < 200000; ++i) {
    const float x = i % 2 == 0 ? unit_float(hash(i)) : std::bit_cast<float>(hash(i) % 0x3f800000u);
    ASSERT_EQ(encode_srgb8(x), rounded(x)) << x;
  }
}

TEST(Transfer, QuantizesByRounding) {
  for (int code = 0; code < 256; ++code) {
    const float x = static_cast<float>(code) / 255;
    const DisplayImage image(1, 1, {x, std::max(0.0f, x - 0.0019f), std::min(1.0f, x + 0.0019f), 1});
    const auto byte = static_cast<std::uint8_t>(code);
    EXPECT_EQ(quantize8(image)(0, 0), (Rgba8{byte, byte, byte, 255}));
    const auto word = static_cast<std::uint16_t>(257 * code);
    EXPECT_EQ(quantize16(image)(0, 0).r, word);
  }
  const DisplayImage odd(1, 1, {quiet_nan, plus_infinity, -1, 2});
  EXPECT_EQ(quantize8(odd)(0, 0), (Rgba8{0, 255, 0, 255}));
  EXPECT_EQ(quantize16(odd)(0, 0), (Rgba16{0, 65535, 0, 65535}));
}

TEST(Transfer, QuantizesTheSameOnAnyNumberOfThreads) {
  DisplayImage image(301, 203);
  std::uint32_t i = 0;
  for (Display& c : image.values()) {
    c = {unit_float(hash(i)), unit_float(hash(i, 1)), unit_float(hash(i, 2)), unit_float(hash(i, 3))};
    ++i;
  }
  Rgba8Image one, seven;
  with_threads(1, [&] { one = quantize8(image); });
  with_threads(7, [&] { seven = quantize8(image); });
  EXPECT_EQ(one, seven);
}

TEST(Transfer, EveryInstructionSetGivesTheSameBits) {
  for (const Isa isa : supported_isas()) {
    const TransferKernels& kernels = TransferKernels::of(isa);
    for (std::uint32_t n = 0; n <= 200; ++n) {
      std::vector<float> in(n);
      for (std::uint32_t i = 0; i < n; ++i) {
        const float u = unit_float(hash(i, n));
        in[i] = i % 17 == 3   ? quiet_nan
                : i % 17 == 5 ? plus_infinity
                : i % 3 == 0  ? u * 2 - 0.5f
                : i % 3 == 1  ? u
                              : u * 0.01f;
      }
      std::vector<float> expected(n), found(n);
      TransferKernels::scalar.encode(in.data(), expected.data(), n);
      kernels.encode(in.data(), found.data(), n);
      EXPECT_EQ(found, expected) << name_of(isa);
      TransferKernels::scalar.decode(in.data(), expected.data(), n);
      kernels.decode(in.data(), found.data(), n);
      EXPECT_EQ(found, expected) << name_of(isa);

      // One more code than the kernel may write, to detect a write past the end.
      std::vector<std::uint8_t> expected8(n + 1, 9), found8(n + 1, 9);
      TransferKernels::scalar.quantize8(in.data(), expected8.data(), n);
      kernels.quantize8(in.data(), found8.data(), n);
      EXPECT_EQ(found8, expected8) << name_of(isa);
      std::vector<std::uint16_t> expected16(n + 1, 9), found16(n + 1, 9);
      TransferKernels::scalar.quantize16(in.data(), expected16.data(), n);
      kernels.quantize16(in.data(), found16.data(), n);
      EXPECT_EQ(found16, expected16) << name_of(isa);
    }
  }
}

}  // namespace
}  // namespace zoneplate
