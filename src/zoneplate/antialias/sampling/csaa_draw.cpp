// SPDX-License-Identifier: Apache-2.0
// Multisampling first; then the triangles are processed again in order, to determine the samples that the slots would
// have kept.
#include "zoneplate/antialias/sampling/csaa_draw.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/coverage/coverage.h"
#include "zoneplate/raster/geometry/bin.h"
#include "zoneplate/raster/tile/visibility.h"

namespace zoneplate::antialias {
namespace {

/// The results of the tiles at all samples.
struct Sampled {
  std::vector<LinearImage> color;
  std::vector<Plane<std::uint32_t>> triangle;
};

/// The slots of one tile's pixels during drawing.
class TileHistory {
 public:
  TileHistory(const Bins& bins, const Target& target, const Sampled& sampled, std::size_t slots)
      : bins_(bins),
        target_(target),
        sampled_(sampled),
        slots_(slots),
        coverage_(CoverageKernels::of()),
        count_(static_cast<int>(target.samples.size())),
        all_((1u << target.samples.size()) - 1),
        visibility_(count_),
        fragments_(tile_pixels) {
    visibility_.sample_count = count_;
  }

  void find(std::size_t tile, Plane<std::uint16_t>& known) {
    x_ = (bins_.first_column + static_cast<int>(tile) % bins_.columns) * tile_size;
    y_ = (bins_.first_row + static_cast<int>(tile) / bins_.columns) * tile_size;
    visibility_.clear();
    visibility_.materialize_all();
    pixels_.assign(tile_pixels, CoverageSlots(all_));
    gather(tile);
    draw();
    for (int y = std::max(y_, target_.y); y < std::min(y_ + tile_size, target_.y + target_.height); ++y)
      for (int x = std::max(x_, target_.x); x < std::min(x_ + tile_size, target_.x + target_.width); ++x)
        known(x - target_.x, y - target_.y) =
            static_cast<std::uint16_t>(pixels_[static_cast<std::size_t>((y - y_) * tile_size + x - x_)].known());
  }

 private:
  void gather(std::size_t tile) {
    drawn_.clear();
    for (const Bins::Worker& worker : bins_.workers) {
      for (const AlphaMode alpha_mode : {AlphaMode::Opaque, AlphaMode::Mask})
        for (const std::uint32_t t : worker.tiles[tile][static_cast<std::size_t>(alpha_mode)])
          drawn_.push_back({worker.triangles[t].id, &worker.triangles[t], alpha_mode == AlphaMode::Mask, 0, 0});
      for (const SampleBin* part = worker.fragments[tile]; part; part = part->previous)
        for (std::int32_t i = 0; i < part->count; ++i)
          drawn_.push_back({part->id(part->packed[i]), nullptr, false, SampleBin::at(part->packed[i]), part->depth[i]});
    }
    std::sort(drawn_.begin(), drawn_.end(), comes_before);
  }

  void draw() {
    for (std::size_t i = 0; i < drawn_.size();) {
      if (drawn_[i].triangle) {
        draw_triangle(*drawn_[i].triangle, drawn_[i].is_masked);
        ++i;
        continue;
      }
      const std::int32_t id = drawn_[i].id;
      const std::uint32_t pixel = drawn_[i].at % tile_pixels;
      std::uint32_t samples = 0;
      for (; i < drawn_.size() && drawn_[i].id == id && drawn_[i].at % tile_pixels == pixel; ++i)
        if (wins(drawn_[i].at, drawn_[i].depth, id)) samples |= 1u << drawn_[i].at / tile_pixels;
      if (samples) pixels_[pixel].draw(id, samples, slots_);
    }
  }

  void draw_triangle(const Triangle& triangle, bool is_masked) {
    make_tile_triangle(triangle, target_.samples.data(), count_, x_, y_, tile_triangle_);
    const int n = coverage_.collect(tile_triangle_, visibility_, fragments_.data());
    for (int i = 0; i < n; ++i) {
      const CoveredPixel& f = fragments_[static_cast<std::size_t>(i)];
      const int x = static_cast<int>(f.pixel % tile_size), y = static_cast<int>(f.pixel / tile_size);
      auto samples = static_cast<std::uint32_t>(f.samples);
      if (is_masked) samples &= kept_samples(x, y, triangle.id);
      for (std::uint32_t left = samples; left; left &= left - 1) {
        const int s = std::countr_zero(left);
        wins(static_cast<std::uint32_t>(s) * tile_pixels + f.pixel, depth_at(tile_triangle_, s, x, y), triangle.id);
      }
      if (samples) pixels_[f.pixel].draw(triangle.id, samples, slots_);
    }
  }

  bool wins(std::uint32_t at, float depth, std::int32_t id) {
    float& nearest = visibility_.depth[sample_place(at)];
    std::int32_t& owner = visibility_.id[sample_place(at)];
    if (depth < nearest || (depth == nearest && id >= owner)) return false;
    nearest = depth, owner = id;
    return true;
  }

  /// The samples of the tile's pixel that the triangle owns in the image.
  std::uint32_t kept_samples(int x, int y, std::int32_t id) const {
    const int px = x_ + x - target_.x, py = y_ + y - target_.y;
    if (px < 0 || py < 0 || px >= target_.width || py >= target_.height) return 0;
    std::uint32_t samples = 0;
    for (std::size_t s = 0; s < sampled_.triangle.size(); ++s)
      if (sampled_.triangle[s](px, py) == static_cast<std::uint32_t>(id)) samples |= 1u << s;
    return samples;
  }

