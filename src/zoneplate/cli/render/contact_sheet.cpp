// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/render/environment_file.h"
#include "zoneplate/cli/render/item_process.h"
#include "zoneplate/cli/render/picture.h"
#include "zoneplate/cli/values.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/os/file.h"
#include "zoneplate/report/figure.h"

namespace zoneplate::cli {
namespace {

struct SheetArgs {
  RenderArgs render;  ///< arguments of one cell
  std::string output, title;
  int columns = 0;  ///< 0: the number with which the aspect ratio is closest to 4:3
};

// File names without their folders, if these are distinct.
std::vector<std::string> short_names(const std::vector<std::string>& inputs) {
  std::map<std::string, int> count;
  const auto last = [](const std::string& name) { return name.substr(name.find_last_of('/') + 1); };
  for (const std::string& name : inputs) ++count[last(name)];
  std::vector<std::string> out;
  for (const std::string& name : inputs) out.push_back(count[last(name)] == 1 ? last(name) : name);
  return out;
}

Rgba8Image blank(const SheetArgs& args) {
  return Rgba8Image(args.render.options.width, args.render.options.height, {255, 255, 255, 255});
}

// Runs in the item's process: renders the model's image, as RGBA values.
std::vector<std::uint8_t> render_cell(RenderArgs render, ItemSender& sender) {
  Scene scene;
  within_import_time(render.input, render.load.limits, [&] { scene = load_scene(render.input, render.load); });
  sender.has_read();
  render.view.up = render.up.value_or(scene.up);
  if (is_builtin_scene(render.input) && !scene.cameras.empty()) render.view.index = 0;
  const float aspect = static_cast<float>(render.options.width) / static_cast<float>(render.options.height);
  const Camera camera = choose_camera(scene, render.view, aspect);
  set_look(render, scene);
  Renderer renderer(PreparedScene(std::move(scene)), make_resolver(antialias::methods(), render.method));
  const Rgba8Image picture = renderer.render(camera, settings_of(render, "")).display;
  const auto* first = reinterpret_cast<const std::uint8_t*>(picture.values().data());
  return {first, first + picture.values().size_bytes()};
}

// The studio is prepared here, once for the processes of all models.
void use_studio(RenderArgs& render) {
  render.cache = environment_cache();
  Environments environments;
  environments.complete(render, [&](std::uint64_t key, std::span<const std::uint8_t> bytes) {
    store_environment(environment_path(render.cache, key), bytes);
  });
  render.lighting.studio = [studio = render.lighting.studio()] { return studio; };
}

// A model's image with its name, or an empty image with the error message.
Panel panel_of(const SheetArgs& args, const std::string& input, const std::string& name) {
  try {
    RenderArgs render = args.render;
    render.input = input;
    ItemProcess process({.name = input,
                         .load = render.load.limits,
                         .seconds = render.max_seconds,
                         .is_sandboxed = uses_sandbox(render.is_sandboxed),
                         .readable = readable_paths(input, render.load)},
                        1, [&](std::size_t, ItemSender& sender) { return render_cell(render, sender); });
    const std::vector<std::uint8_t> codes = process.next({});
    Rgba8Image image = blank(args);
    if (codes.size() != image.values().size_bytes())
      throw Error(ErrorKind::Failed, input + ": an image of a wrong size");
    std::memcpy(image.values().data(), codes.data(), codes.size());
    return {std::move(image), name};
  } catch (const std::exception& error) {
    std::string cause = error.what();
    if (cause.starts_with(input + ": ")) cause = cause.substr(input.size() + 2);
    return {blank(args), name + "\n" + cause};
  }
}

int columns_for(const SheetArgs& args, std::size_t count) {
  if (args.columns > 0) return args.columns;
  const double shape = static_cast<double>(args.render.options.height + 40) / (args.render.options.width + 16);
  int columns = 1;
  while (static_cast<double>(columns) / (static_cast<double>(count) / columns * shape) < 4.0 / 3) ++columns;
  return std::min<int>(columns, static_cast<int>(count));
}

Figure lay_out(const SheetArgs& args, std::vector<Panel> panels) {
  Figure figure{.title = args.title};
  const auto columns = static_cast<std::size_t>(columns_for(args, panels.size()));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    if (i % columns == 0) figure.rows.emplace_back();
    figure.rows.back().push_back(std::move(panels[i]));
  }
  return figure;
}

Syntax make_syntax(SheetArgs& args) {
  Syntax syntax{
      .verb = "contact-sheet",
      .summary = "Render many models into one image, with their names",
      .operands = "FILES... -o OUT",
      .examples =
          "  zoneplate contact-sheet models/*.glb -o sheet.png\n"
          "  zoneplate contact-sheet a.stl b.ply teapot -o sheet.png --size 320x240 --columns 3\n",
      .notes = "A model that cannot be rendered shows its error message instead; the sheet is written anyway.\n"};
  syntax.options = {
      {"--output,-o", "OUT", "Image to write: .png, .jpg or .webp, or - for stdout", "Options", true,
       [&](auto& text) { args.output = text; }},
      {"--resolution,--size", "W,H", "Size of each model's image; default 200,150", "Options", true,
       [&](auto& text) {
         const int2 size = parse_size(text, 4096);
         args.render.options.width = size.x, args.render.options.height = size.y;
       }},
      {"--columns", "N", "Images per row; default: the number that makes the sheet closest to 4:3", "Options", true,
       [&](auto& text) { args.columns = parse_whole(text, 1, 1000); }},
      {"--title", "TEXT", "Title of the sheet", "Options", false, [&](auto& text) { args.title = text; }},
      {"--anti-aliasing,--aa", "METHOD", "Antialiasing method, as for render; default msaa:n=8", "Options", false,
       [&](auto& text) { args.render.method = text; }},
      {"--background-color,--background", "COLOR", "Background colour; default #444444", "Options", false,
       [&](auto& text) { args.render.background = parse_color(text); }},
      {"--max-memory", "BYTES", "Memory limit of one model and its image, for example 512M; default 4G", "Options",
       false, [&](auto& text) { args.render.load.limits.memory = parse_bytes(text); }},
      {"--max-import-seconds", "S", "Time limit of reading a model; default 60", "Options", false,
       [&](auto& text) { args.render.load.limits.seconds = parse_number(text, 0.001, 1e6); }},
      {"--max-seconds", "S", "Time limit of a model; default: no limit", "Options", false,
       [&](auto& text) { args.render.max_seconds = parse_number(text, 0.001, 1e9); }},
      {"--sandbox", "", "Read and render in sandboxed processes: the default", "Options", false,
       [&](auto&) { args.render.is_sandboxed = true; }},
      {"--no-sandbox", "", "Read and render without a sandbox, with all rights of the user: for trusted models",
       "Options", false, [&](auto&) { args.render.is_sandboxed = false; }},
      {"--threads,-t", "N", "Maximum number of threads; default 0: all that affinity and CPU quota allow", "Options",
       false, [&](auto& text) { args.render.threads = parse_whole(text, 0, 1024); }}};
  return syntax;
}

}  // namespace

