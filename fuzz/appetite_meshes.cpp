// SPDX-License-Identifier: Apache-2.0
// PLY and STL files.
#include <fmt/format.h>

#include "appetite.h"

namespace zoneplate::appetite {
namespace {

constexpr const char* position = "property float x\nproperty float y\nproperty float z\n";

std::string ply(std::string_view format, std::string_view elements) {
  return fmt::format("ply\nformat {} 1.0\n{}end_header\n", format, elements);
}

/// Vertices, faces and what the list of a face is called.
std::string mesh_elements(std::uint64_t vertices, std::uint64_t faces, std::string_view list = "uint uint") {
  return fmt::format("element vertex {}\n{}element face {}\nproperty list {} vertex_indices\n", vertices, position,
                     faces, list);
}

Bytes binary(const std::string& header, std::size_t zeros) {
  Bytes out(header.begin(), header.end());
  out.resize(out.size() + zeros);
  return out;
}

void add_ply(Collection& out) {
  const auto add = [&](const char* name, const Bytes& bytes, const char* codes) {
    out.add("ply", name, bytes, codes, {{"size", "64x64"}});
  };
  constexpr const char* little = "binary_little_endian";
  add("ply-vertices-2-40.ply", binary(ply(little, mesh_elements(std::uint64_t{1} << 40, 1)), 1000), refused);
  Bytes list = binary(ply(little, mesh_elements(3, 1, "uint uint")), 36);
  list.insert(list.end(), {0, 0, 0, 0x80});  // 2^31 indices
  add("ply-list-2-31.ply", list, refused);
  const std::string ascii = ply("ascii", mesh_elements(3, 1));
  add("ply-ascii-list-2-31.ply", binary(ascii + "0 0 0\n1 0 0\n0 1 0\n2147483648 0 1 2\n", 0), refused);
  add("ply-empty-faces.ply", binary(ply(little, mesh_elements(3, 8000000, "uchar uchar")), 36 + 8000000),
      within_limits);
  Bytes polygon = binary(ply(little, mesh_elements(3, 1, "uint uchar")), 36);
  polygon.insert(polygon.end(), {0x00, 0x12, 0x7a, 0x00});  // 8,000,000 indices, all 0
  polygon.resize(polygon.size() + 8000000);
  add("ply-polygon.ply", polygon, within_limits);
  const std::string nothing = fmt::format("element other {}\n", (std::uint64_t{1} << 48) - 1);
  add("ply-elements-of-nothing.ply", binary(ply(little, nothing + mesh_elements(3, 0)), 36), within_limits);
  add("ply-ascii-of-nothing.ply", binary(ply("ascii", nothing + mesh_elements(3, 0)) + "0 0 0\n1 0 0\n0 1 0\n", 0),
      within_limits);
  std::string wide = "element vertex 4000\n" + std::string(position);
  for (int i = 0; i < 1000; ++i) wide += fmt::format("property list uchar uchar p{}\n", i);
  add("ply-wide.ply", binary(ply(little, wide), 4000 * 1012), within_limits);
  add("ply-points.ply", binary(ply(little, fmt::format("element vertex 700000\n{}", position)), 700000 * 12),
      within_limits);
  add("ply-header.ply", binary("ply\nformat ascii 1.0\n" + repeated("comment of nothing\n", 400000), 0), refused);
  const std::string strips = mesh_elements(3, 0) + "element tristrips 1\nproperty list int char vertex_indices\n";
  Bytes strip = binary(ply(little, strips), 36);
  strip.insert(strip.end(), {0x00, 0x12, 0x7a, 0x00});
  strip.resize(strip.size() + 8000000);
  add("ply-strip.ply", strip, within_limits);
}

void add_stl(Collection& out) {
  const auto add = [&](const char* name, const Bytes& bytes, const char* codes) {
    out.add("stl", name, bytes, codes, {{"size", "64x64"}});
  };
  Bytes claim(80, ' ');
  claim.insert(claim.end(), {0xff, 0xff, 0xff, 0xff});
  claim.resize(claim.size() + 500);
  add("stl-claim.stl", claim, within_limits);
  Bytes zeros(80, ' ');
  zeros.insert(zeros.end(), {0xa0, 0x86, 0x01, 0x00});  // 100,000 triangles of nothing
  zeros.resize(84 + 50 * 100000);
  add("stl-zeros.stl", zeros, within_limits);
  const auto text = [](std::string_view all) { return Bytes(all.begin(), all.end()); };
  add("stl-solids.stl", text(repeated("solid\nendsolid\n", 500000)), within_limits);
  add("stl-loop.stl",
      text("solid a\nfacet normal 0 0 1\nouter loop\n" + repeated("vertex 0 0 0\n", 500000) +
           "endloop\nendfacet\nendsolid\n"),
      within_limits);
  add("stl-facets.stl",
      text("solid a\n" +
           repeated("facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n", 80000)),
      within_limits);
  add("stl-line.stl", text("solid " + std::string(8000000, 'a')), within_limits);
}

}  // namespace

void add_ply_and_stl(Collection& out) {
  add_ply(out);
  add_stl(out);
}

}  // namespace zoneplate::appetite
