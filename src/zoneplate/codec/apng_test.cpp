// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/apng.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <string>

#include "zoneplate/codec/png.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A light square that moves over a gradient; the last frame is equal to the previous one.
Animation walk(bool has_alpha) {
  Animation animation{.format = {.seconds = 1, .per = 24, .loops = 3, .has_alpha = has_alpha}, .frames = {}};
  for (const int place : {2, 9, 20, 20}) {
    Rgba8Image& frame = animation.frames.emplace_back(40, 24);
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 40; ++x) {
        const bool is_square = x >= place && x < place + 6 && y >= 5 && y < 12;
        frame(x, y) = {static_cast<std::uint8_t>(is_square ? 250 : 3 * x), static_cast<std::uint8_t>(7 * y), 99,
                       static_cast<std::uint8_t>(has_alpha && is_square ? 77 : 255)};
      }
  }
  return animation;
}

struct Chunk {
  std::string name;
  Bytes data;

  std::uint32_t word(std::size_t at) const {
    return static_cast<std::uint32_t>(data.at(at) << 24 | data.at(at + 1) << 16 | data.at(at + 2) << 8 |
                                      data.at(at + 3));
  }
};

/// The chunks of a file, whose checksums are verified.
std::vector<Chunk> chunks_of(const Bytes& file) {
  std::vector<Chunk> chunks;
  for (std::size_t at = 8; at + 12 <= file.size();) {
    const std::size_t size = Chunk{"", {file.begin() + static_cast<std::ptrdiff_t>(at), file.end()}}.word(0);
    const auto name = file.begin() + static_cast<std::ptrdiff_t>(at) + 4, data = name + 4;
    Chunk& chunk = chunks.emplace_back(Chunk{{name, data}, {data, data + static_cast<std::ptrdiff_t>(size)}});
    const Chunk sum{"", {data + static_cast<std::ptrdiff_t>(size), data + static_cast<std::ptrdiff_t>(size) + 4}};
    EXPECT_EQ(sum.word(0), crc32(0, &*name, static_cast<uInt>(size + 4))) << chunk.name;
    at += size + 12;
  }
  return chunks;
}

void put(Bytes& out, const std::string& name, const Bytes& data) {
  const auto word = [&](std::uint32_t w) {
    for (const int s : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(w >> s));
  };
  Bytes all(name.begin(), name.end());
  all.insert(all.end(), data.begin(), data.end());
  word(static_cast<std::uint32_t>(data.size()));
  out.insert(out.end(), all.begin(), all.end());
  word(static_cast<std::uint32_t>(crc32(0, all.data(), static_cast<uInt>(all.size()))));
}

/// The frames that a player displays: the data of each frame is decoded by libpng as a PNG file of its own and copied
/// to the frame's rectangle.
std::vector<Rgba8Image> played(const Bytes& file) {
  const std::vector<Chunk> chunks = chunks_of(file);
  std::vector<Rgba8Image> shown;
  std::uint32_t sequence = 0;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    if (chunks[i].name != "fcTL") continue;
    const Chunk& control = chunks[i];
    EXPECT_EQ(control.word(0), sequence++);
    Bytes header = chunks[0].data, data;
    std::copy_n(control.data.begin() + 4, 8, header.begin());
    for (std::size_t k = i + 1; k < chunks.size() && (chunks[k].name == "IDAT" || chunks[k].name == "fdAT"); ++k) {
      const bool is_numbered = chunks[k].name == "fdAT";
      if (is_numbered) {
        EXPECT_EQ(chunks[k].word(0), sequence++);
      }
      data.insert(data.end(), chunks[k].data.begin() + (is_numbered ? 4 : 0), chunks[k].data.end());
    }
    Bytes png(file.begin(), file.begin() + 8);
    put(png, "IHDR", header);
    put(png, "IDAT", data);
    put(png, "IEND", {});
    const Rgba8Image part = decode_png(png, "frame").pixels;
    const int left = static_cast<int>(control.word(12)), top = static_cast<int>(control.word(16));
    Rgba8Image canvas = shown.empty() ? Rgba8Image(part.width(), part.height()) : shown.back();
    for (int y = 0; y < part.height(); ++y)
      for (int x = 0; x < part.width(); ++x) canvas(left + x, top + y) = part(x, y);
    shown.push_back(canvas);
  }
  return shown;
}

TEST(Apng, PlaysTheFramesThatWereGiven) {
  for (const bool has_alpha : {false, true}) {
    const Animation animation = walk(has_alpha);
    const Bytes file = encode_apng(animation);
    EXPECT_EQ(played(file), animation.frames);
    // The default image, which decoders without APNG support display.
    EXPECT_EQ(decode_png(file, "whole").pixels, animation.frames[0]);
    EXPECT_EQ(encode_apng(animation), file);
  }
}

TEST(Apng, TheOrderOfTheWorkDoesNotMatter) {
  const Animation animation = walk(true);
  const auto encoder = make_apng_encoder(animation.format);
  std::vector<std::function<void()>> works;
  for (const Rgba8Image& frame : animation.frames)
    works.push_back(encoder->add(std::make_shared<const Rgba8Image>(frame)));
  for (auto work = works.rbegin(); work != works.rend(); ++work) (*work)();
  EXPECT_EQ(encoder->finish(), encode_apng(animation));
}

TEST(Apng, SaysHowManyFramesHowOftenAndHowLong) {
  std::string order;
  for (const Chunk& chunk : chunks_of(encode_apng(walk(false)))) {
    order += chunk.name + " ";
    if (chunk.name == "acTL") {
      EXPECT_EQ(chunk.word(0), 4u);
      EXPECT_EQ(chunk.word(4), 3u);
    }
    if (chunk.name == "fcTL") {
      EXPECT_EQ(chunk.word(20), 1u << 16 | 24u);
    }
  }
  EXPECT_EQ(order, "IHDR sRGB acTL fcTL IDAT fcTL fdAT fcTL fdAT fcTL fdAT IEND ");
}

TEST(Apng, StoresWhatChanges) {
  std::vector<Bytes> rectangles;
  for (const Chunk& chunk : chunks_of(encode_apng(walk(false))))
    if (chunk.name == "fcTL") rectangles.push_back({chunk.data[7], chunk.data[11], chunk.data[15], chunk.data[19]});
  EXPECT_EQ(rectangles, (std::vector<Bytes>{{40, 24, 0, 0}, {13, 7, 2, 5}, {17, 7, 9, 5}, {1, 1, 0, 0}}));
}

}  // namespace
}  // namespace zoneplate
