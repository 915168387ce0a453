// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/sgsr/sgsr2_core.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/upscale/sgsr/sgsr2_rows.h"

namespace zoneplate::upscale {
namespace {

template <class Body>
void for_each_row(int height, const Body& body) {
  parallel_ranges(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) body(y);
  });
}

/// What output pixels read along one axis of the frame.
struct Sgsr2Axis {
  std::vector<std::int32_t> around[3];   ///< the pixels of the samples
  std::vector<float> offset;             ///< of the middle one from the output pixel's centre
  std::vector<std::int32_t> between[2];  ///< the pixels whose values are interpolated
  std::vector<float> beyond, centre;

  Sgsr2Axis(int to, int from, float jitter, int floats) {
    const auto size = static_cast<float>(from);
    const float pixel = 1 / size, output_pixel = 1 / static_cast<float>(to);
    const auto within = [&](int i) { return std::clamp(i, 0, from - 1) * floats; };
    for (int o = 0; o < to; ++o) {
      const float u = (static_cast<float>(o) + 0.5f) * output_pixel, at = std::clamp(u + jitter * pixel, 0.0f, 1.0f);
      const int middle = static_cast<int>(at * size);
      for (int k = 0; k < 3; ++k) around[k].push_back(within(middle + k - 1));
      offset.push_back(static_cast<float>(middle) + 0.5f - jitter - u * size);
      const float place = at * size - 0.5f, floored = std::floor(place);
      for (int k = 0; k < 2; ++k) between[k].push_back(within(static_cast<int>(floored) + k));
      beyond.push_back(place - floored), centre.push_back(u);
    }
  }
};

}  // namespace

void Sgsr2::convert(const Sgsr2Frame& frame) {
  const int width = frame.color.width(), height = frame.color.height();
  motion_clip_.fit(width, height), ycocg_.fit(width, height);
  auto depth =
      Plane<float>::unset(width + 3, height + 3);  // one pixel to the left and above, two to the right and below
  for_each_row(depth.height(), [&](int y) {
    for (int x = 0; x < depth.width(); ++x)
      depth(x, y) = frame.depth(std::clamp(x - 1, 0, width - 1), std::clamp(y - 1, 0, height - 1));
  });
  std::vector<float> centres;
  for (int x = 0; x < width; ++x)
    centres.push_back(2 * ((static_cast<float>(x) + 0.5f) / static_cast<float>(width)) - 1);
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  Sgsr2ConvertFrame common{.separation = 1.37e-5f * frame.half_width * std::sqrt(w * w + h * h)};
  for (std::size_t k = 0; k < 4; ++k) {
    const float4 c = frame.last_clip_from_clip.column[k];
    const float values[4] = {c.x, c.y, c.z, c.w};
    std::ranges::copy(values, common.last_clip_from_clip[k]);
  }
  for_each_row(height, [&](int y) {
    Sgsr2ConvertRow row{.color = &frame.color.row(y).data()->r,
                        .motion_x = frame.motion_x.row(y).data(),
                        .motion_y = frame.motion_y.row(y).data(),
                        .x = centres.data(),
                        .y = 2 * ((static_cast<float>(y) + 0.5f) / h) - 1,
                        .motion_clip = &motion_clip_.row(y).data()->x,
                        .ycocg = &ycocg_.row(y).data()->x};
    for (int k = 0; k < 4; ++k) row.depth[k] = depth.row(y + k).data() + 1;
    Sgsr2Kernels::of().convert_row(common, row, static_cast<std::size_t>(width));
  });
}

LinearImage Sgsr2::accumulate(const Sgsr2Frame& frame, LinearImage memory) {
  const int frame_width = frame.color.width(), frame_height = frame.color.height();
  frames_at_rest_ = frame.is_camera_at_rest && !frame.is_first ? frames_at_rest_ + 1 : 0;
  convert(frame);
  const Sgsr2Axis columns(width_, frame_width, frame.jitter.x, 4), rows(height_, frame_height, frame.jitter.y, 1);
  const float ratio = static_cast<float>(width_) / static_cast<float>(frame_width);
  const float area = ratio * (static_cast<float>(height_) / static_cast<float>(frame_height));
  const bool is_first = frame.is_first || history_.empty();
  const Sgsr2UpscaleFrame common{.width = width_,
                                 .height = height_,
                                 .is_first = is_first,
                                 .taps = frame.is_camera_at_rest ? 9 : 5,
                                 .kernel_max = std::min(ratio, 1.99f),
                                 .box_scale = std::min(20.0f, area * area * area),
                                 .rest_share = frames_at_rest_ > 5 ? 0.3f : 0.0f,
                                 .history = is_first ? nullptr : &history_.values().data()->x};
  next_history_.fit(width_, height_);
  LinearImage out = std::move(memory);
  out.fit(width_, height_);
  for_each_row(height_, [&](int o) {
    const auto i = static_cast<std::size_t>(o);
    Sgsr2UpscaleRow row{.dx = columns.offset.data(),
                        .dy = rows.offset[i],
                        .motion_right = columns.beyond.data(),
                        .motion_below = rows.beyond[i],
                        .u = columns.centre.data(),
                        .v = rows.centre[i],
                        .history = &next_history_.row(o).data()->x,
                        .color = &out.row(o).data()->r};
    for (int k = 0; k < 3; ++k) {
      row.ycocg[k] = &ycocg_.row(rows.around[k][i]).data()->x;
      row.columns[k] = columns.around[k].data();
    }
    for (int k = 0; k < 2; ++k) {
      row.motion_clip[k] = &motion_clip_.row(rows.between[k][i]).data()->x;
      row.motion_columns[k] = columns.between[k].data();
    }
    Sgsr2Kernels::of().upscale_row(common, row, static_cast<std::size_t>(width_));
  });
  std::swap(history_, next_history_);
  return out;
}

}  // namespace zoneplate::upscale
