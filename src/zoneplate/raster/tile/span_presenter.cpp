// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/span_presenter.h"

namespace zoneplate {

SpanPresenter::SpanPresenter(const TileJob& job, TileColors& colors) : target_(job.setup.target), colors_(colors) {
  colors_.written_spans.fill(0);
  const bool stores_display_alone = target_.display8 && !target_.color && !target_.sample_color;
  if (!stores_display_alone || target_.is_per_sample || job.has_transparency()) return;
  if (!cancels_exactly(job.setup.weight_sum)) return;
  pixels_ = target_.display8->values().data();
  stride_ = target_.display8->width();
  first_ = job.target_y(0) * stride_ + job.target_x(0);
}

void SpanPresenter::prefetch(std::span<const std::uint32_t> numbers) const {
  for (const std::uint32_t number : numbers) __builtin_prefetch(spans_[number], 1);
  asm volatile("");  // GCC 12 removes functions and loops that only prefetch
}

void SpanPresenter::present(std::span<const std::uint32_t> numbers, const FragmentOutputs& color) const {
  Rgba8* out[FragmentBatch::groups];
  for (std::size_t i = 0; i < numbers.size(); ++i) out[i] = spans_[numbers[i]];
  target_.display_transform->present({{color.r, color.g, color.b, color.a}, FragmentBatch::group},
                                     {out, numbers.size()});
}

}  // namespace zoneplate
