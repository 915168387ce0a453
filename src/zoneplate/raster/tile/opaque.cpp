// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/opaque.h"

#include <algorithm>
#include <bit>
#include <span>

#include "zoneplate/raster/tile/span_presenter.h"

namespace zoneplate {
namespace {

/// One run of shade_opaque.
class OpaqueShading {
 public:
  OpaqueShading(const TileJob& job, const TileVisibility& visibility, FragmentBatcher& batcher, OpaqueFragments& opaque,
                TileColors& colors)
      : job_(job),
        setup_(job.setup),
        target_(job.setup.target),
        visibility_(visibility),
        batcher_(batcher),
        opaque_(opaque),
        colors_(colors),
        lists_(!job.has_transparency() && job.pass.count <= FragmentList::max_samples),
        presenter_(job, colors) {}

  void run() {
    compute_spans();
    if (target_.is_per_sample)
      shade_sample_spans();
    else
      shade_spans();
    shade_list();
    batcher_.shade(opaque_.fragments, opaque_.colors, nullptr);
  }

 private:
  void compute_spans();
  void add_block(int block, std::int32_t id);
  void compute_spans_of(int block);
  void add_sample_spans(std::uint32_t pixel, std::int32_t id);
  void add_span(const FragmentSpan& span) {
    opaque_.spans[span_count_++] = span;
    if (presenter_.applies()) presenter_.add(span.pixel);
  }
  void shade_spans();
  void shade_sample_spans();
  OwnerRow owner_row_at(int x, int y) const;
  void list_span(const OwnerRow& row);
  void shade_list();
  void sum_list();
  void store_listed(const FragmentOutputs& colors, std::size_t first, std::size_t count) const;

  const TileJob& job_;
  const TileSetup& setup_;
  const Target& target_;
  const TileVisibility& visibility_;
  FragmentBatcher& batcher_;
  OpaqueFragments& opaque_;
  TileColors& colors_;
  std::size_t span_count_ = 0;  ///< of OpaqueFragments::spans
  const bool lists_;            ///< pixels of mixed spans go through OpaqueFragments::list
  SpanPresenter presenter_;     ///< of spans
};

void OpaqueShading::compute_spans() {
  const std::size_t most =
      tile_pixels / FragmentBatch::group * static_cast<std::size_t>(target_.is_per_sample ? job_.pass.count : 1);
  if (opaque_.spans.size() < most) opaque_.spans.resize(most);
  span_count_ = 0;
  opaque_.fragments.clear();
  setup_.coverage.fetch_owners(visibility_, opaque_.span_primitive);
  for (int block = 0; block < TileVisibility::blocks; ++block) {
    const std::int32_t owner = visibility_.block_primitive[block];
    const bool is_one = owner != mixed_primitives && owner != no_primitive;
    if (is_one && job_.is_whole_column(block % 8) && !target_.is_per_sample) {
      add_block(block, owner);
    } else {
      compute_spans_of(block);
    }
  }
}

/// Lists the spans of a block that one triangle owns, without testing each span.
void OpaqueShading::add_block(int block, std::int32_t id) {
  const int first = std::max(block / 8 * 8, job_.drawn.top), last = std::min(block / 8 * 8 + 8, job_.drawn.bottom);
  FragmentSpan span = job_.span_at(static_cast<std::uint32_t>(first * tile_size + block % 8 * 8), id);
  for (int y = first; y < last; ++y, span.y += 256, span.pixel += tile_size) add_span(span);
}

void OpaqueShading::compute_spans_of(int block) {
  const int x = block % 8 * 8;
  const int first = std::max(block / 8 * 8, job_.drawn.top), last = std::min(block / 8 * 8 + 8, job_.drawn.bottom);
  const bool is_whole = job_.is_whole_column(block % 8);
  OwnerRow row = owner_row_at(x, first);
  if (row.drawn == 0) return;
  for (int y = first; y < last; ++y, row.id += tile_size, row.pixel += tile_size, row.y += 256) {
    const std::uint32_t pixel = row.pixel;
    const std::int32_t owner = opaque_.span_primitive[pixel / 8];
    const bool is_span = owner != mixed_primitives && is_whole;
    if (owner == no_primitive) {
      colors_.color[pixel / 8] = Linear8{};
    } else if (is_span && target_.is_per_sample) {
      add_sample_spans(pixel, owner);
    } else if (is_span) {
      add_span(job_.span_at(pixel, owner));
    } else if (lists_) {
      list_span(row);
    } else {
      colors_.color[pixel / 8] = Linear8{};
      for (int i = std::max(x, job_.drawn.left); i < std::min(x + 8, job_.drawn.right); ++i)
        add_pixel(job_, visibility_, static_cast<std::uint32_t>(y * tile_size + i), opaque_.fragments);
    }
  }
}

void OpaqueShading::add_sample_spans(std::uint32_t pixel, std::int32_t id) {
  colors_.sum[pixel / 8] = {};
  for (int s = 0; s < job_.pass.count; ++s) {
    const Fragment at = job_.fragment_at(pixel, id, std::uint64_t{1} << s);
    opaque_.spans[span_count_++] = {at.x, at.y, id, pixel};
  }
}

void OpaqueShading::shade_spans() {
  const std::span<const FragmentSpan> spans(opaque_.spans.data(), span_count_);
  const auto begin = [&](std::span<const std::uint32_t> numbers) {
    if (presenter_.applies()) presenter_.prefetch(numbers);
  };
  batcher_.shade(spans, begin, [&](std::span<const std::uint32_t> numbers, const FragmentOutputs& color) {
    if (presenter_.applies()) return presenter_.present(numbers, color);
    const auto resolve = [&](float weight, std::vector<Linear8>& to) {
      Linear8* out[FragmentBatch::groups];
      for (std::size_t i = 0; i < numbers.size(); ++i) out[i] = &to[spans[numbers[i]].pixel / 8];
      setup_.resolve.resolve(color, 0, static_cast<int>(numbers.size()), weight, out);
    };
    resolve(setup_.weight_sum, colors_.color);
    if (job_.has_transparency()) resolve(1, colors_.base);
    if (!target_.sample_color) return;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      for (int s = 0; s < job_.pass.count; ++s)
        store_span(job_, spans[numbers[i]].pixel, s, color, static_cast<int>(i) * FragmentBatch::group);
  });
}

// The samples of a span follow one another, and the spans of one material keep their order.
void OpaqueShading::shade_sample_spans() {
  const std::span<const FragmentSpan> spans(opaque_.spans.data(), span_count_);
  const auto samples = static_cast<std::size_t>(job_.pass.count);
  std::size_t s = 0;
  batcher_.shade(spans, [&](std::span<const std::uint32_t> numbers, const FragmentOutputs& color) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const std::uint32_t pixel = spans[numbers[i]].pixel;
      const int first = static_cast<int>(i) * FragmentBatch::group;
      setup_.resolve.add(color, first, setup_.weights[s], colors_.sum[pixel / 8]);
      if (target_.sample_color) store_span(job_, pixel, static_cast<int>(s), color, first);
      s = s + 1 == samples ? 0 : s + 1;
      if (s == 0) setup_.resolve.divide(colors_.sum[pixel / 8], setup_.weight_sum, colors_.color[pixel / 8]);
    }
  });
}

