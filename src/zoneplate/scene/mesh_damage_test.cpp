// Damaged PLY, STL and OBJ files: loading ends with a sound scene or with one line that says why not.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "zoneplate/scene/damage_for_test.h"
#include "zoneplate/scene/obj.h"
#include "zoneplate/scene/ply.h"
#include "zoneplate/scene/stl.h"

namespace zoneplate {
namespace {

using Loader = Scene (*)(const std::string&, const LoadLimits&);
using Bytes = std::vector<std::uint8_t>;

struct Sample {
  const char* name;
  Loader load;
  Bytes bytes;
};

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

template <class T>
void add(Bytes& out, T value, bool is_big = false) {
  std::uint8_t raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T); ++i) out.push_back(raw[is_big ? sizeof(T) - 1 - i : i]);
}

/// Everything that a PLY file may have: all types, a list among the vertices, faces of several lengths, strips, edges.
Bytes binary_ply(bool is_big) {
  Bytes out = bytes_of(std::string("ply\nformat binary_") + (is_big ? "big" : "little") +
                       "_endian 1.0\ncomment TextureFile none.png\nelement vertex 5\nproperty double x\n"
                       "property float y\nproperty short z\nproperty list uchar int more\nproperty float nx\n"
                       "property float ny\nproperty float nz\nproperty ushort red\nproperty uchar green\n"
                       "property float blue\nproperty float s\nproperty float t\nelement other 2\n"
                       "property list ushort double stuff\nelement face 3\nproperty list uint uchar vertex_indices\n"
                       "property list uchar float texcoord\nelement tristrips 1\n"
                       "property list int int vertex_indices\nelement edge 2\nproperty uchar vertex1\n"
                       "property int vertex2\nend_header\n");
  for (int i = 0; i < 5; ++i) {
    add<double>(out, i % 2, is_big), add<float>(out, 0.5f * static_cast<float>(i), is_big);
    add<std::int16_t>(out, static_cast<std::int16_t>(i * i - 4), is_big);
    add<std::uint8_t>(out, static_cast<std::uint8_t>(i % 3), is_big);
    for (int k = 0; k < i % 3; ++k) add<std::int32_t>(out, k, is_big);
    add<float>(out, 0, is_big), add<float>(out, 2, is_big), add<float>(out, 0, is_big);
    add<std::uint16_t>(out, 40000, is_big), add<std::uint8_t>(out, 200, is_big), add<float>(out, 0.5f, is_big);
    add<float>(out, 0.25f, is_big), add<float>(out, 0.75f, is_big);
  }
  for (const int n : {1, 2}) {
    add<std::uint16_t>(out, static_cast<std::uint16_t>(n), is_big);
    for (int k = 0; k < n; ++k) add<double>(out, k, is_big);
  }
  for (const int n : {3, 5, 4}) {
    add<std::uint32_t>(out, static_cast<std::uint32_t>(n), is_big);
    for (int k = 0; k < n; ++k) add<std::uint8_t>(out, static_cast<std::uint8_t>(k), is_big);
    add<std::uint8_t>(out, static_cast<std::uint8_t>(2 * n), is_big);
    for (int k = 0; k < 2 * n; ++k) add<float>(out, 0.1f * static_cast<float>(k), is_big);
  }
  add<std::int32_t>(out, 5, is_big);
  for (const int v : {0, 1, 2, -1, 3}) add<std::int32_t>(out, v, is_big);
  for (int i = 0; i < 2; ++i) add<std::uint8_t>(out, 0, is_big), add<std::int32_t>(out, i + 1, is_big);
  return out;
}

Bytes binary_stl() {
  std::string header = "COLOR=\x80\x40\x20\xff";
  header.resize(80, ' ');
  Bytes out = bytes_of(header);
  add<std::uint32_t>(out, 4);
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 12; ++k) add<float>(out, static_cast<float>((k * k + i) % 7));
    add<std::uint16_t>(out, static_cast<std::uint16_t>(i * 9000));
  }
  return out;
}

const char* const ascii_stl =
    "solid first\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\nendfacet\n"
    "endsolid first\nSOLID second\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 2 0 0\nVERTEX 2 2 0\n"
    "VERTEX 1 0.5 0\nVERTEX 0 2 0\nENDLOOP\nENDFACET\nENDSOLID\n";

const char* const ascii_ply =
    "ply\r\nformat ascii 1.0\r\nelement vertex 4\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\n"
    "property uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\nelement face 2\r\n"
    "property list uchar int vertex_index\r\nend_header\r\n0 0 0 255 0 0\r\n1 0 0 0 255 0\r\n1 1 0 0 0 255\r\n"
    "0 1 -0.5e-1 9 9 9\r\n3 0 1 2\r\n4 0 1 2 3\r\n";

const char* const obj =
    "# all of it\no thing\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0.5 0.25 0 1 1 1\nv 0 1 0 1 1 1\nvt 0 0\n"
    "vt 1 0 0\nvt 1 1\nvn 0 0 1\ns 1\nusemtl none\nf 1/1/1 2/2/1 3/3/1\ng part\ns off\nf 1 2 3 4 5\nf -1//-1 -2//-1 "
    "-3//-1\nl 1 2 3\np 4\nf 1 2 \\\n3\n";

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
    EXPECT_GT(refused, 20) << s.name;
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

/// Texts with every number replaced by others, huge ones among them.
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
    // Rows of nothing take no room and no time.
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
