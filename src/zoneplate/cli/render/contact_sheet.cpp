// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/batch/contact_sheet.h"
#include "zoneplate/batch/input_names.h"
#include "zoneplate/batch/item_files.h"
#include "zoneplate/cli/render/args.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/os/file.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/report/json.h"
#include "zoneplate/report/report_version.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::cli {
namespace {

struct SheetArgs : ContactSheet {
  RenderArgs render;  ///< arguments of one cell
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

  const std::vector<std::string> inputs = with_folders_listed(syntax.found_operands, say_warning);
  const std::vector<std::string> names = short_names(inputs);
  for (const std::string& input : inputs) {
    args.render.input = input;
    check_own_files(args.render);
  }
  check_memory(args, args.render, names.size());
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
      BatchItem item = args.render;
      item.input = inputs[i];
      SheetCell cell = render_cell(item, names[i], say_warning);
      if (!cell.error.empty()) say_error(cell.error);
      failed += !cell.failure.empty();
      Json::Object row{{"input", inputs[i]}, {"status", cell.failure.empty() ? "done" : "failed"}};
      if (!cell.failure.empty()) row.emplace_back("error", cell.failure);
      items.emplace_back(std::move(row));
      panels.push_back(std::move(cell.panel));
    }
    progress.clear();
    sheet.image = compose(lay_out(args, args.render, std::move(panels)), {.text_px = 12, .gap_px = 10});
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
