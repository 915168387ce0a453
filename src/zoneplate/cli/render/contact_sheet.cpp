// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>
#include <new>

#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/base/size_text.h"
#include "zoneplate/cli/batch/input_names.h"
#include "zoneplate/cli/process/item_process.h"
#include "zoneplate/cli/render/environment_cache.h"
#include "zoneplate/cli/render/item_files.h"
#include "zoneplate/cli/report_version.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/job/environment_file.h"
#include "zoneplate/job/import_time.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/job/resolve.h"
#include "zoneplate/job/values.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/metering/metering.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/report/json.h"
#include "zoneplate/upscale/upscaler.h"

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

// The image in place of a model that failed: a frame with its diagonals.
Rgba8Image placeholder(const SheetArgs& args) {
  const int width = args.render.options.width, height = args.render.options.height;
  Rgba8Image image(width, height, {250, 250, 250, 255});
  constexpr Rgba8 grey = {190, 190, 190, 255};
  const auto draw_line = [&](int x0, int y0, int x1, int y1) {
    const int steps = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
    for (int i = 0; i <= steps; ++i)
      image(x0 + (x1 - x0) * i / std::max(steps, 1), y0 + (y1 - y0) * i / std::max(steps, 1)) = grey;
  };
  const int right = width - 1, bottom = height - 1;
  draw_line(0, 0, right, 0), draw_line(0, bottom, right, bottom);
  draw_line(0, 0, 0, bottom), draw_line(right, 0, right, bottom);
  draw_line(0, 0, right, bottom), draw_line(0, bottom, right, 0);
  return image;
}

// Runs in the item's process: renders the model's image, as RGBA values.
std::vector<std::uint8_t> render_cell(RenderArgs render, ItemSender& sender) {
  Scene scene;
  Environments environments;
  if (!render.hdri_file.empty()) complete_environments(environments, render, {}, sender);
  within_import_time(render.input, render.load.limits, [&] { scene = load_scene(render.input, render.load); });
  sender.has_read();
  convert_materials(render, scene);
  const LitStill still = light_still(render, PreparedScene(std::move(scene), render.mips), false);
  if (!still.warning.empty()) sender.text(TextKind::Warning, still.warning);
  Renderer renderer(still.scene, upscale::make_method(render.method));
  const Rgba8Image picture = renderer.render_still(still.camera, settings_of(still.job, "")).display;
  const auto* first = reinterpret_cast<const std::uint8_t*>(picture.values().data());
  return {first, first + picture.values().size_bytes()};
}

// The studio is prepared here, once for the processes of all models.
void use_studio(RenderArgs& render) {
  render.cache = environment_cache();
  Environments environments;
  environments.complete(render, [&](std::uint64_t key, std::span<const std::uint8_t> bytes) {
    store_environment(render.cache, key, bytes);
  });
  render.lighting.studio = [studio = render.lighting.studio()] { return studio; };
}

struct Cell {
  Panel panel;
  std::string failure;  ///< the cause, if the model's image is missing
};

