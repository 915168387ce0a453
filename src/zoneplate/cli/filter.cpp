// SPDX-License-Identifier: Apache-2.0
// zoneplate filter: post-process antialiasing of existing images, without a scene.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <optional>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/progress.h"
#include "zoneplate/cli/values.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/picture_file.h"
#include "zoneplate/os/file.h"

namespace zoneplate::cli {
namespace {

namespace fs = std::filesystem;

struct FilterArgs {
  std::string output, method;
  int bit_depth = 8, threads = 0;
  std::optional<ProgressKind> progress;  ///< none: a bar on a terminal
};

/// True for a method that only needs the display-referred image of a frame.
bool reads_image_alone(Resolver& method) {
  const Request request = method.request({});
  return request.is_display_referred && request.samples.size() == 1 && !request.draw && !request.planes.any();
}

std::string filter_names() {
  std::string names;
  for (const Method& method : antialias::methods())
    if (reads_image_alone(*make_resolver(antialias::methods(), method.name)))
      names += fmt::format("{}{}", names.empty() ? "" : ", ", method.name);
  return names;
}

std::unique_ptr<Resolver> make_filter(const std::string& method) {
  if (method.empty()) throw Error(ErrorKind::Usage, "--anti-aliasing is missing: one of " + filter_names());
  std::unique_ptr<Resolver> filter = make_resolver(antialias::methods(), method);
  if (!reads_image_alone(*filter))
    throw Error(ErrorKind::Usage, fmt::format("--anti-aliasing: {} needs a scene, expected a filter of images: {}",
                                              method, filter_names()));
  return filter;
}

struct FilterItem {
  std::string input, output;
};

/// The images of the operand, and the output file of each.
///
/// Errors    ErrorKind::Usage if two images have the same output file.
std::vector<FilterItem> plan(const std::string& operand, const std::string& output) {
  const std::vector<std::string> inputs = metrics::list_pictures(operand);
  if (inputs.size() == 1 && inputs.front() == operand) return {{operand, output}};
  std::vector<FilterItem> items;
  std::map<std::string, std::string> input_of;  // maps an output to its input
  for (const std::string& input : inputs) {
    items.push_back({input, (fs::path(output) / fs::path(input).stem()).string() + ".png"});
    const auto [first, is_new] = input_of.emplace(items.back().output, input);
    if (!is_new)
      throw Error(ErrorKind::Usage,
                  fmt::format("--output: {} and {} would both be written to {}", first->second, input, first->first));
  }
  return items;
}

void filter_image(const FilterItem& item, Resolver& filter, int bit_depth) {
  metrics::Picture picture = metrics::load_picture(item.input);
  if (picture.is_scene_linear)
    throw Error(ErrorKind::Input,
                item.input + ": is a scene-linear image, expected a display-referred one (PNG, JPEG or WebP)");
  const DisplayImage image = filter.post_process(std::move(picture.display), Frame());
  if (bit_depth == 8) return save_image(item.output, quantize8(image));
  save_bytes(item.output, encode_png(quantize16(image)));
}

Syntax make_syntax(FilterArgs& args) {
  Syntax syntax{
      .verb = "filter",
      .summary = "Antialias existing images by a post-process filter",
      .operands = "IMAGES",
      .examples =
          "  zoneplate filter shot.png --aa smaa -o smooth.png\n"
          "  zoneplate filter shot.png --aa fxaa:preset=39,mix=light -o smooth.webp\n"
          "  zoneplate filter shots/ --aa cmaa2 -o smooth/\n"
          "  zoneplate filter frames/a.####.png --aa mlaa -o smooth/\n",
      .notes =
          "IMAGES is a PNG, JPEG or WebP file, a folder of them, or a sequence (name.####.png, name.%04d.png).\n"
          "Filters work on 8-bit sRGB values. Pixels that the filter does not blend keep their exact value;\n"
          "images with alpha are filtered premultiplied.\n"};
  syntax.options = {
      {"--output,-o", "FILE",
       "The image to write: .png, .jpg or .webp; for several inputs a folder, which receives .png files", "Options",
       true, [&](auto& text) { args.output = text; }},
      {"--anti-aliasing,--aa", "METHOD", "Filter, such as smaa or fxaa:preset=39: one of " + filter_names(), "Options",
       true, [&](auto& text) { args.method = text; }},
      {"--bit-depth", "N", "Bits per channel of .png: 8, the default, or 16", "Options", false,
       [&](auto& text) {
         args.bit_depth = parse_choice(text, {"8", "16"}) == 0 ? 8 : 16;
       }},
      {"--threads,-t", "N", "Maximum number of threads; 0, the default: the CPUs allowed by affinity and quota",
       "Options", false, [&](auto& text) { args.threads = parse_whole(text, 0, 1024); }},
      {"--progress", "KIND", "Progress on stderr: auto (a bar on a terminal), bar, json (one line per image) or none",
       "Options", false, [&](auto& text) { args.progress = parse_progress(text); }}};
  return syntax;
}

}  // namespace

void run_filter(std::span<const std::string> arguments) {
  FilterArgs args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (syntax.found_operands.size() != 1)
    throw Error(ErrorKind::Usage, "filter takes one input: an image, a folder or a sequence");
  if (args.output.empty()) throw Error(ErrorKind::Usage, "no output: name a file or folder with -o");
  const std::unique_ptr<Resolver> filter = make_filter(args.method);
  const std::vector<FilterItem> items = plan(syntax.found_operands.front(), args.output);
  if (items.front().output != args.output) {
    std::error_code error;
    fs::create_directories(args.output, error);
    if (error) throw Error(ErrorKind::Output, args.output + ": " + error.message());
  }
  for (const FilterItem& item : items) check_savable(item.output);
  if (args.bit_depth == 16 && extension_of(items.front().output) != ".png")
    throw Error(ErrorKind::Usage, "--bit-depth 16 is for .png, not " + items.front().output);
  with_threads(args.threads, [&] {
    Progress progress(args.progress ? *args.progress : parse_progress("auto"));
    double done = 0;
    for (const FilterItem& item : items) {
      progress.begin(item.input, done++ / static_cast<double>(items.size()));
      filter_image(item, *filter, args.bit_depth);
    }
  });
}

}  // namespace zoneplate::cli