/// The first span of a block's column, for FragmentListKernels::list; the other spans follow a line apart.
OwnerRow OpaqueShading::owner_row_at(int x, int y) const {
  const auto pixel = static_cast<std::uint32_t>(y * tile_size + x);
  const int first = std::clamp(job_.drawn.left - x, 0, FragmentBatch::group),
            last = std::clamp(job_.drawn.right - x, first, FragmentBatch::group);
  return {.id = visibility_.id + pixel,
          .sample_count = job_.pass.count,
          .first_summand = setup_.centroids.first.data() + job_.pass.first,
          .more_summands = setup_.centroids.more.data() + job_.pass.first,
          .whole = setup_.centroids.whole,
          .pixel = pixel,
          .x = (job_.x + x) * 256,
          .y = (job_.y + y) * 256,
          .drawn = (1u << last) - (1u << first),
          .is_per_sample = target_.is_per_sample};
}

void OpaqueShading::list_span(const OwnerRow& row) {
  setup_.fragment_lists.list(row, opaque_.list);
  opaque_.listed_spans.push_back(row.pixel);
  if (opaque_.list.count >= FragmentList::flush_threshold) shade_list();
}

/// Shades the listed fragments, resolves their spans, and empties the list.
void OpaqueShading::shade_list() {
  FragmentList& list = opaque_.list;
  // Where each pixel is one fragment, the list consists of whole spans.
  const bool are_whole_spans = job_.pass.count == 1 && static_cast<std::size_t>(list.count) ==
                                                           FragmentBatch::group * opaque_.listed_spans.size();
  if (are_whole_spans) {
    batcher_.shade(list, [&](const FragmentOutputs& colors, std::size_t first, std::size_t count) {
      Linear8* span[FragmentBatch::groups];
      for (std::size_t i = 0; i < count; i += FragmentBatch::group)
        span[i / FragmentBatch::group] = &colors_.color[FragmentList::pixel(list.at[first + i]) / 8];
      setup_.resolve.resolve(colors, 0, static_cast<int>(count) / FragmentBatch::group, setup_.weight_sum, span);
      store_listed(colors, first, count);
    });
  } else {
    sum_list();
  }
  opaque_.listed_spans.clear();
  list.count = 0;
}

