// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/parts/rasterize_parts.h"

#include <algorithm>
#include <bit>
#include <memory>
#include <optional>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/parts/outbox.h"
#include "zoneplate/raster/parts/packed_samples.h"
#include "zoneplate/raster/parts/resolved_tiles.h"
#include "zoneplate/raster/tile/tile.h"

namespace zoneplate {
namespace {

/// Of a TileMessage.
enum Flag : std::uint32_t {
  tests_alpha = 1,  ///< the sender has alpha-tested triangles over the tile
  blends = 2,       ///< the sender has blended triangles over the tile
  is_alone = 4,     ///< the receiver draws the tile
  owns = 8,         ///< the receiver owns samples of the tile, whose set is sent
};

bool has_blended(const ResolvedTile& of) {
  return std::ranges::any_of(of.samples, [](const ResolvedTile::Part& part) { return (part.flags & blends) != 0; });
}

/// Memory for the tiles of a band that a rank resolves.
constexpr std::size_t band_bytes = std::size_t{128} << 20;

/// The memory of a thread, and what its work took.
struct PartBuffers : TileBuffers {
  using TileBuffers::TileBuffers;
  LayerList list;
  std::vector<Linear> colors_of_list;
  std::vector<SampleLayer> sample_layers;
  std::vector<std::int32_t> ids;
  double pack_ms = 0;
};

/// A layer of a pixel from any rank.
struct SentLayer {
  std::uint32_t pixel;
  std::int32_t id;
  std::uint64_t samples;
};
struct PlacedLayer : SentLayer {
  std::span<const std::byte> depths, colors;  ///< a depth for each of the samples; one colour, or one for each
};

template <class T>
T value_at(std::span<const std::byte> bytes, std::size_t i) {
  T value;
  std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
  return value;
}

void mark(const TileJob& job, Plane<std::uint8_t>& held) {
  for (int y = job.drawn.top; y < job.drawn.bottom; ++y)
    for (int x = job.drawn.left; x < job.drawn.right; ++x)
      held(job.x + x - job.setup.target.x, job.y + y - job.setup.target.y) = 1;
}

class PartsOfFrame {
 public:
  PartsOfFrame(const TileSetup& setup, Ranks& ranks, HeldPixels& held, PartTimes& times)
      : setup_(setup), target_(setup.target), ranks_(ranks), held_(held), times_(times) {
    tests_alpha_ =
        std::ranges::any_of(setup.projected.draws, [](const Draw& draw) { return draw.alpha_mode == AlphaMode::Mask; });
    held_.colors = held_.data = {target_.width, target_.height, std::uint8_t{0}};
  }

  void draw() {
    const std::size_t tiles = setup_.bins.tiles(), count = static_cast<std::size_t>(ranks_.count());
    const auto samples = static_cast<std::size_t>(setup_.max_pass_samples());
    const std::size_t of_tile =
        samples * sample_stride * (sizeof(float) + sizeof(std::int32_t) + sizeof(std::uint16_t)) +
        tile_pixels * (sizeof(Linear) + sizeof(float));
    const std::size_t band = std::max<std::size_t>(band_bytes / of_tile, 1) * count;
    for (first_ = 0; first_ < tiles; first_ += band) {
      last_ = std::min(tiles, first_ + band);
      draw_band();
      if (setup_.rules.progress) (*setup_.rules.progress)(static_cast<double>(last_) / static_cast<double>(tiles));
    }
  }

  void count(RasterCounts& counts) const {
    buffers_.for_each([&](const PartBuffers& used) {
      counts.shaded += used.batcher.shaded();
      counts.evaluated += used.batcher.evaluated();
      counts.stages += used.times;
    });
  }

 private:
  int resolver_of(std::size_t tile) const { return static_cast<int>(tile % static_cast<std::size_t>(ranks_.count())); }
  bool needs_shading() const { return setup_.stores_color() || target_.stores_data(); }

  template <class Body>
  void for_each(std::size_t count, Body body) {
    parallel_for(count, [&](std::size_t i) { growing("tile buffers", [&] { body(i, buffers_.local(setup_)); }); });
  }
  /// Calls body(tile, resolved, buffers) for the tiles of the band that this rank resolves.
  template <class Body>
  void for_resolved(Body body) {
    for_each(resolved_.size(), [&](std::size_t i, PartBuffers& b) {
      body(static_cast<std::uint32_t>(resolved_.number(i)), resolved_[i], b);
    });
  }
  ResolvedTile& resolved(std::size_t tile) { return resolved_.of(tile); }
  void begin(std::size_t tile, PartBuffers& b) const {
    begin_tile(tile, b.job);
    begin_pass(pass_first_, pass_count_, b.job);
    b.visibility.sample_count = pass_count_;
  }

