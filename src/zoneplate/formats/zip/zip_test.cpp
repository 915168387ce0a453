// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/zip/zip.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/zip/zip_for_test.h"

namespace zoneplate {
namespace {

std::string text_of(ZipArchive& archive, std::size_t file, bool is_intact = true) {
  std::string text;
  EXPECT_EQ(archive.read(file, [&](std::span<const std::uint8_t> piece) { text.append(piece.begin(), piece.end()); }),
            is_intact);
  return text;
}

std::string refusal(const std::vector<ZipMember>& members, const LoadLimits& limits = {}) {
  const std::vector<std::uint8_t> bytes = zip_of(members);
  ImportBudget budget("file", limits);
  try {
    ZipArchive archive(bytes, budget);
    for (std::size_t i = 0; i < members.size(); ++i) archive.read(i, [](std::span<const std::uint8_t>) {});
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(Zip, ReadsEveryWayOfWritingAFile) {
  const std::string text = std::string(200000, 'a') + "end";
  const std::vector<std::uint8_t> bytes = zip_of({{"stored", text},
                                                  {"deflated", text, true},
                                                  {"followed by its sizes", text, true, true},
                                                  {"of 64 bits", text, true, false, true},
                                                  {"", ""}});
  EXPECT_TRUE(is_zip(bytes));
  ImportBudget budget("file", {});
  ZipArchive archive(bytes, budget);
  ASSERT_EQ(archive.names().size(), 5u);
  EXPECT_EQ(archive.names()[2], "followed by its sizes");
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(text_of(archive, 3 - i), text) << archive.names()[3 - i];
  EXPECT_EQ(text_of(archive, 4), "");
}

TEST(Zip, AWrongChecksumIsReported) {
  const std::vector<std::uint8_t> bytes = zip_of({{.name = "a", .text = "text", .crc_change = 1}});
  ImportBudget budget("file", {});
  ZipArchive archive(bytes, budget);
  EXPECT_EQ(text_of(archive, 0, false), "text");
}

TEST(Zip, RefusalsNameTheFile) {
  EXPECT_EQ(refusal({{.name = "a", .text = "text", .flags = 1}}), "file: a: is encrypted");
  EXPECT_EQ(refusal({{.name = "a", .text = "text", .method = 12}}),
            "file: a: is packed by method 12, expected stored or deflated");
  EXPECT_EQ(refusal({{.name = "a", .text = "text that is not deflated", .method = 8}}),
            "file: a: its packed bytes are damaged");
  EXPECT_EQ(refusal({{.name = "a\nb", .text = "text", .flags = 1}}), "file: a?b: is encrypted");
}

TEST(Zip, WhatUnpacksToMoreThanTheMemoryIsRefused) {
  const std::string zeros(3 << 20, '\0');
  EXPECT_EQ(refusal({{"a", zeros, true}, {"b", zeros, true}}, {.memory = 4 << 20}),
            "file: b: the archive unpacks to more than the limit of 4 MB (--max-memory)");
}

TEST(Zip, AnyLengthOrByteIsReadOrRefused) {
  const std::vector<std::uint8_t> whole = zip_of({{"a", "some text, some text", true}, {"b", "text", false, true}});
  const auto read = [](const std::vector<std::uint8_t>& bytes) {
    try {
      ImportBudget budget("file", {});
      ZipArchive archive(bytes, budget);
      for (std::size_t i = 0; i < archive.names().size(); ++i) archive.read(i, [](std::span<const std::uint8_t>) {});
    } catch (const Error& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("file: "));
    }
  };
  for (std::size_t n = 0; n < whole.size(); ++n) read({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n)});
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const int value : {0, 1, 127, 255}) {
      std::vector<std::uint8_t> bytes = whole;
      bytes[i] = static_cast<std::uint8_t>(value);
      read(bytes);
    }
}

}  // namespace
}  // namespace zoneplate
