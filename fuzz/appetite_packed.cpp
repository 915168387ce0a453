// SPDX-License-Identifier: Apache-2.0
// glTF files whose bytes are packed: by Draco, by meshoptimizer, in chunks, or one file that is used many times.
#include <algorithm>

#include "appetite_gltf.h"

namespace zoneplate::appetite {
namespace {

using Json = Gltf::Json;

/// A number in groups of seven bits, the least first, as Draco has it.
void append_varint(Bytes& out, std::uint64_t value) {
  for (; value >= 128; value >>= 7) out.push_back(static_cast<std::uint8_t>(value | 128));
  out.push_back(static_cast<std::uint8_t>(value));
}

/// The beginning of a Draco mesh of version 2.2; `method` is 0 for lists, 1 for the edgebreaker.
Bytes draco_header(std::uint8_t method) { return {'D', 'R', 'A', 'C', 'O', 2, 2, 1, method, 0, 0}; }

void add_draco_mesh(Collection& out, const std::string& name, const Bytes& packed, std::uint64_t faces,
                    std::uint64_t points, const char* codes) {
  Gltf file;
  const std::size_t view = file.view(packed);
  file.mesh(
      {{"POSITION", file.zeros(points, "VEC3")}},
      {{"indices", file.zeros(3 * faces, "SCALAR", 5125)},
       {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", {{"POSITION", 0}}}}}}}});
  file.add_root({{"mesh", 0}});
  out.add("draco", name, file.glb(), codes);
}

void add_draco(Collection& out) {
  constexpr std::uint64_t many = std::uint64_t{1} << 28;
  Bytes list = draco_header(0);  // faces and points by lists, of indices that are not there
  append_varint(list, many), append_varint(list, many), list.push_back(1);
  add_draco_mesh(out, "draco-list.glb", list, many, many, refused);

  // What Draco 1.5 makes of equal indices and equal positions: symbols that take no bits, whatever their number.
  constexpr std::uint8_t zeros[] = {0, 1, 1, 1, 1, 64, 1, 0, 1, 1, 0, 9, 3, 0, 0, 2, 0, 1, 1, 1, 3, 1, 1, 64, 1};
  const auto equal = [&](std::uint64_t faces, std::uint64_t points, std::size_t padding) {
    Bytes packed = draco_header(0);
    append_varint(packed, faces), append_varint(packed, points);
    packed.insert(packed.end(), std::begin(zeros), std::end(zeros));
    packed.resize(packed.size() + 23);
    packed.insert(packed.end(), {0x80, 0x3f, 8});
    packed.resize(packed.size() + padding);
    return packed;
  };
  // Draco refuses more faces than a third of the bytes that are left.
  constexpr std::uint64_t faces = 1000000;
  add_draco_mesh(out, "draco-faces.glb", equal(faces, 3, 3 * faces), faces, 3, within_limits);
  add_draco_mesh(out, "draco-points.glb", equal(faces, 3 * faces, 3 * faces), faces, 3 * faces, within_limits);
  add_draco_mesh(out, "draco-many.glb", equal(1 << 30, 1 << 30, 0), 1 << 30, 1 << 30, refused);
  add_draco_mesh(out, "draco-untold.glb", equal(faces, 3 * faces, 3 * faces), 1, 3, refused);

  Bytes edges = draco_header(1);
  edges.push_back(0);
  for (const std::uint64_t n : {many, many, std::uint64_t{255}, many, std::uint64_t{0}}) append_varint(edges, n);
  edges.resize(edges.size() + 64);
  add_draco_mesh(out, "draco-edgebreaker.glb", edges, many, many, refused);
}

/// A view packed by meshoptimizer that says to hold `count` elements of `stride` bytes.
void add_meshopt_view(Collection& out, const std::string& name, const Bytes& packed, std::uint64_t count,
                      std::uint64_t stride, const char* mode, const char* codes) {
  Gltf file;
  file.view(packed);
  file.root["extensionsUsed"] = {"EXT_meshopt_compression"};
  const bool is_list = std::string(mode) == "TRIANGLES";
  const std::size_t view = file.append("bufferViews", {{"buffer", 0},
                                                       {"byteLength", count * stride},
                                                       {"extensions",
                                                        {{"EXT_meshopt_compression",
                                                          {{"buffer", 0},
                                                           {"byteOffset", 0},
                                                           {"byteLength", packed.size()},
                                                           {"byteStride", stride},
                                                           {"count", count},
                                                           {"mode", mode}}}}}});
  const std::size_t packed_accessor = file.append("accessors", {{"bufferView", view},
                                                                {"componentType", is_list ? 5125 : 5126},
                                                                {"count", count},
                                                                {"type", is_list ? "SCALAR" : "VEC3"}});
  if (is_list)
    file.mesh({{"POSITION", file.zeros(3, "VEC3")}}, {{"indices", packed_accessor}});
  else
    file.mesh({{"POSITION", packed_accessor}});
  file.add_root({{"mesh", 0}});
  out.add("meshopt", name, file.glb(), codes);
}

/// `count` equal vertices of 12 bytes, as meshoptimizer packs them: for each byte of a vertex, 256 deltas of zero take
/// 4 bytes.
Bytes equal_vertices(std::size_t count) {
  constexpr std::size_t stride = 12, block = 256, groups = 16, tail = 32;
  Bytes out{0xa0};
  for (std::size_t first = 0; first < count; first += block) {
    const std::size_t here = (std::min(block, count - first) + groups - 1) / groups;
    out.resize(out.size() + stride * ((here + 3) / 4));
  }
  out.resize(out.size() + tail);
  return out;
}

void add_meshopt(Collection& out) {
  add_meshopt_view(out, "meshopt-claim.glb", Bytes(64, 0xa0), std::uint64_t{1} << 31, 12, "ATTRIBUTES", refused);
  add_meshopt_view(out, "meshopt-zeros.glb", equal_vertices(3000000), 3000000, 12, "ATTRIBUTES", within_limits);
  // The first triangle has three new vertices, each other one an edge and a vertex of those.
  constexpr std::size_t count = 3000000, table = 16;
  Bytes triangles(1 + count + table, 1);
  triangles[0] = 0xe1, triangles[1] = 0xf0;
  std::fill(triangles.end() - table, triangles.end(), std::uint8_t{0});
  add_meshopt_view(out, "meshopt-triangles.glb", triangles, 3 * count, 4, "TRIANGLES", within_limits);
}

void append_u32(Bytes& out, std::uint32_t v) {
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(v >> (8 * i)));
}

void add_chunks(Collection& out) {
  Gltf file;
  file.zero_mesh(3), file.add_root({{"mesh", 0}});
  Bytes glb = file.glb();
  Bytes many = glb;
  for (int i = 0; i < 500000; ++i) append_u32(many, 0), append_u32(many, 0x21212121);
  const auto set_length = [](Bytes& bytes, std::uint32_t length) {
    for (std::size_t i = 0; i < 4; ++i) bytes[8 + i] = static_cast<std::uint8_t>(length >> (8 * i));
  };
  set_length(many, static_cast<std::uint32_t>(many.size()));
  out.add("chunks", "chunks-500k.glb", many, within_limits);
  append_u32(glb, 0xfffffff0), append_u32(glb, 0x004e4942);
  set_length(glb, 0xffffffff);
  out.add("chunks", "chunks-claim.glb", glb, refused);
}

/// One file that is a buffer or an image again and again.
void add_repeated_files(Collection& out) {
  out.write("repeated.bin", Bytes(4 << 20));
  Gltf buffers;
  for (int i = 0; i < 5000; ++i) {
    buffers.append("buffers", {{"uri", "repeated.bin"}, {"byteLength", 4 << 20}});
    buffers.append("bufferViews", {{"buffer", i}, {"byteLength", 36}});
    buffers.append("accessors", {{"bufferView", i}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    buffers.mesh({{"POSITION", i}});
    buffers.add_root({{"mesh", i}});
  }
  out.add("files", "files-buffers.gltf", buffers.json(), within_limits, {{"size", "32x32"}}, 4 << 20);

  Gltf data;  // text that is bytes, in many buffers
  const std::string uri = "data:application/octet-stream;base64," + std::string(1 << 20, 'A');
  for (int i = 0; i < 6; ++i) data.append("buffers", {{"uri", uri}, {"byteLength", 3 << 18}});
  for (int i = 0; i < 6; ++i) {
    data.append("bufferViews", {{"buffer", i}, {"byteLength", 3 << 18}});
    data.append("accessors", {{"bufferView", i}, {"componentType", 5126}, {"count", 1 << 16}, {"type", "VEC3"}});
    data.mesh({{"POSITION", i}});
    data.place_at_zero(static_cast<std::size_t>(i), 2000);
  }
  out.add("files", "files-data.gltf", data.json(), within_limits, {{"size", "32x32"}});
}

}  // namespace

void add_gltf_packed(Collection& out) {
  add_draco(out);
  add_meshopt(out);
  add_chunks(out);
  add_repeated_files(out);
}

}  // namespace zoneplate::appetite