void OpaqueShading::sum_list() {
  const FragmentList& list = opaque_.list;
  std::vector<Linear>& sums = opaque_.list_sums;
  sums.resize(tile_pixels);
  for (const std::uint32_t pixel : opaque_.listed_spans)
    std::fill_n(&sums[pixel], FragmentBatch::group, Linear{0, 0, 0, 0});
  batcher_.shade(list, [&](const FragmentOutputs& colors, std::size_t first, std::size_t count) {
    const std::uint32_t* const at = list.at + first;
    float weight[FragmentBatch::capacity];
    if (const float* const known = setup_.tabulated_weights(); job_.pass.count <= TileSetup::max_tabulated_samples)
      for (std::size_t i = 0; i < count; ++i) weight[i] = known[FragmentList::samples(at[i])];
    else
      for (std::size_t i = 0; i < count; ++i)
        weight[i] = setup_.weight_of(FragmentList::samples(at[i]), job_.pass.first);
    setup_.fragment_lists.add(colors, at, weight, static_cast<int>(count), &sums[0].r);
    store_listed(colors, first, count);
  });
  for (const std::uint32_t pixel : opaque_.listed_spans)
    setup_.fragment_lists.divide(&sums[pixel].r, setup_.weight_sum, colors_.color[pixel / 8]);
}

void OpaqueShading::store_listed(const FragmentOutputs& colors, std::size_t first, std::size_t count) const {
  if (!target_.sample_color) return;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t at = opaque_.list.at[first + i];
    store_color(job_, FragmentList::pixel(at), FragmentList::samples(at),
                {colors.r[i], colors.g[i], colors.b[i], colors.a[i]});
  }
}

}  // namespace

void add_pixel(const TileJob& job, const TileVisibility& visibility, std::uint32_t pixel, std::vector<Fragment>& out) {
  const auto id_at = [&](int s) { return visibility.id[static_cast<std::size_t>(s) * sample_stride + pixel]; };
  if (job.pass.count == 1 || job.setup.target.is_per_sample) {
    for (int s = 0; s < job.pass.count; ++s)
      if (id_at(s) != no_primitive) out.push_back(job.fragment_at(pixel, id_at(s), std::uint64_t{1} << s));
    return;
  }
  std::uint64_t left = job.pass.all;
  while (left) {
    const std::int32_t id = id_at(std::countr_zero(left));
    std::uint64_t owned = 0;
    for (std::uint64_t rest = left; rest; rest &= rest - 1) {
      const int s = std::countr_zero(rest);
      if (id_at(s) == id) owned |= std::uint64_t{1} << s;
    }
    left &= ~owned;
    if (id != no_primitive) out.push_back(job.fragment_at(pixel, id, owned));
  }
}

void shade_opaque(const TileJob& job, const TileVisibility& visibility, FragmentBatcher& batcher,
                  OpaqueFragments& opaque, TileColors& colors) {
  colors.color.resize(tile_pixels / 8);
  // Most images need neither of these, and the first use of memory costs time.
  if (job.setup.target.is_per_sample) colors.sum.resize(tile_pixels / 8);
  if (job.has_transparency()) colors.base.resize(tile_pixels / 8);
  OpaqueShading(job, visibility, batcher, opaque, colors).run();
}

void resolve_fragments(const TileJob& job, const OpaqueFragments& opaque, TileColors& colors) {
  const std::vector<Fragment>& fragments = opaque.fragments;
  const float weight_sum = job.setup.weight_sum;
  for (std::size_t first = 0; first < fragments.size();) {
    const std::uint32_t pixel = fragments[first].pixel;
    Linear sum{0, 0, 0, 0};
    for (; first < fragments.size() && fragments[first].pixel == pixel; ++first) {
      if (job.setup.target.sample_color) store_color(job, pixel, fragments[first].samples, opaque.colors[first]);
      sum = sum + opaque.colors[first] * job.setup.weight_of(fragments[first].samples, job.pass.first);
    }
    colors.color[pixel / 8].set(pixel % 8,
                                {sum.r / weight_sum, sum.g / weight_sum, sum.b / weight_sum, sum.a / weight_sum});
  }
}

void list_fragments(const TileJob& job, const TileVisibility& visibility, OpaqueFragments& opaque) {
  opaque.fragments.clear();
  opaque.first_fragment.resize(tile_pixels + 1);
  for (std::uint32_t pixel = 0; pixel < tile_pixels; ++pixel) {
    opaque.first_fragment[pixel] = static_cast<std::uint32_t>(opaque.fragments.size());
    if (job.draws(static_cast<int>(pixel % tile_size), static_cast<int>(pixel / tile_size)))
      add_pixel(job, visibility, pixel, opaque.fragments);
  }
  opaque.first_fragment[tile_pixels] = static_cast<std::uint32_t>(opaque.fragments.size());
}

void add_fragments_to_sum(const TileJob& job, const OpaqueFragments& opaque, std::uint32_t pixel, TileColors& colors) {
  for (std::uint32_t f = opaque.first_fragment[pixel]; f < opaque.first_fragment[pixel + 1]; ++f) {
    const std::uint64_t samples = opaque.fragments[f].samples;
    Linear8& sum = colors.sum[pixel / 8];
    sum.set(pixel % 8, sum.get(pixel % 8) + opaque.colors[f] * job.setup.weight_of(samples, job.pass.first));
    colors.coverage[pixel] += static_cast<float>(std::popcount(samples));
  }
}

}  // namespace zoneplate
