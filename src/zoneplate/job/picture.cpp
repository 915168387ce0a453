// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <filesystem>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/base/size_text.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/codec/webp_still.h"
#include "zoneplate/job/exr_header.h"
#include "zoneplate/job/look/solid_texture.h"
#include "zoneplate/job/output/aov_file.h"
#include "zoneplate/job/output/frame_name.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/metering/metering.h"
#include "zoneplate/scene/geometry/displacement.h"

namespace zoneplate {
namespace {

bool is_pfm(const std::string& output) { return extension_of(output) == ".pfm"; }
bool is_exr(const std::string& output) { return extension_of(output) == ".exr"; }

std::vector<std::uint8_t> exr_of(const LinearImage& color, const DataChannels& data, ExrAttributes attributes,
                                 const FileOptions& options) {
  std::vector<ExrChannel> channels = rgba_channels(color);
  add_exr_channels(data, channels);
  attributes.insert(attributes.end(), data.attributes.begin(), data.attributes.end());
  return encode_exr(color.width(), color.height(), std::move(channels), attributes,
                    options.exr_compression.value_or(ExrCompression::Zip));
}

// The encoded values in memory order, rows from the top.
template <class T>
std::vector<std::uint8_t> raw_of(const Plane<T>& image) {
  static_assert(std::endian::native == std::endian::little, "16 bits are written low byte first");
  const auto* first = reinterpret_cast<const std::uint8_t*>(image.values().data());
  return {first, first + image.values().size_bytes()};
}

// Adds the data passes, as separate files or as channels of the image's file.
void add_passes(const Job& job, const Scene& scene, const Frame& frame, const std::string& output, Rendered& out) {
  DataChannels data;
  for (std::size_t i = 0; i < job.aovs.size(); ++i) {
    const Aov* const aov = job.aovs[i];
    if (is_exr(output)) {
      aov->add_channels(frame, scene, data);
      continue;
    }
    std::optional<std::vector<std::uint8_t>> pfm = is_pfm(output) ? encode_data_pfm(*aov, frame, scene) : std::nullopt;
    out.layers.push_back({static_cast<int>(i), pfm ? std::move(*pfm) : encode_data_png(*aov, frame, scene)});
  }
  if (is_exr(output)) out.exr = exr_of(out.linear, data, out.attributes, job.file);
}

// Checks the memory of a frame's planes and of its copies for encoding, in bytes per pixel: see Frame, DisplayImage,
// Rgba8Image.
void check_memory(const Job& job, const Request& request) {
  constexpr std::uint64_t bytes_per_sample = 24;  // if every sample is stored: colour, depth, triangle
  Planes planes;
  for (const Aov* aov : job.aovs) planes.*(aov->plane) = true;
  const std::uint64_t bytes_per_pixel =
      (planes.any_light() ? 64 : 0) + (job.aovs.empty() ? 44 : 136) +
      (planes.sample_triangles ? 96 + sizeof(std::uint32_t) * request.samples.size() : 0) +
      (request.planes.samples ? bytes_per_sample * request.samples.size() : 0);
  const std::optional<Crop> crop = padded_crop(job.options, request.halo);
  const auto width = static_cast<std::uint64_t>(crop ? crop->width : job.options.width);
  const auto height = static_cast<std::uint64_t>(crop ? crop->height : job.options.height);
  const std::uint64_t need = width * height * bytes_per_pixel;
  if (need > job.load.limits.memory)
    throw Error(ErrorKind::Failed,
                fmt::format("{}: an image of {}x{} needs {} of memory, --max-memory allows {}", job.input, width,
                            height, size_text(need), size_text(job.load.limits.memory)));
}

}  // namespace

bool is_linear(const std::string& output) { return is_pfm(output) || is_exr(output); }

std::string aov_path(const std::string& output, std::string_view name) {
  if (is_exr(output)) return output;
  return std::filesystem::path(output).replace_extension(fmt::format(".{}.{}", name, is_pfm(output) ? "pfm" : "png"));
}

std::string output_path(const Job& job, int frame, int layer) {
  const std::string picture = job.frame_place ? frame_name(job.output, *job.frame_place, frame) : job.output;
  return layer < 0 ? picture : aov_path(picture, job.aovs.at(static_cast<std::size_t>(layer))->name);
}

Request request_of(const Job& job, Resolver& method) {
  return method.request({.image = {job.options.width, job.options.height, job.options.crop}});
}

void check_request(const Job& job, const Request& request) {
  if (request.is_display_referred && is_linear(job.named_output()))
    throw Error(ErrorKind::Usage, fmt::format("--anti-aliasing: {} works after tone mapping, and {} is scene-linear: "
                                              "write a .png, or use a method such as msaa or ssaa",
                                              job.method, extension_of(job.named_output())));
  check_memory(job, request);
}

void check_passes(const Job& job, const Request& request) {
  const bool has_error = std::ranges::any_of(job.aovs, [](const Aov* aov) { return aov->plane == &Planes::error; });
  if (has_error && !request.estimates_error)
    throw Error(ErrorKind::Usage,
                "--aov error: " + job.method + " has no estimate of its error; converged and analytic have");
}

void convert_materials(const Job& job, Scene& scene) {
  set_default_material(job.default_material, job.load.limits, scene);
  cut_scene(scene, job.section.planes, job.section.color);
  if (job.shading_model)
    for (Material& material : scene.materials) convert_material(material, *job.shading_model);
  if (job.displacement) displace_surfaces(scene, {.tolerance = *job.displacement});
  if (!job.solid_texture.empty()) set_solid_texture(job.solid_texture, scene);
}

ToneMapping set_look(const Job& job, Scene& scene) {
  convert_materials(job, scene);
  Lighting lighting = make_lighting(scene, job.lighting);
  scene.lights = std::move(lighting.lights);
  scene.environment = lighting.environment;
  scene.ambient_light = lighting.ambient_light;
  return lighting.tone_mapping;
}

RenderSettings settings_of(const Job& job, const std::string& output) {
  RenderSettings settings{.options = job.options};
  settings.options.display = job.display;
  for (const Aov* aov : job.aovs) settings.planes.*(aov->plane) = settings.planes.depth = true;
  settings.form = is_linear(output)     ? ImageForm::Linear
                  : job.bit_depth == 16 ? ImageForm::Display16
                  : job.dithers         ? ImageForm::Display8Dithered
                                        : ImageForm::Display8;
  return settings;
}

Rendered finish_picture(const Job& job, RenderedImage image, const Scene& scene, const Camera& camera,
                        const std::string& output, Summary& summary, std::optional<int> frame) {
  const Stopwatch watch;
  const DisplayOptions& display = job.display;
  Rendered out;
  out.image = std::move(image.display);
  out.image16 = std::move(image.display16);
  if (is_linear(output)) out.linear = over_background(std::move(image.linear), display);
  if (is_exr(output)) out.attributes = exr_header(job, camera, scene.origin, frame);
  out.has_alpha = display.is_transparent || display.background.w < 1;
  if (!job.aovs.empty()) add_passes(job, scene, image.data, output, out);
  const std::optional<Crop>& crop = job.options.crop;
  summary.width = crop ? crop->width : job.options.width;
  summary.height = crop ? crop->height : job.options.height;
  summary.counts = image.counts;
  summary.times.insert(summary.times.end(), {{"prepare", image.counts.prepare_ms},
                                             {"geometry", image.counts.geometry_ms},
                                             {"tiles", image.counts.tiles_ms},
                                             {"display", image.counts.resolve_ms + image.counts.display_ms +
                                                             image.counts.filter_ms + watch.ms()}});
  return out;
}

std::vector<std::uint8_t> encode_picture(const Rendered& picture, const std::string& output,
                                         const FileOptions& options) {
  const std::string extension = extension_of(output);
  if (extension == ".rgba") return picture.image16.empty() ? raw_of(picture.image) : raw_of(picture.image16);
  if (extension == ".pfm") return encode_pfm(picture.linear);
  if (extension == ".exr")
    return picture.exr.empty() ? exr_of(picture.linear, {}, picture.attributes, options) : picture.exr;
  if (extension == ".jpg" || extension == ".jpeg")
    return encode_jpeg(picture.image, options.jpeg_quality.value_or(default_jpeg_quality));
  if (extension == ".webp") return encode_webp(picture.image, picture.has_alpha, options.webp_quality);
  if (extension == ".avif" || extension == ".jxl")
    return encode_codes(picture.image, picture.has_alpha, extension, output);
  const PngOptions png{.has_alpha = picture.has_alpha, .is_small = options.is_small_png};
  return picture.image16.empty() ? encode_png(picture.image, png) : encode_png(picture.image16, png);
}

namespace {

Rgba8 background_code(const Job& job) {
  const float4 b = job.display.background;
  const auto code = [](float x) { return static_cast<std::uint8_t>(x * 255 + 0.5f); };
  return {code(b.x), code(b.y), code(b.z), code(b.w)};
}

/// Whether every pixel is the background.
bool is_background_alone(const Job& job, const Rendered& picture) {
  const Rgba8 background = background_code(job);
  const auto is_background = [&](Rgba8 c) { return c.a == 0 || c == background; };
  const auto is_clear = [](const Linear& c) { return c.a == 0; };
  if (!picture.image.values().empty()) return std::ranges::all_of(picture.image.values(), is_background);
  return !picture.linear.values().empty() && std::ranges::all_of(picture.linear.values(), is_clear);
}

}  // namespace

std::string clipping(const Job& job, const Rgba8Image& image, const std::function<float()>& metered) {
  const Rgba8 background = background_code(job);
  std::size_t surfaces = 0, white = 0;
  for (const Rgba8 c : image.values()) {
    if (c.a == 0 || c == background) continue;
    ++surfaces;
    white += c.r == 255 && c.g == 255 && c.b == 255;
  }
  const double part = static_cast<double>(white) / static_cast<double>(std::max<std::size_t>(surfaces, 1));
  if (part < min_white || !is_well_above_white(job.display.exposure, metered())) return {};
  return fmt::format(
      "{}: {:.0f} % of the surfaces are clipped to white; see --exposure auto, --lights and "
      "--tone-mapping",
      job.input, 100 * part);
}

std::string emptiness(const Job& job, const RenderCounts& counts, const Rendered& picture) {
  if (counts.triangles == 0) return job.input + ": there is nothing in it to draw";
  if (counts.triangles_set_up == 0) return job.input + ": nothing of it is in view; see the camera options";
  if (job.options.crop || !is_background_alone(job, picture)) return {};
  return job.input + ": nothing of it can be seen: its surfaces are transparent, too small or as the background";
}

}  // namespace zoneplate