  const Bins& bins_;
  const Target& target_;
  const Sampled& sampled_;
  const std::size_t slots_;
  const CoverageKernels& coverage_;
  const int count_;
  const std::uint32_t all_;
  VisibilityBuffer visibility_;
  std::vector<CoveredPixel> fragments_;
  TileTriangle tile_triangle_;
  int x_ = 0, y_ = 0;  ///< the tile's first pixel
  std::vector<Drawn> drawn_;
  std::vector<CoverageSlots> pixels_;
};

/// The known samples of every pixel, one bit each.
Plane<std::uint16_t> known_samples(const Bins& bins, const Target& target, const Sampled& sampled, std::size_t slots) {
  Plane<std::uint16_t> known(target.width, target.height,
                             static_cast<std::uint16_t>((1u << target.samples.size()) - 1));
  PerThread<TileHistory> histories;
  parallel_for(bins.tiles(),
               [&](std::size_t tile) { histories.local(bins, target, sampled, slots).find(tile, known); });
  return known;
}

void resolve_row(const Sampled& sampled, std::span<const std::uint16_t> known, int y, const Target& target) {
  for (int x = 0; x < target.width; ++x) {
    Linear sum{0, 0, 0, 0};
    const unsigned samples = known[static_cast<std::size_t>(x)];
    for (unsigned left = samples; left; left &= left - 1)
      sum = sum + sampled.color[static_cast<std::size_t>(std::countr_zero(left))](x, y);
    const auto n = static_cast<float>(std::popcount(samples));
    (*target.color)(x, y) = {sum.r / n, sum.g / n, sum.b / n, sum.a / n};
    if (!target.coverage) continue;
    int covered = 0;
    for (const Plane<std::uint32_t>& triangle : sampled.triangle) covered += triangle(x, y) != Target::no_id;
    (*target.coverage)(x, y) = static_cast<float>(covered) / static_cast<float>(sampled.triangle.size());
  }
}

}  // namespace

bool comes_before(const Drawn& p, const Drawn& q) {
  if (p.id != q.id) return p.id < q.id;
  if (!p.triangle || !q.triangle) {
    const auto key = [](const Drawn& d) {
      return d.triangle ? std::tuple(false, 0u, 0u, 0.0f) : std::tuple(true, d.at % tile_pixels, d.at, d.depth);
    };
    return key(p) < key(q);
  }
  const auto shape = [](const Triangle& t) {
    return std::tie(t.min_y, t.min_x, t.max_y, t.max_x, t.a[0], t.b[0], t.a[1], t.b[1], t.c[0], t.c[1], t.c[2]);
  };
  return shape(*p.triangle) < shape(*q.triangle);
}

void CoverageSlots::draw(std::int32_t surface, std::uint32_t samples, std::size_t slots) {
  std::size_t kept = 0;
  bool is_new = true;
  for (std::size_t i = 0; i < count_; ++i) {
    Slot slot = slots_[i];
    slot.samples &= ~samples;
    if (slot.surface == surface) slot.samples |= samples, is_new = false;
    if (slot.samples) slots_[kept++] = slot;
  }
  if (is_new) slots_[kept++] = {surface, samples};
  if (kept > slots) {
    const auto end = slots_.begin() + static_cast<std::ptrdiff_t>(kept);
    const auto fewer = [](const Slot& p, const Slot& q) { return std::popcount(p.samples) < std::popcount(q.samples); };
    // The last of the slots with the fewest samples.
    auto least = slots_.begin();
    for (auto i = least + 1; i != end; ++i)
      if (!fewer(*least, *i)) least = i;
    std::copy(least + 1, end, least);
    --kept;
  }
  count_ = kept;
}

std::uint32_t CoverageSlots::known() const {
  std::uint32_t samples = 0;
  for (std::size_t i = 0; i < count_; ++i) samples |= slots_[i].samples;
  return samples;
}

void draw_with_slots(const CustomDraw& drawing, const SamplePattern& samples, std::size_t slots) {
  Target target = drawing.target;
  Sampled sampled;
  sampled.color.assign(samples.size(), LinearImage(target.width, target.height, Linear{0, 0, 0, 0}));
  sampled.triangle.assign(samples.size(), Plane<std::uint32_t>(target.width, target.height, Target::no_id));
  Target every;
  every.viewport = target.viewport;
  every.x = target.x, every.y = target.y, every.width = target.width, every.height = target.height;
  every.samples = samples;
  every.keeps_hidden = true;
  every.sample_color = &sampled.color;
  every.sample_triangle = &sampled.triangle;
  drawing.counts = rasterize(drawing.draws, drawing.shader, drawing.rules, every, &drawing.memory);
  const Plane<std::uint16_t> known = known_samples(drawing.memory.bins, every, sampled, slots);
  parallel_ranges(static_cast<std::size_t>(target.height), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t y = first; y < last; ++y) {
      const int row = static_cast<int>(y);
      resolve_row(sampled, known.row(row), row, target);
    }
  });
}

}  // namespace zoneplate::antialias
