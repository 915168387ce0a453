// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/manifest.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

class ManifestFile : public testing::Test {
 protected:
  ManifestFile() : path((std::filesystem::temp_directory_path() / "zoneplate_manifest_XXXXXX").string()) {
    ::close(::mkstemp(path.data()));
  }
  ~ManifestFile() override { std::filesystem::remove(path); }

  std::string error_of(const std::string& text, std::uint64_t max_bytes = 1 << 28) const {
    std::ofstream(path) << text;
    try {
      const Manifest manifest(path, max_bytes);
      return "";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      return error.what();
    }
  }

  std::string path;
};

TEST_F(ManifestFile, LinesKeepTheirNumbersAndBlankOnesAreNone) {
  std::ofstream(path) << "{\"a\":1}\r\n\n  \t\n{}\nlast";
  const Manifest manifest(path, 1000);
  ASSERT_EQ(manifest.size(), 3u);
  EXPECT_EQ(manifest.text(0), "{\"a\":1}\r");
  EXPECT_EQ(manifest.text(1), "{}");
  EXPECT_EQ(manifest.text(2), "last");
  EXPECT_EQ(manifest.place(1), path + ": line 4");
}

TEST_F(ManifestFile, LinesOfAnyLengthAreWhole) {
  std::string text;
  for (std::size_t i = 0; i < 3000; ++i) text += std::string(1 + i * 7 % 5000, static_cast<char>('a' + i % 26)) + '\n';
  std::ofstream(path) << text;
  const Manifest manifest(path, 1 << 28);
  std::string again;
  for (std::uint64_t i = 0; i < manifest.size(); ++i) again += std::string(manifest.text(i)) + '\n';
  EXPECT_EQ(again, text);
}

TEST_F(ManifestFile, LinesAndBytesAreLimited) {
  EXPECT_EQ(error_of("a\n" + std::string(65536, 'b') + "\n"), "");
  EXPECT_EQ(error_of("a\n" + std::string(65537, 'b') + "\n"), path + ": line 2: longer than 65536 bytes");
  EXPECT_EQ(error_of(std::string(3'000'000, 'b')), path + ": line 1: longer than 65536 bytes");
  std::string jobs;
  for (int i = 0; i < 1'000'000; ++i) jobs += "a\n";
  EXPECT_EQ(error_of(jobs), "");
  EXPECT_EQ(error_of(jobs + "a\n"), path + ": a manifest of more than 1000000 jobs: split it");
  EXPECT_EQ(error_of(jobs, 100), path + ": a manifest of more than 100 bytes, half of --max-memory: split it");
  EXPECT_EQ(error_of(std::string(2'000'000, '\n'), 1'000'000),
            path + ": a manifest of more than 1000000 bytes, half of --max-memory: split it");
}

}  // namespace
}  // namespace zoneplate