// A model's image with its name, or the error message in its place.
Cell cell_of(const SheetArgs& args, const std::string& input, const std::string& name) {
  try {
    RenderArgs render = args.render;
    render.input = input;
    std::vector<std::string> readable = readable_paths(input, render.load);
    for (std::string& path : environment_files(render)) readable.push_back(std::move(path));
    for (std::string& path : render.default_material.files()) readable.push_back(std::move(path));
    ItemProcess process({.name = input,
                         .load = render.load.limits,
                         .seconds = render.max_seconds,
                         .is_sandboxed = uses_sandbox(render.is_sandboxed),
                         .readable = std::move(readable)},
                        1, [&](std::size_t, ItemSender& sender) { return render_cell(render, sender); });
    ItemEvents events;
    events.text = [](TextKind, const std::string& warning) { say_warning(warning); };
    const std::vector<std::uint8_t> codes = process.next(events);
    Rgba8Image image(render.options.width, render.options.height);
    if (codes.size() != image.values().size_bytes())
      throw Error(ErrorKind::Failed, input + ": an image of a wrong size");
    std::memcpy(image.values().data(), codes.data(), codes.size());
    return {{std::move(image), name}};
  } catch (const std::exception& error) {
    say_error(dynamic_cast<const std::bad_alloc*>(&error) ? input + ": out of memory" : error.what());
    std::string cause = error.what();
    if (cause.starts_with(input + ": ")) cause = cause.substr(input.size() + 2);
    return {{placeholder(args), name + "\n" + cause}, cause};
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

/// The memory of all images, the sheet and its encoding, before anything is rendered.
void check_memory(const SheetArgs& args, std::size_t count) {
  const std::uint64_t width = static_cast<std::uint64_t>(args.render.options.width),
                      height = static_cast<std::uint64_t>(args.render.options.height);
  const std::uint64_t columns = static_cast<std::uint64_t>(columns_for(args, count));
  const std::uint64_t places = columns * ((count + columns - 1) / columns);
  constexpr std::uint64_t copies = 3;  // of the sheet: the sheet, its filtered rows, and their compression
  const std::uint64_t need = (count + copies * places) * width * height * sizeof(Rgba8);
  const std::uint64_t limit = args.render.load.limits.memory;
  if (need > limit)
    throw Error(ErrorKind::Failed,
                fmt::format("{}: a sheet of {} images of {}x{} needs {} of memory, --max-memory allows {}", args.output,
                            count, width, height, size_text(need), size_text(limit)));
}

Syntax make_syntax(SheetArgs& args) {
  Syntax syntax{.verb = "contact-sheet",
                .summary = "Render many models into one image, with their names",
                .operands = "FILES... -o OUT",
                .examples =
                    "  zoneplate contact-sheet models/*.glb -o sheet.png\n"
                    "  zoneplate contact-sheet a.stl b.ply teapot -o sheet.png --size 320x240 --columns 3\n",
                .notes =
                    "A model that cannot be rendered has its error message instead of an image; the sheet is written "
                    "anyway, and the\n"
                    "exit code is 5.\n"};
  syntax.options = {{"--output,-o", "OUT", "Image to write: .png, .jpg or .webp, or - for stdout", "Sheet", true,
                     [&](auto& text) { args.output = text; }},
                    {"--columns", "N", "Images per row; default: the number that makes the sheet closest to 4:3",
                     "Sheet", true, [&](auto& text) { args.columns = parse_whole(text, 1, 1000); }},
                    {"--title", "TEXT", "Title of the sheet", "Sheet", false, [&](auto& text) { args.title = text; }}};
  constexpr std::string_view left_out[] = {"--output",       "--output-format",   "--bit-depth",    "--crop",
                                           "--aov",          "--no-background",   "--opaque-glass", "--verbose",
                                           "--displacement", "--exr-compression", "--preset",       "--no-config",
                                           "--dry-run"};
  for (Option& option : render_syntax(args.render).options) {
    const std::string first = option.names.substr(0, option.names.find(','));
    if (option.group == "Sequences" || option.group == "Batches") continue;
    if (std::ranges::find(left_out, first) != std::end(left_out)) continue;
    if (first == "--resolution") option.meaning = "Size of each model's image, 200x150 or 200; default 200,150";
    if (first == "--background-color") option.meaning = "Background colour of each image; default #444444";
    if (first == "--json") option.meaning = "Print a report with the state of every model as one line of JSON";
    syntax.options.push_back(std::move(option));
  }
  return syntax;
}

}  // namespace

void run_contact_sheet(std::span<const std::string> arguments) {
  SheetArgs args;
  args.render.options.width = 200, args.render.options.height = 150;
  args.render.background = float4{0.267f, 0.267f, 0.267f, 1};
  args.render.point_size = 3, args.render.options.line_width = 1.5f;  // single pixels would hardly be visible
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (syntax.found_operands.empty()) throw Error(ErrorKind::Usage, "no input: give models or built-in scenes");
  if (args.output.empty()) throw Error(ErrorKind::Usage, "no output: give -o OUT.png");
  args.render.output = args.output;
  check_args(args.render);
  static_cast<void>(upscale::make_method(args.render.method));
  if (const std::string ending = extension_of(args.output); ending == ".pfm" || ending == ".exr")
    throw Error(ErrorKind::Usage, "--output: a contact sheet is display-referred: .png, .jpg, .webp or .rgba");
  check_outputs(args.render);

  const std::vector<std::string> inputs = with_folders_listed(syntax.found_operands);
  const std::vector<std::string> names = short_names(inputs);
  for (const std::string& input : inputs) {
    args.render.input = input;
    check_own_files(args.render);
  }
  check_memory(args, names.size());
  std::vector<Panel> panels;
  Rendered sheet;
  std::size_t failed = 0;
  Json::Array items;
  const auto render_all = [&] {
    if (args.render.hdri_file.empty()) use_studio(args.render);
    Progress progress(args.render.verbosity == Verbosity::Quiet ? ProgressKind::None
                      : args.render.progress                    ? *args.render.progress
                                                                : parse_progress("auto"));
    for (std::size_t i = 0; i < names.size(); ++i) {
      progress.begin(fmt::format("{} of {}: {}", i + 1, names.size(), names[i]),
                     static_cast<double>(i) / static_cast<double>(names.size()));
      Cell cell = cell_of(args, inputs[i], names[i]);
      failed += !cell.failure.empty();
      Json::Object item{{"input", inputs[i]}, {"status", cell.failure.empty() ? "done" : "failed"}};
      if (!cell.failure.empty()) item.emplace_back("error", cell.failure);
      items.emplace_back(std::move(item));
      panels.push_back(std::move(cell.panel));
    }
    progress.clear();
    sheet.image = compose(lay_out(args, std::move(panels)), {.text_px = 12, .gap_px = 10});
  };
  with_isa(args.render.isa, [&] { with_threads(args.render.threads, render_all); });
  save_bytes(args.output, encode_picture(sheet, args.output, args.render.file));
  if (args.render.prints_json)
    print_report(Json(Json::Object{{"format", "zoneplate-contact-sheet"},
                                   {"version", report_version},
                                   {"output", args.output},
                                   {"items", std::move(items)}})
                         .text() +
                     '\n',
                 args.output == "-");
  if (failed > 0) throw PartialFailure(fmt::format("{} of {} models failed", failed, names.size()));
}

}  // namespace zoneplate::cli
