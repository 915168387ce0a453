// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/frame_parts.h"

#include <cstring>
#include <span>

namespace zoneplate {
namespace {

/// A plane as bytes; planes of a frame have one size.
struct PlaneBytes {
  std::byte* first;
  std::size_t pixel;
};

template <class T>
void add_plane(Plane<T>& plane, std::vector<PlaneBytes>& out) {
  if (!plane.empty()) out.push_back({reinterpret_cast<std::byte*>(plane.values().data()), sizeof(T)});
}

std::vector<PlaneBytes> planes_of(Frame& frame, bool data) {
  std::vector<PlaneBytes> out;
  const auto add = [&](auto&... planes) { (add_plane(planes, out), ...); };
  if (data) {
    Frame::for_surface_planes(frame, frame, [&](auto& plane, auto&) { add_plane(plane, out); });
    return out;
  }
  add(frame.color, frame.display8, frame.coverage, frame.error, frame.edge_distance);
  const auto add_all = [&](auto&... lists) {
    const auto add_list = [&](auto& list) {
      for (auto& plane : list) add_plane(plane, out);
    };
    (add_list(lists), ...);
  };
  add_all(frame.sample_color, frame.sample_depth, frame.sample_triangle, frame.sample_geometry);
  return out;
}

/// Neighbouring pixels of a plane.
struct PixelRun {
  std::uint32_t first, count;
};

std::vector<PixelRun> runs_of(const Plane<std::uint8_t>& held) {
  std::vector<PixelRun> runs;
  const auto values = held.values();
  for (std::size_t i = 0, end = 0; i < values.size(); i = end + 1) {
    end = i;
    while (end < values.size() && values[end] != 0) ++end;
    if (end > i) runs.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(end - i)});
  }
  return runs;
}

}  // namespace

void gather(Ranks& ranks, const Plane<std::uint8_t>& held, bool data, bool to_every_rank, Frame& frame) {
  const std::vector<PlaneBytes> planes = planes_of(frame, data);
  std::vector<ByteBuffer> to(static_cast<std::size_t>(ranks.count()));
  const auto own = static_cast<std::size_t>(ranks.rank());
  for (std::size_t r = 0; r < (to_every_rank ? to.size() : 1); ++r) {
    if (r == own || planes.empty()) continue;
    for (const PixelRun run : runs_of(held)) {
      to[r].put(run);
      for (const PlaneBytes& plane : planes)
        to[r].append({plane.first + run.first * plane.pixel, run.count * plane.pixel});
    }
  }
  for (const ByteBuffer& from : ranks.exchange(to)) {
    ByteReader reader(from.bytes());
    while (!reader.is_at_end()) {
      const auto run = reader.take<PixelRun>();
      for (const PlaneBytes& plane : planes) {
        const auto values = reader.take(run.count * plane.pixel);
        std::memcpy(plane.first + run.first * plane.pixel, values.data(), values.size());
      }
    }
  }
}

}  // namespace zoneplate
