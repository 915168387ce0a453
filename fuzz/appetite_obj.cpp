// SPDX-License-Identifier: Apache-2.0
// OBJ and MTL files.
#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "appetite.h"
#include "zoneplate/math/random.h"

namespace zoneplate::appetite {
namespace {

constexpr const char* corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// The number that an odd one must be multiplied with to become 1, modulo 2^32.
constexpr std::uint32_t inverse(std::uint32_t odd) {
  std::uint32_t x = odd;  // right in the three lowest bits; each step doubles them
  for (int i = 0; i < 4; ++i) x *= 2 - odd * x;
  return x;
}

/// What one round of `hash` (math/random.h) made `h` of.
constexpr std::uint32_t unmixed(std::uint32_t h) {
  h = (h ^ (h >> 16)) * inverse(0x846ca68bu);
  h = (h ^ (h >> 15) ^ (h >> 30)) * inverse(0x7feb352du);
  return h ^ (h >> 16);
}

/// Positions that all have the same lowest 20 bits of their hash, and so the same place in a table that takes those.
std::string colliding_positions(std::size_t count) {
  constexpr std::uint32_t slot = 0x5a5a5, slot_bits = 20;
  std::string out;
  for (std::size_t found = 0, row = 1; found < count; ++row) {
    const float y = static_cast<float>(row);
    // hash(x, y, 0) is mix(x + rest) for a rest that does not depend on x.
    const std::uint32_t rest = unmixed(hash(0, std::bit_cast<std::uint32_t>(y)));
    for (std::uint32_t top = 0; top < 1u << (32 - slot_bits) && found < count; ++top) {
      const float x = std::bit_cast<float>(unmixed(top << slot_bits | slot) - rest);
      if (!(std::abs(x) > 1e-6f && std::abs(x) < 1e6f)) continue;
      out += fmt::format("v {} {} 0\n", x, y);
      ++found;
    }
  }
  return out;
}

void add_collisions(Collection& out) {
  for (const std::size_t count : {50000u, 200000u})
    out.add("obj-collisions", fmt::format("obj-collisions-{}k.obj", count / 1000),
            colliding_positions(count) + "f 1 2 3\n", within_limits);
}

void add_switches(Collection& out) {
  const auto add = [&](const char* name, std::string_view a, std::string_view b) {
    std::string text = std::string("mtllib obj-switches.mtl\n") + corners;
    text += repeated(fmt::format("{}{}", a, b), 500000) + "f 1 2 3\n";
    out.add("obj-switches", name, text, within_limits);
  };
  const std::string materials = "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n";
  out.write("obj-switches.mtl", Bytes(materials.begin(), materials.end()));
  add("obj-switches-usemtl.obj", "usemtl a\n", "usemtl b\n");
  add("obj-switches-group.obj", "g a\n", "g b\n");
  add("obj-switches-smooth.obj", "s 1\n", "s 2\n");
  add("obj-switches-faces.obj", "usemtl a\nf 1 2 3\n", "usemtl b\nf 1 2 3\n");

  std::string objects = corners;
  for (int i = 0; i < 300000; ++i) objects += fmt::format("o {}\nf 1 2 3\n", i);
  out.add("obj-switches", "obj-switches-objects.obj", objects, within_limits);
  std::string groups = corners;
  for (int i = 0; i < 300000; ++i) groups += fmt::format("s {}\nf 1 2 3\n", i + 1);
  out.add("obj-switches", "obj-switches-smoothing.obj", groups, within_limits);
}

/// One face around all vertices.
std::string polygon(std::size_t count, double turns, double inner) {
  std::string text, face = "f";
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 6.283185307179586 * turns * static_cast<double>(i) / static_cast<double>(count);
    const double radius = i % 2 == 0 ? 1 : inner;
    text += fmt::format("v {:.6f} {:.6f} 0\n", radius * std::cos(angle), radius * std::sin(angle));
    face += fmt::format(" {}", i + 1);
  }
  return text + face + "\n";
}

void add_polygons(Collection& out) {
  out.add("obj-polygons", "obj-polygon-convex.obj", polygon(300000, 1, 1), within_limits);
  out.add("obj-polygons", "obj-polygon-star.obj", polygon(100000, 1, 0.1), within_limits);
  out.add("obj-polygons", "obj-polygon-crossing.obj", polygon(50001, 20000.5, 1), within_limits);
  out.add("obj-polygons", "obj-polygon-same.obj", corners + ("f" + repeated(" 1 2 3", 500000)) + "\n", within_limits);
  out.add("obj-polygons", "obj-polygon-lines.obj", std::string(corners) + "f 1 2" + repeated(" \\\n3", 500000) + "\n",
          within_limits);
}

void add_lists(Collection& out) {
  out.add("obj-lists", "obj-vertices.obj", repeated("v 0 0 0\n", 1000000) + "f 1 2 3\n", within_limits);
  out.add("obj-lists", "obj-faces.obj", corners + repeated("f 1 2 3\n", 1000000), within_limits);
  out.add("obj-lists", "obj-lines.obj", corners + repeated("l 1 2 3\n", 500000), within_limits,
          {{"size", "64x64"}, {"line-width", "50"}});
  out.add("obj-lists", "obj-points.obj", corners + ("p" + repeated(" 1", 1000000)) + "\n", within_limits,
          {{"size", "64x64"}, {"point-size", "50"}});
  std::string fans = repeated("v 0 0 0\n", 20000);  // as many faces at a place as are compared with each other
  for (int i = 0; i + 2 < 20000; i += 3) fans += repeated(fmt::format("f {} {} {}\n", i + 1, i + 2, i + 3), 80);
  out.add("obj-lists", "obj-fans.obj", fans, within_limits);
}

void add_materials(Collection& out) {
  const auto add = [&](const std::string& name, const std::string& head, const std::string& materials) {
    out.write(name + ".mtl", Bytes(materials.begin(), materials.end()));
    out.add("mtl", name + ".obj", head + corners + "f 1 2 3\n", within_limits, {}, materials.size());
  };
  std::string many, chain;
  for (int i = 0; i < 300000; ++i) many += fmt::format("newmtl m{}\n", i);
  for (int i = 0; i < 100000; ++i) chain += fmt::format("newmtl m{0}\nmap_Kd {0}.png\nmap_d {0}.png\n", i);
  add("mtl-many", "mtllib mtl-many.mtl\nusemtl m5\n", many);
  add("mtl-maps", "mtllib mtl-maps.mtl\nusemtl m5\n", chain);
  add("mtl-libraries", repeated("mtllib mtl-libraries.mtl\n", 300000), "newmtl a\nKd 1 0 0\n");
  add("mtl-library-names", "mtllib" + repeated(" mtl-library-names.mtl", 200000) + "\n", "newmtl a\nKd 1 0 0\n");
  add("mtl-large-library", repeated("mtllib mtl-large-library.mtl\n", 1000), repeated("newmtl a\nKd 1 0 0\n", 50000));
  std::string missing;
  for (int i = 0; i < 300000; ++i) missing += fmt::format("mtllib {}.mtl\n", i);
  add("mtl-missing", missing, "");
  std::string unknown;
  for (int i = 0; i < 300000; ++i) unknown += fmt::format("usemtl u{}\nf 1 2 3\n", i);
  add("mtl-unknown", "mtllib mtl-unknown.mtl\n" + (corners + unknown), "");
}

}  // namespace

void add_obj(Collection& out) {
  add_collisions(out);
  add_switches(out);
  add_polygons(out);
  add_lists(out);
  add_materials(out);
}

}  // namespace zoneplate::appetite
