// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/load.h"

#include "zoneplate/cli/signal/signal_for_test.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/imaging/signal/show.h"
#include "zoneplate/signal/pattern/pattern.h"

namespace zoneplate::cli {
namespace {

using SignalLoad = SignalVerb;

TEST_F(SignalLoad, EveryCodeComesBackAsItself) {
  Rgba8Image all(16, 16);
  for (std::size_t i = 0; i < 256; ++i) {
    const auto code = static_cast<std::uint8_t>(i);
    all.values()[i] = {code, static_cast<std::uint8_t>(255 - code), 7, 255};
  }
  save_bytes(at("all.png"), encode_png(all));
  for (const bool uses_codes : {false, true}) EXPECT_EQ(shown(load_signal(at("all.png"), uses_codes), uses_codes), all);
  EXPECT_EQ(load_signal(at("all.png"), false)(5, 5).r, decode_srgb8(85));
  EXPECT_EQ(load_signal(at("all.png"), true)(5, 5).r, 85.0f / 255);
}

TEST_F(SignalLoad, ColoursArePremultiplied) {
  save_bytes(at("a.png"), encode_png(Rgba8Image(1, 1, {51, 102, 153, 128})));
  for (const bool uses_codes : {false, true})
    EXPECT_EQ(shown(load_signal(at("a.png"), uses_codes), uses_codes)(0, 0), (Rgba8{51, 102, 153, 128}));
  const Linear codes = load_signal(at("a.png"), true)(0, 0);
  EXPECT_EQ(codes.a, 128.0f / 255);
  EXPECT_NEAR(codes.g, 0.4 * 128 / 255, 1e-7);
}

TEST_F(SignalLoad, SixteenBitsAreKept) {
  save_bytes(at("deep.png"), encode_png(Rgba16Image(1, 1, {1000, 1001, 65535, 65535})));
  const Linear codes = load_signal(at("deep.png"), true)(0, 0), light = load_signal(at("deep.png"), false)(0, 0);
  EXPECT_EQ(codes.r, 1000.0f / 65535);
  EXPECT_EQ(codes.g, 1001.0f / 65535);
  EXPECT_EQ(light.g, decode_srgb(1001.0f / 65535));
  EXPECT_EQ(light.b, 1.0f);
}

TEST_F(SignalLoad, PatternsAreLightOrItsCodes) {
  EXPECT_EQ(load_signal("edge:size=8", false), make_pattern("edge:size=8"));
  EXPECT_EQ(load_signal("edge:size=8", true)(0, 0).r, encode_srgb(0.05f));
}

TEST_F(SignalLoad, SaysWhatIsWrongWithAFile) {
  save("text.png", "no image");
  save("cut.png", "\x89PNG\r\n\x1a\n");
  for (const char* name : {"text.png", "cut.png", "none.png"}) {
    try {
      load_signal(at(name), false);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      EXPECT_TRUE(contains(error.what(), name)) << error.what();
    }
  }
}

}  // namespace
}  // namespace zoneplate::cli