void run_contact_sheet(std::span<const std::string> arguments) {
  SheetArgs args;
  args.render.options.width = 200, args.render.options.height = 150;
  args.render.background = float4{0.267f, 0.267f, 0.267f, 1};
  args.render.options.point_size = 3, args.render.options.line_width = 1.5f;  // single pixels would hardly be visible
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (syntax.found_operands.empty()) throw Error(ErrorKind::Usage, "no input: give models or built-in scenes");
  if (args.output.empty()) throw Error(ErrorKind::Usage, "no output: give -o OUT.png");
  static_cast<void>(make_resolver(antialias::methods(), args.render.method));
  check_picture_ending(args.output);
  if (const std::string ending = extension_of(args.output); ending == ".pfm" || ending == ".exr")
    throw Error(ErrorKind::Usage, "--output: a contact sheet is display-referred: .png, .jpg, .webp or .rgba");
  args.render.output = args.output;
  check_outputs(args.render);

  const std::vector<std::string> names = short_names(syntax.found_operands);
  std::vector<Panel> panels;
  Rendered sheet;
  with_threads(args.render.threads, [&] {
    use_studio(args.render);
    for (std::size_t i = 0; i < names.size(); ++i) panels.push_back(panel_of(args, syntax.found_operands[i], names[i]));
    sheet.image = compose(lay_out(args, std::move(panels)), {.text_px = 12, .gap_px = 10});
  });
  save_bytes(args.output, encode_picture(sheet, args.output));
}

}  // namespace zoneplate::cli
