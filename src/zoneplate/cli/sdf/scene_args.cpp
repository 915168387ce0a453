// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/sdf/scene_args.h"

#include <fmt/format.h>

#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

constexpr int max_side = 32768;

}  // namespace

std::vector<Option> shape_scene_options(ShapeSceneOptions& args) {
  return {{"--size", "WxH", "Size of the image; the scene is scaled to fit and centred", "Options", true,
           [&](auto& text) { args.size = parse_size(text, max_side); }},
          {"--scale", "S", "Pixels per unit of the scene; default 1", "Options", true,
           [&](auto& text) { args.scale = parse_number(text, 1e-3, 1e3); }},
          {"--font", "FILE", "TrueType or OpenType font of `text`; default DejaVu Sans", "Options", false,
           [&](auto& text) { args.font = text; }}};
}

std::vector<Option> field_view_options(FieldViewArgs& args, const std::string& unit) {
  return {{"--show", "VIEW", "View of the field in a .png: field, isolines or gradient; default field", "Options", true,
           [&args](const std::string& text) {
             constexpr FieldView views[] = {FieldView::Field, FieldView::Isolines, FieldView::Gradient};
             args.view = views[parse_choice(text, {"field", "isolines", "gradient"})];
           }},
          {"--spacing", "D", "Distance between isolines in " + unit + "; default 10", "Options", true,
           [&args](const std::string& text) { args.spacing = parse_number(text, 1e-3, 1e6); }}};
}

std::string shape_scene_notes() {
  std::string text =
      "SCENE is a file, or - for stdin, in a small language or in JSON. A unit is a pixel; x points to the\n"
      "right, y downwards. Layers are painted in order:\n"
      "\n"
      "  canvas 640 480  background #ffffff         // without a canvas: the shapes and a margin\n"
      "  let eye = circle(320, 240, 60)\n"
      "  fill #d55e00 smooth-union(20, eye, rectangle(420, 240, 120, 40))\n"
      "  stroke #000000 2 eye\n"
      "\n"
      "The same as JSON:\n"
      "\n"
      "  {\"canvas\": [640, 480], \"background\": \"#ffffff\",\n"
      "   \"let\": {\"eye\": {\"circle\": [320, 240, 60]}},\n"
      "   \"layers\": [{\"fill\": \"#d55e00\", \"shape\": {\"smooth-union\":\n"
      "               [20, {\"eye\": []}, {\"rectangle\": [420, 240, 120, 40]}]}},\n"
      "              {\"stroke\": \"#000000\", \"width\": 2, \"shape\": {\"eye\": []}}]}\n"
      "\n"
      "Shapes and operations:\n";
  for (const sdf::ShapeWord& word : sdf::shape_words()) {
    std::string parameters;
    for (const char c : word.parameters)
      if (c == ' ')
        parameters += ", ";
      else if (c != '+' && c != '*' && c != '#')
        parameters += c;
    text += fmt::format("  {:<46}{}\n", fmt::format("{}({})", word.name, parameters), word.summary);
  }
  return text;
}

}  // namespace zoneplate::cli
