// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/filter/filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/image/auto_exposure.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/imaging/filter/color.h"
#include "zoneplate/imaging/filter/frames.h"
#include "zoneplate/imaging/filter/sequence.h"
#include "zoneplate/imaging/filter/still.h"
#include "zoneplate/metrics/backdrop.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/process/exr_layer.h"

namespace zoneplate {
namespace {

/// True for a method that only needs the display-referred image of a frame.
bool reads_image_alone(Resolver& method) {
  const Request request = method.request({});
  return request.is_display_referred && request.samples.size() == 1 && !request.draw && !request.planes.any();
}

std::unique_ptr<Resolver> make_filter(const std::string& method) {
  std::unique_ptr<Resolver> filter = make_resolver(antialias::methods(), method);
  if (!reads_image_alone(*filter))
    throw Error(ErrorKind::Usage, fmt::format("--anti-aliasing: {} needs a scene, expected a filter of images: {}",
                                              method, image_filter_list()));
  return filter;
}

UpscaleGrid grid_of(const Filters& filters, int width, int height, const std::string& input) {
  constexpr int max_side = 32768;
  const auto scaled = [&](int side) { return static_cast<int>(std::floor(side * filters.scale + 0.5)); };
  const int2 size = filters.size.value_or(int2{scaled(width), scaled(height)});
  if (size.x < width || size.y < height)
    throw Error(ErrorKind::Usage, fmt::format("--size {}x{}: is smaller than {}, which has {}x{} pixels, and upscalers "
                                              "only enlarge; zoneplate signal resample reduces",
                                              size.x, size.y, input, width, height));
  if (size.x > max_side || size.y > max_side)
    throw Error(ErrorKind::Usage, fmt::format("{}: upscaled to {}x{} pixels, expected at most {} along each side",
                                              input, size.x, size.y, max_side));
  return {width, height, 0, 0, {size.x, size.y, std::nullopt}};
}

DisplayImage filtered(DisplayImage image, const Filters& filters, const std::string& input) {
  if (filters.antialiasing) image = filters.antialiasing->post_process(std::move(image), Frame());
  if (filters.upscaler)
    image = filters.upscaler->upscale(image, grid_of(filters, image.width(), image.height(), input));
  return image;
}

bool is_clamped(const Linear& c) {
  const auto is_outside = [&](float v) { return v < 0 || v > std::max(c.a, 0.0f); };
  return is_outside(c.r) || is_outside(c.g) || is_outside(c.b);
}

void warn_of_clamped(const std::string& input, std::ptrdiff_t pixels, const char* what, Delivery& out) {
  if (pixels > 0)
    out.warn(fmt::format("{}: {} {}{} light outside 0 to 1, which is clamped", input, pixels, what,
                         pixels == 1 ? "pixel has" : "pixels have"));
}

/// Antialiases the sRGB codes of an image, with light of any primaries. Pixels that the filter does not blend keep
/// their light.
void antialias_linear(const FilterItem& item, metrics::Picture& picture, Resolver& filter, Delivery& out) {
  const DisplayImage filtered = filter.post_process(picture.display, Frame());
  std::ptrdiff_t clamped = 0;
  for (std::size_t i = 0; i < filtered.values().size(); ++i) {
    const Display& c = filtered.values()[i];
    if (c == picture.display.values()[i]) continue;
    Linear& light = picture.linear.values()[i];
    clamped += is_clamped(light);
    light = {decode_srgb(c.r) * c.a, decode_srgb(c.g) * c.a, decode_srgb(c.b) * c.a, c.a};
  }
  warn_of_clamped(item.input, clamped, "blended ", out);
}

/// Says what a filter of display-referred values cannot represent of scene-linear ones.
void warn_of_lost_light(const FilterItem& item, const upscale::UpscaledLight& light, Delivery& out) {
  std::string text;
  const auto add = [&](bool is_lost, const std::string& what) {
    if (is_lost) text += (text.empty() ? "" : ", ") + what;
  };
  add(light.negative > 0, fmt::format("{} below 0, which count as 0", light.negative));
  add(light.bright > 0, fmt::format("{} above 32768, which count as that", light.bright));
  add(light.additive > 0, fmt::format("{} with light at alpha 0, which counts as none", light.additive));
  constexpr float accepted = 0.02f;
  if (std::abs(light.constant - light.brightest) > accepted * light.brightest)
    add(true, fmt::format("those of the brightest light, {:.4g}, which becomes {:.4g} where it is constant",
                          light.brightest, light.constant));
  if (!text.empty())
    out.warn(fmt::format("{}: this upscaler maps light to [0, 1], of pixels: {}; bilinear, bicubic and lanczos keep it",
                         item.input, text));
}

void filter_linear(const FilterItem& item, Still still, const Filters& filters, Delivery& out) {
  if (filters.antialiasing) antialias_linear(item, still.picture, *filters.antialiasing, out);
  LinearImage& image = still.picture.linear;
  if (filters.upscaler) {
    const UpscaleGrid grid = grid_of(filters, image.width(), image.height(), item.input);
    upscale::UpscaledLight light = upscale::upscale_linear(*filters.upscaler, image, grid);
    warn_of_lost_light(item, light, out);
    image = std::move(light.image);
  }
  warn_of_left_out(item.output, item.input, save_light(item.output, image, still.file, {}, out), out);
}

/// The display-referred image of scene-linear light, which make_display shows: over the background, or with its alpha.
metrics::Picture displayed(metrics::Picture picture, const FilterOptions& args, const FilterItem& item) {
  if (!picture.is_scene_linear)
    throw Error(ErrorKind::Usage,
                fmt::format("{}: is a display-referred image; --tone-mapping and --exposure are for scene-linear ones",
                            item.input));
  if (is_linear_file(item.output))
    throw Error(ErrorKind::Usage,
                fmt::format("{}: is scene-linear, before --tone-mapping and --exposure: write a .png", item.output));
  picture = metrics::in_srgb(std::move(picture));
  const float exposure = args.meters_exposure ? auto_exposure(picture.linear) : args.exposure.value_or(1.0f);
  const DisplayOptions options{.mapping = args.tone_mapping.value_or(ToneMapping::None),
                               .exposure = exposure,
                               .is_transparent = !args.background,
                               .background = args.background.value_or(float4{0, 0, 0, 1})};
  return metrics::make_picture(make_display(picture.linear, options));
}

void filter_image(const FilterItem& item, const Filters& filters, const FilterOptions& args, Delivery& out) {
  Still still = load_still(item.input, {args.layer, area_for(item.output, !filters.upscaler)}, out);
  metrics::Picture& picture = still.picture;
  if (args.is_display_transform()) picture = displayed(std::move(picture), args, item);
  const bool is_laid = args.background && metrics::has_alpha(picture);
  picture = in_space_of(std::move(picture), is_laid ? FilteredValues::Light : FilteredValues::Codes, item.input,
                        item.output, out);
  if (is_laid) lay_over(picture, *args.background);
  if (picture.is_scene_linear && is_linear_file(item.output))
    return filter_linear(item, std::move(still), filters, out);
  if (picture.is_scene_linear && !filters.antialiasing)
    throw Error(ErrorKind::Usage, fmt::format("{}: is a scene-linear image, and {} is not: write an .exr or a .pfm",
                                              item.input, item.output));
  if (picture.is_scene_linear)
    warn_of_clamped(item.input, std::ranges::count_if(picture.linear.values(), is_clamped), "", out);
  if (!picture.is_scene_linear && is_linear_file(item.output))
    throw Error(ErrorKind::Usage, fmt::format("{}: is a display-referred image, and {} is scene-linear: write a .png",
                                              item.input, item.output));
  const DisplayImage image = filtered(std::move(picture.display), filters, item.input);
  const ColorProfile profile = profile_of(picture.space);
  if (args.bit_depth == 8) return out.save(item.output, encode_image(item.output, quantize8(image), profile));
  out.save(item.output, encode_png(quantize16(image), {.profile = profile}));
}

/// The frames of the only item, if it is an animation; null if there are several items, or it is one image.
std::optional<metrics::PictureSet> frames_of(const FilterWork& work, Delivery& out) {
  if (work.video) return work.video;
  const std::string& input = work.items.front().input;
  if (work.items.size() > 1 || input == "-") return std::nullopt;
  std::optional<metrics::PictureSet> frames;
  out.read(input, [&] { frames = metrics::with_frames(metrics::open_pictures(input), out.limits().pixels); });
  return frames->time_of ? std::move(frames) : std::nullopt;
}

void filter_frames(const FilterWork& work, const metrics::PictureSet& frames, Delivery& out) {
  const FilterItem& item = work.items.front();
  FrameSink sink(item, frames, work.args.bit_depth, out);
  for (std::size_t i = 0; i < frames.names.size(); ++i) {
    out.progress(frames.names[i], static_cast<double>(i) / static_cast<double>(frames.names.size()));
    metrics::Picture picture = metrics::in_srgb(load_still(frames.open(i), out));
    if (work.args.background) lay_over(picture, *work.args.background);
    sink.add(filtered(std::move(picture.display), work.filters, item.input), frames.time_of(i));
  }
  sink.finish();
}

void filter_items(const FilterWork& work, Delivery& out) {
  const FilterOptions& args = work.args;
  const std::optional<metrics::PictureSet> frames = frames_of(work, out);
  if (!work.method.empty()) {
    if (const std::string gaps = gaps_in(work.items); !gaps.empty())
      out.warn(fmt::format("{}: has no frame {}: the history goes on without them", work.operand, gaps));
    const double scale =
        args.upscaler.empty() ? 1 : parse_spec("upscaler", upscale::upscalers(), work.method).settings.number("scale");
    return filter_sequence({.method = work.method,
                            .items = work.items,
                            .animation = frames,
                            .passes = work.passes,
                            .jitter = args.jitter,
                            .motion_scale = args.motion_scale,
                            .fov = static_cast<float>(args.fov),
                            .size = args.size,
                            .scale = scale,
                            .layer = args.layer,
                            .bit_depth = args.bit_depth,
                            .background = args.background},
                           out);
  }
  if (frames && args.is_display_transform())
    throw Error(ErrorKind::Usage,
                fmt::format("{}: is display-referred; --tone-mapping and --exposure are for scene-linear images",
                            work.items.front().input));
  if (frames) return filter_frames(work, *frames, out);
  double done = 0;
  for (const FilterItem& item : work.items) {
    out.progress(item.input, done++ / static_cast<double>(work.items.size()));
    filter_image(item, work.filters, args, out);
  }
}

}  // namespace

std::string image_filter_list() {
  std::string names;
  for (const Method& method : antialias::methods())
    if (reads_image_alone(*make_resolver(antialias::methods(), method.name)) ||
        filters_sequences(std::string(method.name)))
      names += fmt::format("{}{}", names.empty() ? "" : ", ", method.name);
  return names;
}

std::string image_upscaler_list() {
  std::string names;
  for (const Upscaler& row : upscale::upscalers())
    if (row.make_spatial || filters_sequences(std::string(row.name)))
      names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
  return names;
}

Filters make_filters(const FilterOptions& args) {
  if (args.method.empty() && args.upscaler.empty() && !args.is_display_transform())
    throw Error(ErrorKind::Usage,
                fmt::format("--anti-aliasing, --upscale or --tone-mapping is missing: one of {}, or one of {}",
                            image_filter_list(), image_upscaler_list()));
  Filters filters;
  if (!args.method.empty()) filters.antialiasing = make_filter(args.method);
  if (args.upscaler.empty()) {
    if (args.size) throw Error(ErrorKind::Usage, "--size requires --upscale: one of " + image_upscaler_list());
    return filters;
  }
  const Spec<Upscaler> spec = parse_spec("upscaler", upscale::upscalers(), args.upscaler);
  filters.upscaler = upscale::make_spatial_upscaler(args.upscaler);
  filters.size = args.size, filters.scale = spec.settings.number("scale");
  return filters;
}

void filter_all(const FilterWork& work, Delivery& out) {
  out.repeat_no_warnings();
  filter_items(work, out);
  out.tell_repeated(work.operand);
}

}  // namespace zoneplate
