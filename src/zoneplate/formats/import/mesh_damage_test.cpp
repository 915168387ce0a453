// SPDX-License-Identifier: Apache-2.0
// Damaged PLY, STL and OBJ files: loading gives a valid scene or an error message of one line.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "zoneplate/formats/import/damage_for_test.h"
#include "zoneplate/formats/import/mesh_samples_for_test.h"
#include "zoneplate/formats/obj/obj.h"
#include "zoneplate/formats/ply/ply.h"
#include "zoneplate/formats/stl/stl.h"

namespace zoneplate {
namespace {

using Loader = Scene (*)(const std::string&, const LoadLimits&);
using namespace mesh_samples;

struct Sample {
  const char* name;
  Loader load;
  Bytes bytes;
};

std::vector<Sample> samples() {
  return {{"binary PLY", load_ply, binary_ply(false)},  {"big-endian PLY", load_ply, binary_ply(true)},
          {"ASCII PLY", load_ply, bytes_of(ascii_ply)}, {"binary STL", load_stl, binary_stl()},
          {"ASCII STL", load_stl, bytes_of(ascii_stl)}, {"OBJ", load_obj, bytes_of(obj)}};
}

TEST(MeshDamage, TheSamplesThemselvesAreSound) {
  const MemoryFile file;
  for (const Sample& s : samples()) EXPECT_EQ(load_soundly(s.load, file.write(s.bytes)), "") << s.name;
}

TEST(MeshDamage, AnyByteChanged) {
  const MemoryFile file;
  std::mt19937 random(1);
  for (const Sample& s : samples()) {
    int refused = 0;
    for (int i = 0; i < 3000; ++i) {
      Bytes bytes = s.bytes;
      for (auto n = 1 + random() % 3; n > 0; --n) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
      refused += load_soundly(s.load, file.write(bytes)) != "";
      if (testing::Test::HasFatalFailure()) FAIL() << s.name << " case " << i;
    }
    const bool is_of_its_size = s.name == std::string("binary STL");  // what it holds does not depend on its bytes
    EXPECT_GE(refused, is_of_its_size ? 0 : 20) << s.name;
    EXPECT_LT(refused, 3000) << s.name;
  }
}

TEST(MeshDamage, AnyLength) {
  const MemoryFile file;
  for (const Sample& s : samples())
    for (std::size_t n = 0; n < s.bytes.size(); ++n) {
      load_soundly(s.load, file.write({s.bytes.begin(), s.bytes.begin() + static_cast<std::ptrdiff_t>(n)}));
      if (testing::Test::HasFatalFailure()) FAIL() << s.name << " of length " << n;
    }
}

/// Replaces every number of the text files by others, including huge ones.
TEST(MeshDamage, AnyNumberReplaced) {
  const MemoryFile file;
  for (const Sample& s : samples()) {
    const std::string text(s.bytes.begin(), s.bytes.end());
    for (std::size_t i = 1; i < text.size(); ++i) {
      const std::size_t end = std::min(text.find_first_not_of("0123456789.", i), text.size());
      if (end == i || (text[i - 1] != ' ' && text[i - 1] != '\n' && text[i - 1] != '/')) continue;
      for (const char* value : {"-1", "0", "7", "65536", "4294967295", "281474976710655", "1e300", "nan", "", "x"}) {
        load_soundly(s.load, file.write(bytes_of(text.substr(0, i) + value + text.substr(end))));
        if (testing::Test::HasFatalFailure()) FAIL() << s.name << " at " << i << ": " << value;
      }
      i = end;
    }
  }
}

TEST(MeshDamage, CountsThatNoFileHoldsAreRefused) {
  const MemoryFile file;
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  const std::string xyz = "\nproperty float x\nproperty float y\nproperty float z\n";
  for (const char* count : {"4000000000", "281474976710655"}) {
    EXPECT_NE(load_soundly(load_ply, file.write(bytes_of(head + count + xyz + "end_header\n"))), "");
    const std::string face =
        "element face " + std::string(count) + "\nproperty list uchar int vertex_indices\nend_header\n";
    Bytes bytes = bytes_of(head + "1" + xyz + face);
    bytes.insert(bytes.end(), 12, 0);
    bytes.insert(bytes.end(), 1000, 0);
    EXPECT_NE(load_soundly(load_ply, file.write(bytes)), "");
    // Rows without properties take no memory and no time.
    EXPECT_NE(load_soundly(load_ply, file.write(bytes_of("ply\nformat ascii 1.0\nelement empty " + std::string(count) +
                                                         "\nelement vertex 0" + xyz + "end_header\n"))),
              "");
  }
  Bytes stl(84, 0);
  std::memset(&stl[80], 0xff, 4);
  EXPECT_NE(load_soundly(load_stl, file.write(stl)), "");
}

}  // namespace
}  // namespace zoneplate
