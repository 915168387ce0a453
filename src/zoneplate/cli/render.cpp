#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/file.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/render_args.h"
#include "zoneplate/cli/usage.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/image/png.h"
#include "zoneplate/render/picture.h"
#include "zoneplate/report/json.h"
#include "zoneplate/scene/load.h"

namespace zoneplate::cli {
namespace {

// A file of the result, ready to be written.
struct OutputFile {
  std::string path;
  std::vector<std::uint8_t> bytes;
};

// What is told about a run. Times are in milliseconds, in the order of the work.
struct Summary {
  int width = 0, height = 0, threads = 0;
  RenderCounts counts;
  std::vector<std::pair<std::string, double>> times;
  std::vector<std::string> warnings;
};

// Fails at once, not after a long render, where the picture can never be written.
void check_writable(const std::string& output) {
  if (output == "-") {
    if (::isatty(STDOUT_FILENO) == 1) throw Error(Trouble::Usage, "a PNG will not be written to a terminal");
    return;
  }
  const std::filesystem::path path(output);
  const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(Trouble::Output, fmt::format("{}: {}: {}", output, folder, std::strerror(errno)));
}

// What is rendered for a crop: so much more around it as the method looks at, within the picture.
std::optional<Crop> rendered_crop(const RenderOptions& options, int halo) {
  if (!options.crop) return std::nullopt;
  const Crop c = *options.crop;
  const int left = std::min(halo, c.x), top = std::min(halo, c.y);
  return Crop{c.x - left, c.y - top, left + c.width + std::min(halo, options.width - c.x - c.width),
              top + c.height + std::min(halo, options.height - c.y - c.height)};
}

// The planes of a frame and its copies on the way to a file, in bytes a pixel: see Frame, DisplayImage, Rgba8Image.
void check_memory(const RenderArgs& args, const Request& request) {
  constexpr std::uint64_t bytes_per_sample = 24;  // where every sample is stored: colour, depth, triangle
  const std::uint64_t bytes_per_pixel =
      (args.aovs.empty() ? 44 : 104) + (request.planes.samples ? bytes_per_sample * request.samples.size() : 0);
  const std::optional<Crop> crop = rendered_crop(args.options, request.halo);
  const auto width = static_cast<std::uint64_t>(crop ? crop->width : args.options.width);
  const auto height = static_cast<std::uint64_t>(crop ? crop->height : args.options.height);
  const std::uint64_t need = width * height * bytes_per_pixel;
  if (need > args.limits.memory)
    throw Error(Trouble::Usage, fmt::format("a picture of {}x{} needs {} MB, --max-memory allows {} MB", width, height,
                                            need >> 20, args.limits.memory >> 20));
}

// "#333333", as F3D shows models by default; the homework's scene is defined on black.
float4 background_of(const RenderArgs& args) {
  if (args.background) return *args.background;
  return args.input == "triangles" ? float4{0, 0, 0, 1} : float4{0.2f, 0.2f, 0.2f, 1};
}

// "chair.png" and "depth" give "chair.depth.png".
std::string aov_path(const std::string& output, std::string_view name) {
  return std::filesystem::path(output).replace_extension(fmt::format(".{}.png", name)).string();
}

Request request_of(Resolver& resolver, const RenderArgs& args) {
  Request request = resolver.ask(0);
  for (const Aov* aov : args.aovs) request.planes.*(aov->plane) = request.planes.depth = true;
  if (request.planes.error && !request.estimates_error)
    throw Error(Trouble::Usage, "--aov error: " + args.method + " has no estimate of its error; converged has");
  return request;
}

Rgba8Image part_of(const Rgba8Image& image, const Crop& part) {
  Rgba8Image out(part.width, part.height);
  for (int y = 0; y < part.height; ++y)
    std::ranges::copy_n(image.row(part.y + y).begin() + part.x, part.width, out.row(y).begin());
  return out;
}

std::vector<OutputFile> make_files(const RenderArgs& args, const Scene& scene, const Camera& camera, Resolver& resolver,
                                   Progress& progress, Summary& summary) {
  progress.begin("render", 0.2);
  DisplayOptions display = args.display;
  display.background = background_of(args);
  const Request request = request_of(resolver, args);
  RenderOptions options = args.options;
  options.crop = rendered_crop(args.options, request.halo);
  options.display = &display;
  if (request.is_local) options.shown = &display;
  Frame frame = render_rounds(scene, camera, resolver, request, options, display, &summary.counts);
  summary.times.insert(summary.times.end(), {{"prepare", summary.counts.prepare_ms},
                                             {"geometry", summary.counts.geometry_ms},
                                             {"tiles", summary.counts.tiles_ms}});

  Stopwatch display_watch;
  Rgba8Image image = show(resolver, frame);
  if (const std::optional<Crop> crop = args.options.crop; crop && request.halo > 0)
    image = part_of(image, {crop->x - options.crop->x, crop->y - options.crop->y, crop->width, crop->height});
  // The data passes have no halo, and a later round of a method that asks again has none of them.
  if (!args.aovs.empty() && ((args.options.crop && request.halo > 0) || frame.depth.empty()))
    frame = render(scene, camera, request, args.options);
  summary.width = image.width(), summary.height = image.height();
  summary.times.emplace_back("display", display_watch.ms());

  progress.begin("encode", 0.8);
  Stopwatch encode_watch;
  const bool has_alpha = args.display.is_transparent || display.background.w < 1;
  std::vector<OutputFile> files{{args.output, encode_png(image, {.has_alpha = has_alpha})}};
  for (const Aov* aov : args.aovs) files.push_back({aov_path(args.output, aov->name), aov->encode(frame)});
  summary.times.emplace_back("encode", encode_watch.ms());
  return files;
}

// A picture of nothing is never given without a word.
std::string emptiness(const RenderArgs& args, const RenderCounts& counts) {
  return args.input + (counts.triangles == 0 ? ": there is nothing in it to draw"
                                             : ": nothing of it is in view; see the camera options");
}

Json summary_json(const RenderArgs& args, const Summary& summary) {
  Json::Object times, layers;
  for (const auto& [name, ms] : summary.times) times.emplace_back(name, ms);
  for (const Aov* aov : args.aovs) layers.emplace_back(aov->name, aov_path(args.output, aov->name));
  return Json::Object{{"input", args.input},
                      {"output", args.output},
                      {"layers", std::move(layers)},
                      {"width", summary.width},
                      {"height", summary.height},
                      {"method", args.method},
                      {"triangles", summary.counts.triangles},
                      {"triangles_set_up", summary.counts.triangles_set_up},
                      {"shaded", summary.counts.shaded},
                      {"threads", summary.threads},
                      {"isa", name_of(args.options.isa)},
                      {"ms", std::move(times)},
                      {"peak_memory_bytes", peak_memory()},
                      {"warnings", Json::Array(summary.warnings.begin(), summary.warnings.end())}};
}

void tell(const RenderArgs& args, const Summary& summary) {
  if (args.verbosity == Verbosity::Verbose) {
    std::string times;
    for (const auto& [name, ms] : summary.times) times += fmt::format("{} {:.1f} ms, ", name, ms);
    say_note(fmt::format("{}: {}x{}, {}, {} triangles, {} threads, {}", args.output, summary.width, summary.height,
                         args.method, summary.counts.triangles, summary.threads, name_of(args.options.isa)));
    say_note(fmt::format("{}{} MB at most", times, peak_memory() >> 20));
  }
  if (!args.wants_json) return;
  const std::string line = summary_json(args, summary).text() + '\n';
  if (args.output == "-")
    std::fwrite(line.data(), 1, line.size(), stderr);
  else
    print(line);
}

}  // namespace

void run_render(std::span<const std::string> arguments) {
  const std::optional<RenderArgs> parsed = parse_render_args(arguments);
  if (!parsed) return;
  RenderArgs args = *parsed;
  const std::unique_ptr<Resolver> resolver = make_resolver(antialias::methods(), args.method);
  check_writable(args.output);
  check_memory(args, resolver->ask(0));
  if (args.verbosity == Verbosity::Quiet && !args.progress) args.progress = ProgressKind::None;

  const Stopwatch total_watch;
  Summary summary;
  std::vector<OutputFile> files;
  with_threads(args.threads, [&] {
    Progress progress(args.progress ? *args.progress : parse_progress("auto"));
    progress.begin("read", 0);
    summary.threads = thread_limit();
    const Stopwatch read_watch;
    Scene scene = load_scene(args.input, args.limits);
    summary.times.emplace_back("read", read_watch.ms());

    const bool has_own_view = is_builtin_scene(args.input) && !scene.cameras.empty();
    if (has_own_view && !args.view.index && !args.view.position) args.view.index = 0;
    const float aspect = static_cast<float>(args.options.width) / static_cast<float>(args.options.height);
    const Camera camera = choose_camera(scene, args.view, aspect);
    args.options.environment = apply_look(scene, camera, args.look);
    summary.warnings = scene.warnings;
    files = make_files(args, scene, camera, *resolver, progress, summary);
    if (summary.counts.triangles_set_up == 0) summary.warnings.push_back(emptiness(args, summary.counts));

    progress.begin("write", 0.95);
    const Stopwatch write_watch;
    for (const OutputFile& file : files) save_bytes(file.path, file.bytes);
    summary.times.emplace_back("write", write_watch.ms());
  });
  summary.times.emplace_back("total", total_watch.ms());

  if (args.verbosity != Verbosity::Quiet)
    for (const std::string& warning : summary.warnings) say_warning(warning);
  tell(args, summary);
}

}  // namespace zoneplate::cli
