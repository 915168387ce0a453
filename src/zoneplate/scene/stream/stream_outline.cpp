// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/stream/stream_outline.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/fit.h"
#include "zoneplate/scene/geometry/origin.h"
#include "zoneplate/scene/sanitize.h"

namespace zoneplate {
namespace {

constexpr float3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
constexpr std::size_t step = 512 * StreamOutline::block;  ///< triangles after which the system may reclaim them

/// The corner that lies farthest along a direction, and its number in the stream.
struct Farthest {
  float reach = -std::numeric_limits<float>::infinity();
  std::size_t corner = 0;
  float3 point{};

  void add(float along, std::size_t number, float3 p) {
    if (along > reach || (along == reach && number < corner)) reach = along, corner = number, point = p;
  }
};

/// A bound of the extent of a box along a direction, computed in floats.
double max_along(const Box& box, float3 d) {
  const auto most = [](double a, double low, double high) { return std::max(a * low, a * high); };
  const auto amount = [](double a, double low, double high) {
    return std::abs(a) * std::max(std::abs(low), std::abs(high));
  };
  const double sum =
      most(d.x, box.low.x, box.high.x) + most(d.y, box.low.y, box.high.y) + most(d.z, box.low.z, box.high.z);
  const double magnitude =
      amount(d.x, box.low.x, box.high.x) + amount(d.y, box.low.y, box.high.y) + amount(d.z, box.low.z, box.high.z);
  // Three products and two sums in floats, each with an error of 2^-24 of the sum of magnitudes.
  constexpr double rounding = 0x1p-20, least = 1e-36;
  return sum + rounding * magnitude + least;
}

/// Transforms corners of triangles, of which the first has the number `first`, to the world.
void place(std::span<const StreamInstance> instances, std::size_t first, std::span<float3> corners) {
  for_each_instance(instances, first, first + corners.size() / 3,
                    [&](std::size_t i, std::size_t begin, std::size_t end) {
                      const float4x4& m = instances[i].world_from_object;
                      if (m == float4x4{}) return;
                      for (float3& p : corners.subspan(3 * (begin - first), 3 * (end - begin)))
                        p = transform_point(m, p);
                    });
}

}  // namespace

StreamOutline::StreamOutline(TriangleStream& stream, const std::string& file,
                             const std::function<void(double)>& progress)
    : stream_(stream), instances_(stream.instances()), boxes_((stream.count() + block - 1) / block) {
  std::atomic<bool> is_finite_all = true;
  PerThread<std::vector<float3>> corners;
  for (std::size_t first = 0; first < stream.count(); first += step) {
    const std::size_t count = std::min(step, stream.count() - first);
    stream.read_ahead(first + count, std::min(step, stream.count() - first - count));
    parallel_ranges(count, block, [&](std::size_t begin, std::size_t end) {
      std::vector<float3>& own = corners.local();
      own.resize(3 * (end - begin));
      stream.read(first + begin, end - begin, own.data());
      stream.examine(first + begin, end - begin, own.data());
      place(instances_, first + begin, own);
      if (!are_finite({&own.front().x, 3 * own.size()})) is_finite_all = false;
      Box box;
      for (const float3 p : own) box.add(p);
      boxes_[(first + begin) / block] = box;
    });
    stream.forget();
    if (progress) progress(static_cast<double>(first + count) / static_cast<double>(stream.count()));
  }
  const auto refuse = [&](const char* what) {
    throw Error(ErrorKind::Input, file + ": " + what + ", and needs more memory than --max-memory allows");
  };
  if (!is_finite_all) refuse("has triangles with a corner that is missing or not finite");
  for (const Box& box : boxes_) bounds_.add(box);
  OriginChoice choice;
  choice.add(bounds_.low), choice.add(bounds_.high);
  // A tenth of the distance beyond which some readers drop an instance by its box.
  constexpr float farthest = 1e17f;
  const auto is_beyond = [](float3 p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > farthest; };
  if (!choice.is_near() || is_beyond(bounds_.low) || is_beyond(bounds_.high))
    refuse("lies far from the origin of its coordinates");
}

void StreamOutline::read(std::size_t first, std::size_t count, std::vector<float3>& corners) const {
  corners.resize(3 * count);
  stream_.read(first, count, corners.data());
  place(instances_, first, corners);
}

bool StreamOutline::has_front(const Camera& camera) const {
  std::atomic<bool> has_any = false;
  PerThread<std::vector<float3>> corners;
  for (std::size_t first = 0; first < stream_.count() && !has_any; first += step) {
    parallel_ranges(std::min(step, stream_.count() - first), block, [&](std::size_t begin, std::size_t end) {
      if (has_any) return;
      std::vector<float3>& own = corners.local();
      read(first + begin, end - begin, own);
      for_each_instance(instances_, first + begin, first + end, [&](std::size_t i, std::size_t from, std::size_t to) {
        const float4x4& m = instances_[i].world_from_object;
        for (std::size_t t = from; t < to; ++t) {
          const float3* const c = &own[3 * (t - first - begin)];
          if (faces(camera, m, {c[0], c[1], c[2]})) has_any = true;
        }
      });
    });
    stream_.forget();
  }
  return has_any;
}

std::vector<float3> StreamOutline::farthest(std::span<const float3> directions) const {
  std::vector<float3> all(std::begin(axes), std::end(axes));
  all.insert(all.end(), directions.begin(), directions.end());
  std::vector<Farthest> found(all.size());
  std::mutex mutex;
  const auto visit = [&](const std::vector<std::size_t>& blocks) {
    PerThread<std::vector<float3>> corners;
    const auto add = [&](std::size_t number) {
      const std::size_t first = number * block, count = std::min(block, stream_.count() - first);
      std::vector<float3>& own = corners.local();
      read(first, count, own);
      std::vector<Farthest> of_block(all.size());
      for (std::size_t d = 0; d < all.size(); ++d)
        for (std::size_t c = 0; c < own.size(); ++c) of_block[d].add(dot(all[d], own[c]), 3 * first + c, own[c]);
      const std::lock_guard lock(mutex);
      for (std::size_t d = 0; d < all.size(); ++d)
        found[d].add(of_block[d].reach, of_block[d].corner, of_block[d].point);
    };
    for (std::size_t first = 0; first < blocks.size(); first += step / block) {
      parallel_for(std::min(step / block, blocks.size() - first), [&](std::size_t i) { add(blocks[first + i]); });
      stream_.forget();
    }
  };

  // First the block whose box reaches farthest in each direction, then those whose boxes reach beyond its corners.
  std::vector<std::size_t> likely, possible;
  for (const float3 d : all) {
    const auto is_less = [&](const Box& p, const Box& q) { return max_along(p, d) < max_along(q, d); };
    likely.push_back(
        static_cast<std::size_t>(std::max_element(boxes_.begin(), boxes_.end(), is_less) - boxes_.begin()));
  }
  std::ranges::sort(likely);
  likely.erase(std::unique(likely.begin(), likely.end()), likely.end());
  visit(likely);
  for (std::size_t b = 0; b < boxes_.size(); ++b)
    for (std::size_t d = 0; d < all.size(); ++d)
      if (max_along(boxes_[b], all[d]) >= static_cast<double>(found[d].reach)) {
        possible.push_back(b);
        break;
      }
  visit(possible);

  std::ranges::sort(found, [](const Farthest& p, const Farthest& q) { return p.corner < q.corner; });
  std::vector<float3> points;
  for (const Farthest& f : found) points.push_back(f.point);
  return points;
}

}  // namespace zoneplate
