// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace zoneplate {

// ICC profiles made in code (ICC.1:2022): a header of 128 bytes, a table of tags, and their data.

using IccBytes = std::vector<std::uint8_t>;

inline void put_icc(IccBytes& out, std::uint32_t value, int bytes = 4) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}
inline void put_icc(IccBytes& out, std::string_view text) { out.insert(out.end(), text.begin(), text.end()); }
inline void put_icc_fixed(IccBytes& out, double value) {
  put_icc(out, static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value * 65536))));
}

struct IccKind {
  std::string_view kind = "mntr", pixels = "RGB ", connection = "XYZ ";
};

inline IccBytes icc_of(const IccKind& kind, const std::vector<std::pair<std::string_view, IccBytes>>& tags) {
  IccBytes table, data;
  put_icc(table, static_cast<std::uint32_t>(tags.size()));
  for (const auto& [name, value] : tags) {
    // Equal values are stored once, as programs do.
    auto found = std::search(data.begin(), data.end(), value.begin(), value.end());
    if (found == data.end()) found = data.insert(data.end(), value.begin(), value.end());
    put_icc(table, name);
    put_icc(table,
            static_cast<std::uint32_t>(128 + 4 + 12 * tags.size()) + static_cast<std::uint32_t>(found - data.begin()));
    put_icc(table, static_cast<std::uint32_t>(value.size()));
    while (data.size() % 4 != 0) data.push_back(0);
  }
  IccBytes out;
  put_icc(out, static_cast<std::uint32_t>(128 + table.size() + data.size()));
  put_icc(out, "lcms");
  put_icc(out, 0x04300000);
  put_icc(out, kind.kind), put_icc(out, kind.pixels), put_icc(out, kind.connection);
  out.resize(36);
  put_icc(out, "acsp");
  out.resize(68);
  for (const double white : {0.9642, 1.0, 0.8249}) put_icc_fixed(out, white);
  out.resize(128);
  out.insert(out.end(), table.begin(), table.end());
  out.insert(out.end(), data.begin(), data.end());
  return out;
}

inline IccBytes icc_text(std::string_view ascii) {
  IccBytes out;
  put_icc(out, "mluc");
  for (const std::uint32_t word : {0u, 1u, 12u}) put_icc(out, word);
  put_icc(out, "enUS");
  put_icc(out, static_cast<std::uint32_t>(2 * ascii.size())), put_icc(out, 28);
  for (const char c : ascii) put_icc(out, static_cast<std::uint32_t>(c), 2);
  return out;
}

inline IccBytes icc_xyz(std::array<double, 3> xyz) {
  IccBytes out;
  put_icc(out, "XYZ "), put_icc(out, 0);
  for (const double v : xyz) put_icc_fixed(out, v);
  return out;
}

/// value^gamma, as a parametric curve.
inline IccBytes icc_power(double gamma) {
  IccBytes out;
  put_icc(out, "para"), put_icc(out, 0), put_icc(out, 0);
  put_icc_fixed(out, gamma);
  return out;
}

/// sRGB's curve, as a parametric one.
inline IccBytes icc_srgb_curve() {
  IccBytes out;
  put_icc(out, "para"), put_icc(out, 0), put_icc(out, 3, 2), put_icc(out, 0, 2);
  for (const double v : {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045}) put_icc_fixed(out, v);
  return out;
}

/// A curve of points, as a table.
inline IccBytes icc_table(const std::vector<double>& light) {
  IccBytes out;
  put_icc(out, "curv"), put_icc(out, 0), put_icc(out, static_cast<std::uint32_t>(light.size()));
  for (const double v : light) put_icc(out, static_cast<std::uint32_t>(std::lround(v * 65535)), 2);
  return out;
}

/// A profile of primaries and of a curve for all of them.
inline IccBytes icc_of_primaries(const std::array<std::array<double, 3>, 3>& xyz, const IccBytes& curve,
                                 std::string_view name, const IccKind& kind = {}) {
  return icc_of(kind, {{"desc", icc_text(name)},
                       {"wtpt", icc_xyz({0.9642, 1, 0.8249})},
                       {"rXYZ", icc_xyz(xyz[0])},
                       {"gXYZ", icc_xyz(xyz[1])},
                       {"bXYZ", icc_xyz(xyz[2])},
                       {"rTRC", curve},
                       {"gTRC", curve},
                       {"bTRC", curve}});
}

/// XYZ of red, green and blue relative to D50.
inline constexpr std::array<std::array<double, 3>, 3> p3_primaries = {
    {{0.51512, 0.2412, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.1571, 0.06657, 0.78407}}};
inline constexpr std::array<std::array<double, 3>, 3> srgb_icc_primaries = {
    {{0.43607, 0.22249, 0.01392}, {0.38515, 0.71687, 0.09708}, {0.14307, 0.06061, 0.7141}}};

inline IccBytes icc_display_p3() { return icc_of_primaries(p3_primaries, icc_srgb_curve(), "Display P3"); }

/// A profile with a table from codes to XYZ: XYZ is 1 + 32767/32768 times the square of the code.
inline IccBytes icc_of_table() {
  IccBytes lut;
  put_icc(lut, "mft2"), put_icc(lut, 0);
  for (const std::uint32_t byte : {3u, 3u, 2u, 0u}) put_icc(lut, byte, 1);  // channels in and out, nodes, padding
  for (int i = 0; i < 9; ++i) put_icc_fixed(lut, i % 4 == 0);
  constexpr std::uint32_t steps = 256;
  put_icc(lut, steps, 2), put_icc(lut, 2, 2);
  for (int c = 0; c < 3; ++c)
    for (std::uint32_t i = 0; i < steps; ++i) put_icc(lut, (i * i * 65535 + 32512) / (255 * 255), 2);
  for (int node = 0; node < 8; ++node)
    for (const int bit : {4, 2, 1}) put_icc(lut, (node & bit) != 0 ? 65535 : 0, 2);
  for (int c = 0; c < 3; ++c) put_icc(lut, 0, 2), put_icc(lut, 65535, 2);
  return icc_of({.kind = "scnr"},
                {{"desc", icc_text("a scanner")}, {"wtpt", icc_xyz({0.9642, 1, 0.8249})}, {"A2B0", lut}});
}

}  // namespace zoneplate
