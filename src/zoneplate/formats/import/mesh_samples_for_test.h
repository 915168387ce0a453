// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace zoneplate::mesh_samples {

// Small files that use most features of their formats, for tests and as seeds of the fuzz targets.

using Bytes = std::vector<std::uint8_t>;

inline Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

template <class T>
void add(Bytes& out, T value, bool is_big = false) {
  std::uint8_t raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T); ++i) out.push_back(raw[is_big ? sizeof(T) - 1 - i : i]);
}

/// A PLY file with all types, a list property of the vertices, faces of several lengths, strips and edges.
inline Bytes binary_ply(bool is_big) {
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

inline Bytes binary_stl() {
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

inline constexpr const char* ascii_stl =
    "solid first\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\nendfacet\n"
    "endsolid first\nSOLID second\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 2 0 0\nVERTEX 2 2 0\n"
    "VERTEX 1 0.5 0\nVERTEX 0 2 0\nENDLOOP\nENDFACET\nENDSOLID\n";

inline constexpr const char* ascii_ply =
    "ply\r\nformat ascii 1.0\r\nelement vertex 4\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\n"
    "property uchar red\r\nproperty uchar green\r\nproperty uchar blue\r\nelement face 2\r\n"
    "property list uchar int vertex_index\r\nend_header\r\n0 0 0 255 0 0\r\n1 0 0 0 255 0\r\n1 1 0 0 0 255\r\n"
    "0 1 -0.5e-1 9 9 9\r\n3 0 1 2\r\n4 0 1 2 3\r\n";

inline constexpr const char* obj =
    "# all of it\no thing\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0.5 0.25 0 1 1 1\nv 0 1 0 1 1 1\nvt 0 0\n"
    "vt 1 0 0\nvt 1 1\nvn 0 0 1\ns 1\nusemtl none\nf 1/1/1 2/2/1 3/3/1\ng part\ns off\nf 1 2 3 4 5\nf -1//-1 -2//-1 "
    "-3//-1\nl 1 2 3\np 4\nf 1 2 \\\n3\n";

inline constexpr const char* mtl =
    "newmtl a\nKd 0.5 0.5 0.5\nKa 1 1 1\nKs 0 0 1\nKe 0.1 0 0\nNs 50\nd 0.5\nTr 0.5\nillum 2\nPr 0.3\nPm 1\n"
    "map_Kd -o 1 2 -s 2 2 1 -clamp on a b.png\nmap_Ke \"c.png\"\nmap_d -imfchan m d.png\nnorm -bm 0.5 n.png\n"
    "map_bump e.png\nnewmtl b\r\nKd spectral x.rfl 1\nKs xyz 1 2 3\n";

}  // namespace zoneplate::mesh_samples