  void draw_band();
  void draw_pass();
  void collect_samples(Outbox& found);
  void merge_found();
  void test_alpha(Outbox& passing);
  void tell_owners(Outbox& known);
  void shade(const Outbox& found, const Outbox& passing, std::span<const TileMessage> known, Outbox& colors);
  void shade_tile(const TileMessage& known, std::span<const std::byte> found, std::span<const std::byte> passing,
                  PartBuffers& b, Outbox& colors);
  void compute_data(std::span<const std::byte> others, PartBuffers& b, TileData& data);
  void pack_layers(PartBuffers& b, ByteBuffer& out);
  void draw_alone(std::uint32_t tile, PartBuffers& b);
  void take_colors(ResolvedTile& of, PartBuffers& b, std::vector<PlacedLayer>& layers) const;
  void composite(ResolvedTile& of, PartBuffers& b) const;
  void add_samples(ResolvedTile& of, std::uint32_t pixel, std::span<const PlacedLayer> layers, PartBuffers& b) const;
  void write_data_of_band();

  const TileSetup& setup_;
  const Target& target_;
  Ranks& ranks_;
  HeldPixels& held_;
  PartTimes& times_;
  bool tests_alpha_ = false;  ///< on any rank
  PerThread<PartBuffers> buffers_;

  // Of the band, and of the pass.
  std::size_t first_ = 0, last_ = 0;
  ResolvedTiles resolved_;
  std::vector<std::uint8_t> is_drawn_alone_;     ///< by tile of the band: by this rank
  std::vector<std::unique_ptr<TileData>> data_;  ///< by tile of the band
  int pass_first_ = 0, pass_count_ = 0;
};

void PartsOfFrame::draw_band() {
  std::vector<std::size_t> resolved;
  for (std::size_t tile = first_; tile < last_; ++tile)
    if (resolver_of(tile) == ranks_.rank()) resolved.push_back(tile);
  growing("tile buffers", [&] { resolved_.begin(std::move(resolved), setup_.max_pass_samples()); });
  for_resolved([](std::uint32_t, ResolvedTile& of, PartBuffers&) { of.begin(); });
  is_drawn_alone_.assign(last_ - first_, 0);
  data_.clear(), data_.resize(last_ - first_);
  const int samples = setup_.samples(), step = setup_.max_pass_samples();
  for (pass_first_ = 0; pass_first_ < samples; pass_first_ += step) {
    pass_count_ = std::min(step, samples - pass_first_);
    draw_pass();
  }
  for_resolved([&](std::uint32_t tile, ResolvedTile& of, PartBuffers& b) {
    if (of.is_alone) return;
    begin_tile(tile, b.job);
    mark(b.job, held_.colors);
    if (setup_.stores_color()) {
      of.sums.color.resize(tile_pixels / 8);
      for (std::size_t i = 0; i < of.sums.sum.size(); ++i)
        setup_.resolve.divide(of.sums.sum[i], setup_.weight_sum, of.sums.color[i]);
      write_colors(b.job, of.sums);
    }
    if (target_.coverage) write_coverage(b.job, of.sums.coverage);
  });
  write_data_of_band();
}

void PartsOfFrame::draw_pass() {
  Stopwatch watch;
  for_resolved(
      [](std::uint32_t, ResolvedTile& of, PartBuffers&) { of.samples.clear(), of.tested.clear(), of.colors.clear(); });
  const std::size_t tiles_of_rank = 1 + (last_ - first_) / static_cast<std::size_t>(ranks_.count());
  Outbox found(ranks_, tiles_of_rank * max_packed_bytes(pass_count_)), passing(ranks_), known(ranks_), colors(ranks_);
  collect_samples(found);
  double pack_ms = 0;
  buffers_.for_each([&](PartBuffers& b) { pack_ms += std::exchange(b.pack_ms, 0); });
  pack_ms /= thread_limit();
  static_cast<void>(all_values(ranks_, 0));  // waiting for others is no merging
  times_.visibility += watch.lap_ms() - pack_ms;
  found.exchange([&](int rank, const TileMessage& m) { resolved(m.tile).samples.push_back({rank, m.flags, m.bytes}); });
  merge_found();
  times_.merge += watch.lap_ms() + pack_ms;
  if (tests_alpha_) test_alpha(passing);
  times_.visibility += watch.lap_ms();
  std::vector<TileMessage> to_shade;
  if (needs_shading()) {
    tell_owners(known);
    known.exchange([&](int, const TileMessage& m) { to_shade.push_back(m); });
    times_.merge += watch.lap_ms();
    shade(found, passing, to_shade, colors);
    times_.shading += watch.lap_ms();
    colors.exchange([&](int rank, const TileMessage& m) { resolved(m.tile).colors.push_back({rank, 0, m.bytes}); });
  }
  for_resolved([&](std::uint32_t tile, ResolvedTile& of, PartBuffers& b) {
    if (of.is_alone) return;
    begin(tile, b);
    composite(of, b);
  });
  times_.resolve += watch.lap_ms();
}

/// Step 1.
void PartsOfFrame::collect_samples(Outbox& found) {
  for_each(last_ - first_, [&](std::size_t i, PartBuffers& b) {
    const std::size_t tile = first_ + i;
    if (is_drawn_alone_[i] || setup_.bins.is_empty(tile)) return;
    begin(tile, b);
    b.watch.lap_ms();
    const bool is_resolver = resolver_of(tile) == ranks_.rank();
    TileVisibility& visibility = is_resolver ? resolved(tile).visibility : b.visibility;
    rasterize_opaque(b.job, visibility);
    b.times.visibility += b.watch.lap_ms();
    const std::uint32_t flags =
        (b.job.triangles_of(AlphaMode::Mask).empty() ? 0u : tests_alpha) | (b.job.has_transparency() ? blends : 0u);
    if (is_resolver) {
      resolved(tile).samples.push_back({ranks_.rank(), flags, {}});
      return;
    }
    found.send(resolver_of(tile), static_cast<std::uint32_t>(tile), flags,
               [&](ByteBuffer& out) { pack_samples(b.visibility, nullptr, out); });
    b.pack_ms += b.watch.lap_ms();
  });
}

/// Step 2, of opaque triangles.
void PartsOfFrame::merge_found() {
  for_resolved([&](std::uint32_t, ResolvedTile& of, PartBuffers&) {
    if (of.is_alone) return;
    of.visibility.sample_count = pass_count_;
    // This rank's own samples, the first part, are there already.
    const bool has_own = !of.samples.empty() && of.samples.front().rank == ranks_.rank();
    if (!has_own) of.visibility.clear();
    // A tile of one rank is drawn by it, and nothing of it is merged.
    if (of.samples.size() == 1 && pass_first_ == 0 && needs_shading()) {
      of.is_alone = true;
      return;
    }
    if (has_own) std::fill_n(of.parts, static_cast<std::size_t>(pass_count_) * sample_stride, std::uint16_t{0});
    for (const ResolvedTile::Part& part : of.samples) of.merge(part);
  });
}

/// Step 2, of alpha-tested triangles: sends the samples that `passing` take from opaque triangles.
void PartsOfFrame::test_alpha(Outbox& passing) {
  Outbox opaque(ranks_);
  for_resolved([&](std::uint32_t tile, ResolvedTile& of, PartBuffers&) {
    if (of.is_alone) return;
    for (const ResolvedTile::Part& part : of.samples)
      if (part.flags & tests_alpha)
        opaque.send(part.rank, tile, 0, [&](ByteBuffer& out) { pack_samples(of.visibility, nullptr, out); });
  });
  std::vector<TileMessage> to_test;
  opaque.exchange([&](int, const TileMessage& m) { to_test.push_back(m); });
  for_each(to_test.size(), [&](std::size_t i, PartBuffers& b) {
    const TileMessage& m = to_test[i];
    begin(m.tile, b);
    b.visibility.clear();
    merge_samples(m.bytes, nullptr, 0, b.visibility, nullptr);
    b.visibility.materialize_all();
    b.ids.assign(b.visibility.id, b.visibility.id + static_cast<std::size_t>(pass_count_) * sample_stride);
    b.alpha_tester.rasterize(b.job, b.batcher, b.visibility);
    const SampleSet taken = changed_samples(b.visibility, b.ids);
    if (taken.is_empty()) return;
    passing.send(resolver_of(m.tile), m.tile, 0, [&](ByteBuffer& out) { pack_samples(b.visibility, &taken, out); });
  });
  passing.exchange([&](int rank, const TileMessage& m) { resolved(m.tile).tested.push_back({rank, 0, m.bytes}); });
  for_resolved([&](std::uint32_t, ResolvedTile& of, PartBuffers&) {
    for (const ResolvedTile::Part& part : of.tested) of.merge(part);
  });
}

/// Step 3.
void PartsOfFrame::tell_owners(Outbox& known) {
  for_resolved([&](std::uint32_t tile, ResolvedTile& of, PartBuffers&) {
    if (of.samples.empty()) return;
    if (of.is_alone) return known.send(of.samples.front().rank, tile, is_alone);
    const std::vector<SampleSet> sets = samples_by_part(
        of.visibility, {of.parts, static_cast<std::size_t>(pass_count_) * sample_stride}, of.samples.size());
    for (std::size_t i = 0; i < sets.size(); ++i) {
      const ResolvedTile::Part& part = of.samples[i];
      const SampleSet& own = sets[i];
      const bool reads_others = (part.flags & blends) || target_.stores_data();
      const bool is_owner = !own.is_empty();
      if (!is_owner && !reads_others) continue;
      known.send(part.rank, tile, is_owner ? owns : 0u, [&](ByteBuffer& out) {
        if (is_owner) out.append(std::as_bytes(own.bits()));
        if (!reads_others) return;
        SampleSet others = own;
        for (std::uint64_t& bits : others.bits()) bits = ~bits;
        pack_samples(of.visibility, &others, out);
      });
    }
  });
}

/// Step 4.
void PartsOfFrame::shade(const Outbox& found, const Outbox& passing, std::span<const TileMessage> known,
                         Outbox& colors) {
  std::vector<std::span<const std::byte>> own(last_ - first_), tested(last_ - first_);
  found.for_sent([&](const TileMessage& m) { own[m.tile - first_] = m.bytes; });
  passing.for_sent([&](const TileMessage& m) { tested[m.tile - first_] = m.bytes; });
  for_each(known.size(), [&](std::size_t i, PartBuffers& b) {
    const TileMessage& m = known[i];
    if (m.flags & is_alone) return draw_alone(m.tile, b);
    shade_tile(m, own[m.tile - first_], tested[m.tile - first_], b, colors);
  });
}

void PartsOfFrame::draw_alone(std::uint32_t tile, PartBuffers& b) {
  is_drawn_alone_[tile - first_] = 1;
  render_tile(tile, b);
  mark(b.job, held_.colors), mark(b.job, held_.data);
}

void PartsOfFrame::shade_tile(const TileMessage& known, std::span<const std::byte> found,
                              std::span<const std::byte> passing, PartBuffers& b, Outbox& colors) {
  begin(known.tile, b);
  ByteReader reader(known.bytes);
  SampleSet own(pass_count_);
  if (known.flags & owns) {
    const auto bits = reader.take(own.bits().size_bytes());
    std::memcpy(own.bits().data(), bits.data(), bits.size());
  }
  const std::span<const std::byte> others = reader.rest();
  b.visibility.clear();
  if (resolver_of(known.tile) == ranks_.rank()) {
    ByteBuffer packed;
    pack_samples(resolved(known.tile).visibility, &own, packed);
    merge_samples(packed.bytes(), nullptr, 0, b.visibility, nullptr);
  } else {
    merge_samples(found, &own, 0, b.visibility, nullptr);
    merge_samples(passing, &own, 0, b.visibility, nullptr);
  }
  b.visibility.materialize_all();
  list_fragments(b.job, b.visibility, b.opaque);
  const bool is_shaded = setup_.stores_color();
  b.opaque.colors.clear();
  if (is_shaded)
    b.batcher.shade(b.opaque.fragments, b.opaque.colors, setup_.stores_shaded_data() ? &b.data.shaded : nullptr);
  if (target_.stores_data()) {
    std::unique_ptr<TileData>& data = data_[known.tile - first_];
    if (!data) {
      data = std::make_unique<TileData>();
      data->nearest.assign(tile_pixels, NearestSurface{});
    }
    std::swap(data->shaded, b.data.shaded);
    compute_data(others, b, *data);
    std::swap(data->shaded, b.data.shaded);
  }
  if (!is_shaded) return;
  merge_samples(others, nullptr, 0, b.visibility, nullptr);
  colors.send(resolver_of(known.tile), known.tile, 0, [&](ByteBuffer& out) {
    out.put(std::uint64_t{b.opaque.colors.size()});
    out.append(std::as_bytes(std::span(b.opaque.colors)));
    if (b.job.has_transparency()) pack_layers(b, out);
  });
}

/// The nearest surfaces of the pixels, of this rank and of others.
void PartsOfFrame::compute_data(std::span<const std::byte> others, PartBuffers& b, TileData& data) {
  for_packed_samples(others, [&](int, std::uint32_t pixel, float depth, std::int32_t id) {
    NearestSurface& nearest = data.nearest[pixel];
    if (depth < nearest.depth || (depth == nearest.depth && id >= nearest.id)) return;
    nearest.depth = depth, nearest.id = id;
  });
  collect_nearest_surfaces(b.job, b.visibility, b.opaque, setup_.stores_color(), data);
}

/// Writes the data of the pixels whose nearest surface is this rank's.
void PartsOfFrame::write_data_of_band() {
  for_each(data_.size(), [&](std::size_t i, PartBuffers& b) {
    if (!data_[i]) return;
    begin_tile(first_ + i, b.job);
    begin_pass(0, setup_.max_pass_samples(), b.job);
    TileData& data = *data_[i];
    const ProjectedDraws& projected = setup_.projected;
    for (std::uint32_t pixel = 0; pixel < tile_pixels; ++pixel) {
      std::int32_t& id = data.nearest[pixel].id;
      if (id == no_primitive) continue;
      if (projected.draws[projected.draw_of(id)].elsewhere > 0)
        id = no_primitive;
      else
        held_.data(b.job.target_x(pixel), b.job.target_y(pixel)) = 1;
    }
    write_data(b.job, b.batcher, setup_.stores_color(), data);
    data_[i].reset();
  });
}

/// The layers of this rank's blended triangles, with their colours.
void PartsOfFrame::pack_layers(PartBuffers& b, ByteBuffer& out) {
  const std::size_t triangles = b.job.triangles_of(AlphaMode::Blend).size();
  const bool is_per_sample = target_.is_per_sample;
  for (std::size_t next = 0; next < triangles;) {
    next = collect_layers(b.job, AlphaMode::Blend, next, b.job.drawn, nullptr, b.visibility, b.list);
    collect_layer_fragments(b.job, is_per_sample, b.list);
    b.batcher.shade(b.list.fragments, b.colors_of_list, nullptr);
    for (std::size_t i = 0; i < b.list.layers.size(); ++i) {
      const Layer& layer = b.list.layers[i];
      const auto count = static_cast<std::size_t>(std::popcount(layer.samples));
      out.put(SentLayer{layer.pixel, layer.id, layer.samples});
      out.append(std::as_bytes(std::span(b.list.depths).subspan(layer.first_depth, count)));
      if (!is_per_sample) {
        out.put(b.colors_of_list[b.list.fragment_of_layer[i]]);
        continue;
      }
      for (std::uint64_t left = layer.samples; left; left &= left - 1)
        out.put(b.colors_of_list[b.list.fragment_at(i, std::countr_zero(left), true)]);
    }
  }
}

/// The colours of the tile's fragments, and its layers by pixel.
void PartsOfFrame::take_colors(ResolvedTile& of, PartBuffers& b, std::vector<PlacedLayer>& layers) const {
  std::vector<ByteReader> by_part(of.samples.size(), ByteReader({}));
  for (const ResolvedTile::Part& part : of.colors) {
    ByteReader reader(part.bytes);
    const auto count = static_cast<std::size_t>(reader.take<std::uint64_t>());
    by_part[of.index_of(part.rank)] = ByteReader(reader.take(count * sizeof(Linear)));
    while (!reader.is_at_end()) {
      const auto layer = reader.take<SentLayer>();
      const auto samples = static_cast<std::size_t>(std::popcount(layer.samples));
      const auto depths = reader.take(samples * sizeof(float));
      layers.push_back({layer, depths, reader.take((target_.is_per_sample ? samples : 1) * sizeof(Linear))});
    }
  }
  std::ranges::sort(layers, [](const PlacedLayer& p, const PlacedLayer& q) {
    if (p.pixel != q.pixel) return p.pixel < q.pixel;
    return p.id != q.id ? p.id < q.id : p.samples < q.samples;
  });
  b.opaque.colors.resize(b.opaque.fragments.size());
  for (std::size_t f = 0; f < b.opaque.fragments.size(); ++f) {
    const Fragment& fragment = b.opaque.fragments[f];
    const auto first = static_cast<std::size_t>(std::countr_zero(fragment.samples));
    b.opaque.colors[f] = by_part[of.parts[first * sample_stride + fragment.pixel]].take<Linear>();
  }
}

/// Step 5.
void PartsOfFrame::composite(ResolvedTile& of, PartBuffers& b) const {
  of.visibility.materialize_all();
  if (target_.stores_visibility_alone()) return write_visibility(b.job, of.visibility);
  list_fragments(b.job, of.visibility, b.opaque);
  std::vector<PlacedLayer> layers;
  const bool is_shaded = setup_.stores_color();
  if (is_shaded) take_colors(of, b, layers);
  // As render_tile chooses.
  const bool is_simple =
      setup_.stores_color_alone() && !((target_.is_per_sample || target_.sample_color) && has_blended(of));
  const bool stores_samples = target_.stores_samples() && !is_simple;
  for (std::size_t pixel = 0, first = 0, last = 0; pixel < tile_pixels; ++pixel, first = last) {
    const auto p = static_cast<std::uint32_t>(pixel);
    while (last < layers.size() && layers[last].pixel == p) ++last;
    if (!b.job.draws(static_cast<int>(pixel % tile_size), static_cast<int>(pixel / tile_size))) continue;
    if (!is_shaded || first < last || stores_samples) {
      add_samples(of, p, std::span(layers).subspan(first, last - first), b);
      continue;
    }
    add_fragments_to_sum(b.job, b.opaque, p, of.sums);
    if (target_.sample_color)
      for (std::uint32_t f = b.opaque.first_fragment[p]; f < b.opaque.first_fragment[p + 1]; ++f)
        store_color(b.job, p, b.opaque.fragments[f].samples, b.opaque.colors[f]);
  }
}

/// Adds the samples of a pixel one by one, with its layers.
void PartsOfFrame::add_samples(ResolvedTile& of, std::uint32_t pixel, std::span<const PlacedLayer> layers,
                               PartBuffers& b) const {
  Linear behind[TileTriangle::max_samples];
  std::fill_n(behind, pass_count_, Linear{0, 0, 0, 0});
  for (std::uint32_t f = b.opaque.first_fragment[pixel]; f < b.opaque.first_fragment[pixel + 1]; ++f)
    for (std::uint64_t left = b.opaque.fragments[f].samples; left; left &= left - 1) {
      if (setup_.stores_color()) behind[std::countr_zero(left)] = b.opaque.colors[f];
      of.sums.coverage[pixel] += 1;
    }
  const auto is_same_id = [](const PlacedLayer& p, const PlacedLayer& q) { return p.id == q.id; };
  const bool has_pieces = std::adjacent_find(layers.begin(), layers.end(), is_same_id) != layers.end();
  for (int s = 0; s < pass_count_; ++s) {
    b.sample_layers.clear();
    for (const PlacedLayer& layer : layers) {
      if (!(layer.samples >> s & 1)) continue;
      const auto rank = static_cast<std::size_t>(std::popcount(layer.samples & ((std::uint64_t{1} << s) - 1)));
      b.sample_layers.push_back({value_at<float>(layer.depths, rank), layer.id,
                                 value_at<Linear>(layer.colors, target_.is_per_sample ? rank : 0)});
    }
    composite_sample(b.sample_layers, has_pieces, setup_.min_transmittance, behind[s]);
    const float weight = setup_.weights[static_cast<std::size_t>(pass_first_ + s)];
    Linear8& sum = of.sums.sum[pixel / 8];
    sum.set(pixel % 8, sum.get(pixel % 8) + behind[s] * weight);
    if (target_.stores_samples()) store_sample(b.job, of.visibility, pixel, s, behind[s]);
  }
}

/// The greatest of the ranks' bounds.
float brightest_of_all(const FragmentShader& shader, Ranks& ranks) {
  const std::vector<float> bounds = all_values(ranks, shader.brightest());
  return *std::max_element(bounds.begin(), bounds.end());
}

}  // namespace

RasterCounts rasterize_parts(std::span<const Draw> draws, const FragmentShader& shader, const RasterRules& rules,
                             const Target& target, RasterMemory& memory, Ranks& ranks, HeldPixels& held,
                             PartTimes& times) {
  RasterCounts counts;
  const float brightest = brightest_of_all(shader, ranks);
  bin_draws(draws, rules, target, memory, counts);
  const Stopwatch tiles;
  const TileSetup setup(memory.projected, memory.bins, shader, rules, target, brightest);
  PartsOfFrame parts(setup, ranks, held, times);
  parts.draw();
  parts.count(counts);
  times.visibility += counts.geometry_ms;
  counts.tiles_ms = tiles.ms();
  return counts;
}

}  // namespace zoneplate
