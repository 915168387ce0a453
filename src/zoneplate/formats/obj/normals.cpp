// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/normals.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/first_of_equal.h"
#include "zoneplate/scene/geometry/triangulate.h"
#include "zoneplate/scene/serial_ranges.h"

namespace zoneplate {
namespace {

constexpr float cos_50 = 0.64278761f;
constexpr std::size_t max_compared = 256;
constexpr std::uint32_t none = 0xffffffffu;

bool is_whole(const ObjFile& file, const ObjChunk& chunk, const ObjElement& e) {
  for (std::uint32_t i = 0; file.has_odd_position && i < e.count; ++i)
    if (!is_finite(file.positions[chunk.corners.position(e.first + i)])) return false;
  return true;
}

/// True if all corners have valid normals, without reading the corners; may also be false in that case.
bool has_all_normals(const ObjFile& file, const ObjChunk& chunk) {
  return chunk.corners.have_normals() && !file.has_odd_normal;
}

bool needs_normals(const ObjFile& file, const ObjChunk& chunk, const ObjElement& e) {
  if (e.kind != ObjKind::Face || has_all_normals(file, chunk)) return false;
  for (std::uint32_t i = 0; i < e.count; ++i)
    if (!has_normal(file, chunk.corners[e.first + i])) return is_whole(file, chunk, e);
  return false;
}

float3 unit(const std::array<double, 3>& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  if (!(length > 0) || !std::isfinite(length)) return {0, 1, 0};
  return {static_cast<float>(v[0] / length), static_cast<float>(v[1] / length), static_cast<float>(v[2] / length)};
}

/// The angle between two edges, in [0, π].
///
/// Edges     edges are first divided by their greatest component, so that lengths neither overflow nor underflow.
float angle_between(float3 a, float3 b) {
  const auto scaled = [](float3 v) {
    const float most = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return most > 0 && std::isfinite(most) ? float3{v.x / most, v.y / most, v.z / most} : float3{0, 0, 0};
  };
  const float3 p = scaled(a), q = scaled(b);
  return atan2(length(cross(p, q)), dot(p, q));
}

/// For each position, the index of the first position with the same coordinates.
std::vector<std::uint32_t> first_at_place(const std::vector<float3>& positions) {
  using Table = FirstOfEqual<3>;
  Table table(positions.size());
  std::vector<std::uint32_t> first(positions.size());
  const auto put = [&](std::uint32_t i) {
    const float3 p = positions[i] + float3{0, 0, 0};  // -0 becomes 0
    if (!is_finite(p)) return i;
    const Table::Key key{std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
                         std::bit_cast<std::uint32_t>(p.z)};
    return table.put(
        i, hash(key[0], key[1], key[2]), [&](std::uint32_t k) { return positions[k] == p; }, [&] { return key; });
  };
  serial_ranges(positions.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) first[i] = put(static_cast<std::uint32_t>(i));
  });
  return first;
}

/// The data for smoothing, grouped by place (the first of equal positions): the shares of the corners there, in the
/// order of the file.
struct Neighbours {
  std::vector<std::uint32_t> place;  ///< for each position
  std::vector<std::uint32_t> first;  ///< index of each place's first share; has one element more than positions
  std::vector<ObjNormalShare> shares;
  std::vector<std::vector<std::uint32_t>> slot;  ///< for each corner of each chunk: the index of its share, or `none`

  std::size_t place_of(const ObjCorner& corner) const { return place[static_cast<std::size_t>(corner.position)]; }
};

/// Calls `body(chunk, element, smoothing)` for each face that needs normals, in the order of the file.
template <class Body>
void for_each_face(const ObjFile& file, const std::vector<ObjRun>& runs, const Body& body) {
  std::size_t runs_done = 0;
  for (const ObjRun& run : runs) {
    constexpr std::size_t runs_per_check = 1024;
    if (runs_done++ % runs_per_check == 0) check_deadline();
    const ObjChunk& chunk = file.chunks[run.chunk];
    for (std::uint32_t e = run.begin; e < run.end; ++e)
      if (needs_normals(file, chunk, chunk.elements[e])) body(run.chunk, chunk.elements[e], run.smoothing);
  }
}

/// Assigns an index to every share, sorted by place and then in the order of the file (a counting sort).
Neighbours place_shares(const ObjFile& file, const std::vector<ObjRun>& runs, ImportBudget& budget) {
  Neighbours n;
  const bool are_needed = std::any_of(runs.begin(), runs.end(), [&](const ObjRun& run) {
    const ObjChunk& chunk = file.chunks[run.chunk];
    for (std::uint32_t e = run.begin; e < run.end && !has_all_normals(file, chunk); ++e)
      if (needs_normals(file, chunk, chunk.elements[e])) return true;
    return false;
  });
  if (!are_needed) return n;
  budget.take(file.positions.size() * 6 * sizeof(std::uint32_t));
  n.place = first_at_place(file.positions);
  std::vector<std::uint32_t> count(file.positions.size() + 1);
  std::uint64_t all = 0;
  for_each_face(file, runs, [&](std::uint32_t c, const ObjElement& e, std::uint32_t) {
    all += e.count;
    for (std::uint32_t i = 0; i < e.count; ++i) ++count[n.place_of(file.chunks[c].corners[e.first + i])];
  });
  budget.take(all * (sizeof(ObjNormalShare) + sizeof(std::uint32_t) + sizeof(float3)));
  std::uint32_t sum = 0;
  for (std::uint32_t& c : count) sum += std::exchange(c, sum);
  n.first = count;
  n.shares.resize(all);
  n.slot.resize(file.chunks.size());
  for_each_face(file, runs, [&](std::uint32_t c, const ObjElement& e, std::uint32_t) {
    const ObjChunk& chunk = file.chunks[c];
    if (n.slot[c].empty()) n.slot[c].assign(chunk.corners.size(), none);
    for (std::uint32_t i = 0; i < e.count; ++i)
      n.slot[c][e.first + i] = count[n.place_of(chunk.corners[e.first + i])]++;
  });
  return n;
}

