// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/image/tonemap.h"
#include "zoneplate/imaging/filter/items.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/metrics/file/picture_set.h"
#include "zoneplate/process/delivery.h"
#include "zoneplate/render/method.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {

/// How images are filtered.
struct FilterOptions {
  std::string method, upscaler, jitter, layer;
  float2 motion_scale{1, 1};
  double fov = 60;
  std::optional<int2> size;  ///< of the upscaled images
  int bit_depth = 8;
  std::optional<float4> background;
  std::optional<ToneMapping> tone_mapping;
  std::optional<float> exposure;  ///< a factor
  bool meters_exposure = false;

  /// Whether scene-linear images become display-referred ones.
  bool is_display_transform() const { return tone_mapping || exposure || meters_exposure; }
};

/// What is done to each image: antialiasing, upscaling, or the one and then the other.
struct Filters {
  std::unique_ptr<Resolver> antialiasing;     ///< or null
  std::unique_ptr<SpatialUpscaler> upscaler;  ///< or null
  std::optional<int2> size;                   ///< of the upscaled image; none: that of the input times `scale`
  double scale = 1;
};

/// The filters of single images that the options select.
///
/// Errors    ErrorKind::Usage where they select none.
Filters make_filters(const FilterOptions& options);

/// The names of the methods that filter images or sequences of images, and of the upscalers, for help and messages.
std::string image_filter_list();
std::string image_upscaler_list();

/// What is filtered, and how.
struct FilterWork {
  const FilterOptions& args;
  const std::string& operand;
  const std::string& method;  ///< with history; empty: `filters`
  const std::vector<FilterItem>& items;
  const FramePasses& passes;
  const Filters& filters;
  const std::optional<metrics::PictureSet>& video;  ///< its frames and times, if the operand is a video
};

/// Filters the images, in a confined process.
void filter_all(const FilterWork& work, Delivery& out);

}  // namespace zoneplate
