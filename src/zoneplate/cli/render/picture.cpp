#include "zoneplate/cli/render/picture.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <filesystem>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/render/frame_name.h"
#include "zoneplate/codec/exr_encode.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/webp_still.h"
#include "zoneplate/image/dither.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/picture.h"

namespace zoneplate::cli {
namespace {

// What is rendered for a crop: so much more around it as the method looks at, within the picture.
std::optional<Crop> rendered_crop(const RenderOptions& options, int halo) {
  if (!options.crop) return std::nullopt;
  const Crop c = *options.crop;
  const int left = std::min(halo, c.x), top = std::min(halo, c.y);
  return Crop{c.x - left, c.y - top, left + c.width + std::min(halo, options.width - c.x - c.width),
              top + c.height + std::min(halo, options.height - c.y - c.height)};
}

// "#333333", as F3D shows models by default; the homework's scene is defined on black.
float4 background_of(const RenderArgs& args) {
  if (args.background) return *args.background;
  return args.input == "triangles" ? float4{0, 0, 0, 1} : float4{0.2f, 0.2f, 0.2f, 1};
}

Request request_of(Resolver& resolver, const RenderArgs& args) {
  Request request = resolver.request(0);
  for (const Aov* aov : args.aovs) request.planes.*(aov->plane) = request.planes.depth = true;
  if (request.planes.error && !request.estimates_error)
    throw Error(ErrorKind::Usage,
                "--aov error: " + args.method + " has no estimate of its error; converged and analytic have");
  return request;
}

template <class T>
void cut_out(Plane<T>& image, const Crop& part) {
  if (image.empty()) return;
  Plane<T> out(part.width, part.height);
  for (int y = 0; y < part.height; ++y)
    std::ranges::copy_n(image.row(part.y + y).begin() + part.x, part.width, out.row(y).begin());
  image = std::move(out);
}

bool is_pfm(const std::string& output) { return extension_of(output) == ".pfm"; }
bool is_exr(const std::string& output) { return extension_of(output) == ".exr"; }
bool is_linear(const std::string& output) { return is_pfm(output) || is_exr(output); }

// The picture before tone mapping, over the background.
LinearImage over_background(LinearImage image, const DisplayOptions& display) {
  const float4 b = display.background;
  const Linear behind{decode_srgb(b.x), decode_srgb(b.y), decode_srgb(b.z), 1};
  for (Linear& c : image.values()) {
    const float rest = display.is_transparent ? 0.0f : (1 - c.a) * b.w;
    c = c * display.exposure + behind * rest;
  }
  return image;
}

DisplayOptions display_of(const RenderArgs& args) {
  DisplayOptions display = args.display;
  display.background = background_of(args);
  return display;
}

// From linear light to what is written.
void finish(const RenderArgs& args, LinearImage picture, const Frame& frame, Resolver& resolver,
            const std::string& output, Rendered& out) {
  if (is_linear(output)) {
    out.linear = over_background(std::move(picture), frame.display);
    return;
  }
  const DisplayImage shown = resolver.post_process(make_display(picture, frame.display), frame);
  if (args.bit_depth == 16)
    out.image16 = quantize16(shown);
  else
    out.image = args.dithers ? quantize8_dithered(shown) : quantize8(shown);
}

std::vector<std::uint8_t> exr_of(const LinearImage& color, const DataChannels& data) {
  const Linear* first = color.values().data();
  std::vector<ExrChannel> channels = {{"R", ExrType::Half, &first->r, nullptr, 4},
                                      {"G", ExrType::Half, &first->g, nullptr, 4},
                                      {"B", ExrType::Half, &first->b, nullptr, 4},
                                      {"A", ExrType::Half, &first->a, nullptr, 4}};
  channels.insert(channels.end(), data.list.begin(), data.list.end());
  return encode_exr(color.width(), color.height(), std::move(channels), data.attributes);
}

// Codes one after the other as they stand in memory, rows from the top.
template <class T>
std::vector<std::uint8_t> raw_of(const Plane<T>& image) {
  static_assert(std::endian::native == std::endian::little, "16 bits are written low byte first");
  const auto* first = reinterpret_cast<const std::uint8_t*>(image.values().data());
  return {first, first + image.values().size_bytes()};
}

// The data passes, in files of their own or in the picture's.
void add_passes(const RenderArgs& args, const Scene& scene, const Frame& frame, const std::string& output,
                Rendered& out) {
  DataChannels data;
  for (std::size_t i = 0; i < args.aovs.size(); ++i) {
    const Aov* const aov = args.aovs[i];
    if (is_exr(output)) {
      aov->add_channels(frame, scene, data);
      continue;
    }
    std::optional<std::vector<std::uint8_t>> pfm = is_pfm(output) ? encode_data_pfm(*aov, frame, scene) : std::nullopt;
    out.layers.push_back({static_cast<int>(i), pfm ? std::move(*pfm) : aov->encode(frame, scene)});
  }
  if (is_exr(output)) out.exr = exr_of(out.linear, data);
}

// The planes of a frame and its copies on the way to a file, in bytes a pixel: see Frame, DisplayImage, Rgba8Image.
void check_memory(const RenderArgs& args, const Request& request) {
  constexpr std::uint64_t bytes_per_sample = 24;  // where every sample is stored: colour, depth, triangle
  const bool has_matte =
      std::ranges::any_of(args.aovs, [](const Aov* a) { return a->plane == &Planes::sample_triangles; });
  const std::uint64_t bytes_per_pixel = (args.aovs.empty() ? 44 : 136) +
                                        (has_matte ? 96 + sizeof(std::uint32_t) * request.samples.size() : 0) +
                                        (request.planes.samples ? bytes_per_sample * request.samples.size() : 0);
  const std::optional<Crop> crop = rendered_crop(args.options, request.halo);
  const auto width = static_cast<std::uint64_t>(crop ? crop->width : args.options.width);
  const auto height = static_cast<std::uint64_t>(crop ? crop->height : args.options.height);
  const std::uint64_t need = width * height * bytes_per_pixel;
  if (need > args.load.limits.memory)
    throw Error(ErrorKind::Failed,
                fmt::format("{}: a picture of {}x{} needs {} MB of memory, --max-memory allows {} MB", args.input,
                            width, height, need >> 20, args.load.limits.memory >> 20));
}

void count_times(Summary& summary) {
  summary.times.insert(summary.times.end(), {{"prepare", summary.counts.prepare_ms},
                                             {"geometry", summary.counts.geometry_ms},
                                             {"tiles", summary.counts.tiles_ms}});
}

}  // namespace

std::string aov_path(const std::string& output, std::string_view name) {
  if (is_exr(output)) return output;
  return std::filesystem::path(output).replace_extension(fmt::format(".{}.{}", name, is_pfm(output) ? "pfm" : "png"));
}

std::string output_path(const RenderArgs& args, int frame, int layer) {
  const std::string model = std::filesystem::path(args.input).stem().string();
  const std::string picture = frame < 0 ? args.output : frame_name(args.output, frame, model);
  return layer < 0 ? picture : aov_path(picture, args.aovs.at(static_cast<std::size_t>(layer))->name);
}

void check_outputs(const RenderArgs& args) {
  if (args.output == "-" && ::isatty(STDOUT_FILENO) == 1)
    throw Error(ErrorKind::Usage, "a picture will not be written to a terminal");
  const int frame = args.sequence.is_wanted() && has_frame_number(args.output) ? args.sequence.first.value_or(0) : -1;
  for (int layer = -1; layer < static_cast<int>(args.aovs.size()); ++layer)
    check_savable(output_path(args, frame, layer));
}

void check_request(const RenderArgs& args, const Request& request) {
  if (request.is_display_referred && is_linear(args.named_output()))
    throw Error(ErrorKind::Usage,
                fmt::format("--anti-aliasing: {} works on the picture as shown, and {} holds the light "
                            "before that: write a .png, or take a method such as msaa or ssaa",
                            args.method, extension_of(args.named_output())));
  check_memory(args, request);
}

Rendered render_picture(const RenderArgs& args, const Scene& scene, const Camera& camera, Resolver& resolver,
                        const std::string& output, Summary& summary) {
  const DisplayOptions display = display_of(args);
  const Request request = request_of(resolver, args);
  RenderOptions options = args.options;
  options.crop = rendered_crop(args.options, request.halo);
  const bool is_shown = request.resolves_per_pixel && args.bit_depth == 8 && !args.dithers && !is_linear(output);
  if (is_shown) options.shown = &display;
  Frame frame = render_rounds(scene, camera, resolver, request, options, display, &summary.counts);
  count_times(summary);

  const Stopwatch watch;
  Rendered out;
  if (is_shown)
    out.image = std::move(frame.shown);
  else
    finish(args, resolver.resolve(frame), frame, resolver, output, out);
  summary.width = args.options.width, summary.height = args.options.height;
  if (const std::optional<Crop> crop = args.options.crop) {
    const Crop part{crop->x - options.crop->x, crop->y - options.crop->y, crop->width, crop->height};
    if (request.halo > 0) cut_out(out.image, part), cut_out(out.image16, part), cut_out(out.linear, part);
    summary.width = crop->width, summary.height = crop->height;
  }
  // The data passes have no halo, and a later round of a method that asks again has none of them.
  if (!args.aovs.empty() && ((args.options.crop && request.halo > 0) || frame.depth.empty()))
    frame = render(scene, camera, request, args.options);
  out.has_alpha = display.is_transparent || display.background.w < 1;
  add_passes(args, scene, frame, output, out);
  summary.times.emplace_back("display", watch.ms());
  return out;
}

Rendered render_mean(const RenderArgs& args, int count, const std::function<const Scene&(int)>& scene_at,
                     const Camera& camera, Resolver& resolver, Summary& summary) {
  const DisplayOptions display = display_of(args);
  const Request request = resolver.request(0);
  LinearImage sum;
  Frame frame;
  for (int i = 0; i < count; ++i) {
    frame = render_rounds(scene_at(i), camera, resolver, request, args.options, display, &summary.counts);
    LinearImage picture = resolver.resolve(frame);
    if (i == 0) {
      sum = std::move(picture);
      continue;
    }
    const auto values = sum.values();
    std::transform(values.begin(), values.end(), picture.values().begin(), values.begin(),
                   [](const Linear& a, const Linear& b) { return a + b; });
  }
  const float share = 1 / static_cast<float>(count);
  for (Linear& c : sum.values()) c = c * share;
  count_times(summary);

  Rendered out;
  finish(args, std::move(sum), frame, resolver, args.output, out);
  out.has_alpha = display.is_transparent || display.background.w < 1;
  summary.width = args.options.width, summary.height = args.options.height;
  return out;
}

std::vector<std::uint8_t> encode_picture(const Rendered& picture, const std::string& output) {
  const std::string extension = extension_of(output);
  if (extension == ".rgba") return picture.image16.empty() ? raw_of(picture.image) : raw_of(picture.image16);
  if (extension == ".pfm") return encode_pfm(picture.linear);
  if (extension == ".exr") return picture.exr.empty() ? exr_of(picture.linear, {}) : picture.exr;
  if (extension == ".jpg" || extension == ".jpeg") return encode_jpeg(picture.image);
  if (extension == ".webp") return encode_webp(picture.image, picture.has_alpha);
  if (!picture.image16.empty()) return encode_png(picture.image16, {.has_alpha = picture.has_alpha});
  return encode_png(picture.image, {.has_alpha = picture.has_alpha});
}

std::string emptiness(const RenderArgs& args, const RenderCounts& counts) {
  return args.input + (counts.triangles == 0 ? ": there is nothing in it to draw"
                                             : ": nothing of it is in view; see the camera options");
}

}  // namespace zoneplate::cli
