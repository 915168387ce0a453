// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/taau/taau_core.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/temporal/resolve.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/upscale/taau/taau_axis.h"
#include "zoneplate/upscale/taau/taau_row.h"

namespace zoneplate::upscale {

const LinearImage& Taau::accumulate(const TaauInput& frame) {
  const int frame_width = frame.color.width(), frame_height = frame.color.height();
  const TaauAxis columns(width_, frame_width, frame.jitter.x), rows(height_, frame_height, frame.jitter.y);
  limited_.fit(frame_width, frame_height);
  antialias::for_rows(frame_height, [&](int y) {
    antialias::TemporalKernels::of().limit(&frame.color.row(y).data()->r, &limited_.row(y).data()->r,
                                           static_cast<std::size_t>(frame_width));
  });
  const float scale_x = static_cast<float>(width_) / static_cast<float>(frame_width);
  const float scale_y = static_cast<float>(height_) / static_cast<float>(frame_height);
  const bool is_first = frame.is_first || history_.empty();
  const TaauFrame common{.width = width_,
                         .height = height_,
                         .is_first = is_first,
                         .scale = {scale_x, scale_y},
                         .radius = 1.51f + (1.3f - 1.51f) * std::clamp(scale_x - 1, 0.0f, 1.0f),
                         .history = is_first ? nullptr : &history_.values().data()->r};
  std::vector<float> column(static_cast<std::size_t>(width_));
  for (std::size_t x = 0; x < column.size(); ++x) column[x] = static_cast<float>(x);
  next_history_.fit(width_, height_);
  parallel_ranges(static_cast<std::size_t>(height_), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int y = static_cast<int>(i);
      TaauRow row{.dx = columns.offset.data(),
                  .dy = rows.offset[i],
                  .column = column.data(),
                  .y = y,
                  .resolved = &next_history_.row(y).data()->r};
      for (int k = 0; k < 3; ++k) {
        const int r = rows.around[k][i];
        row.columns[k] = columns.around[k].data();
        row.color[k] = &limited_.row(r).data()->r, row.nearness[k] = frame.nearness.row(r).data();
        row.motion_x[k] = frame.motion_x.row(r).data(), row.motion_y[k] = frame.motion_y.row(r).data();
      }
      TaauKernels::of().resolve_row(common, row, column.size());
    }
  });
  std::swap(history_, next_history_);
  return history_;
}

}  // namespace zoneplate::upscale