void fill_shares(const ObjFile& file, const ObjRun& run, Neighbours& n) {
  const ObjChunk& chunk = file.chunks[run.chunk];
  std::vector<float3> polygon;
  std::vector<ObjNormalShare> shares;
  for (std::uint32_t e = run.begin; e < run.end; ++e) {
    const ObjElement& element = chunk.elements[e];
    if (!needs_normals(file, chunk, element)) continue;
    polygon.clear();
    for (std::uint32_t i = 0; i < element.count; ++i)
      polygon.push_back(file.positions[chunk.corners.position(element.first + i)]);
    shares.resize(element.count);
    make_shares(polygon, run.smoothing, shares);
    for (std::uint32_t i = 0; i < element.count; ++i) n.shares[n.slot[run.chunk][element.first + i]] = shares[i];
  }
}

std::span<const ObjNormalShare> shares_at(const Neighbours& n, std::size_t place) {
  return std::span(n.shares).subspan(n.first[place], n.first[place + 1] - n.first[place]);
}

/// The sums of places that are crowded.
using Crowds = std::map<std::size_t, ObjCrowd>;

Crowds sum_crowds(const Neighbours& n) {
  Crowds crowds;
  serial_ranges(n.first.size() - 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      if (n.first[p + 1] - n.first[p] > max_compared) crowds[p] = sum_crowd(shares_at(n, p));
  });
  return crowds;
}

float3 smoothed(const Neighbours& n, const Crowds& crowds, std::size_t place, std::uint32_t own) {
  static const ObjCrowd none_here;
  const std::span<const ObjNormalShare> shares = shares_at(n, place);
  return smooth_normal(shares, own - n.first[place], shares.size() > max_compared ? crowds.at(place) : none_here);
}

}  // namespace

void make_shares(std::span<const float3> polygon, std::uint32_t smoothing, std::span<ObjNormalShare> out) {
  const float3 normal = unit(area_vector(polygon));
  const std::size_t count = polygon.size();
  for (std::size_t i = 0; i < count; ++i) {
    const float3 p = polygon[i], after = polygon[(i + 1) % count], before = polygon[(i + count - 1) % count];
    out[i] = {normal, angle_between(after - p, before - p), smoothing};
  }
}

ObjCrowd sum_crowd(std::span<const ObjNormalShare> at_place) {
  ObjCrowd sums;
  if (at_place.size() > max_compared)
    for (const ObjNormalShare& share : at_place) sums[share.smoothing] += share.normal * share.angle;
  return sums;
}

float3 smooth_normal(std::span<const ObjNormalShare> at_place, std::size_t own, const ObjCrowd& crowd) {
  const ObjNormalShare& self = at_place[own];
  if (self.smoothing == 0) return self.normal;
  float3 sum;
  if (at_place.size() > max_compared) {
    sum = crowd.at(self.smoothing);
  } else {
    for (std::size_t i = 0; i < at_place.size(); ++i) {
      const ObjNormalShare& other = at_place[i];
      const bool is_smooth = other.smoothing == self.smoothing &&
                             (self.smoothing != smooth_by_angle || i == own || dot(other.normal, self.normal) > cos_50);
      if (is_smooth) sum += other.normal * other.angle;
    }
  }
  return normalize(sum, self.normal);
}

std::vector<std::vector<float3>> missing_normals(const ObjFile& file, const std::vector<ObjRun>& runs,
                                                 ImportBudget& budget) {
  std::vector<std::vector<float3>> normals(file.chunks.size());
  Neighbours n = place_shares(file, runs, budget);
  if (n.shares.empty()) return normals;
  parallel_for(runs.size(), [&](std::size_t r) { fill_shares(file, runs[r], n); });
  const Crowds crowds = sum_crowds(n);
  budget.check_time();
  parallel_for(file.chunks.size(), [&](std::size_t c) {
    const ObjChunk& chunk = file.chunks[c];
    if (n.slot[c].empty() || !budget.has_time()) return;
    normals[c].resize(chunk.corners.size());
    for (std::size_t i = 0; i < chunk.corners.size(); ++i)
      if (n.slot[c][i] != none && !has_normal(file, chunk.corners[i]))
        normals[c][i] = smoothed(n, crowds, n.place_of(chunk.corners[i]), n.slot[c][i]);
  });
  budget.check_time();
  return normals;
}

}  // namespace zoneplate
