// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "zoneplate/base/error.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/formats/assimp/assimp.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/job/option_values.h"
#include "zoneplate/job/output/aov_file.h"
#include "zoneplate/report/json.h"
#include "zoneplate/report/report_version.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/texture_filter.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::cli {
namespace {

// The values of a parameter and its default: "n=2|4|8|16 (4)", "samples=1..256 (16)", "pattern=grid|halton (grid)".
std::string range_of(const Param& param) {
  if (!param.names.empty())
    return fmt::format("{}={} ({})", param.name, fmt::join(param.names, "|"),
                       param.names[static_cast<std::size_t>(param.value)]);
  if (!param.choices.empty()) return fmt::format("{}={} ({})", param.name, fmt::join(param.choices, "|"), param.value);
  return fmt::format("{}={}..{} ({})", param.name, param.low, param.high, param.value);
}

/// The rows of a catalogue of methods or upscalers.
template <class Row>
std::string catalogue_text(std::string text, std::span<const Row> rows) {
  for (const Row& method : rows) {
    text += fmt::format("  {:<16}{} [{}{}]\n", method.name, method.summary, method.source,
                        method.is_specification_only ? "; specification only" : "");
    for (const Param& param : method.params)
      text += fmt::format("  {:<16}  {}  {}\n", "", range_of(param), param.meaning);
  }
  return text;
}

std::string methods_text() {
  return catalogue_text("Antialiasing methods (--anti-aliasing NAME:PARAMETER=VALUE,...):\n", method_catalogue());
}

std::string upscalers_text() {
  return catalogue_text("Upscalers (--upscale NAME:PARAMETER=VALUE,...):\n", upscale::upscalers());
}

template <class Row>
Json catalogue_json(std::span<const Row> catalogue) {
  Json::Array rows;
  for (const Row& method : catalogue) {
    Json::Array params;
    for (const Param& param : method.params) {
      Json::Object row{{"name", param.name}, {"meaning", param.meaning}};
      if (!param.names.empty()) {
        row.emplace_back("default", param.names[static_cast<std::size_t>(param.value)]);
        row.emplace_back("values", Json::Array(param.names.begin(), param.names.end()));
      } else {
        const auto value = [&](double v) { return param.decimals == 0 ? Json(static_cast<int>(v)) : Json(v); };
        row.emplace_back("default", value(param.value));
        if (param.choices.empty()) {
          row.emplace_back("low", value(param.low));
          row.emplace_back("high", value(param.high));
        } else {
          row.emplace_back("values", Json::Array(param.choices.begin(), param.choices.end()));
        }
      }
      params.emplace_back(std::move(row));
    }
    rows.emplace_back(Json::Object{{"name", method.name},
                                   {"summary", method.summary},
                                   {"source", method.source},
                                   {"specification_only", method.is_specification_only},
                                   {"parameters", std::move(params)}});
  }
  return rows;
}

Json methods_json() { return catalogue_json(method_catalogue()); }
Json upscalers_json() { return catalogue_json(upscale::upscalers()); }

std::string scenes_text() {
  std::string text = "Built-in scenes (in place of a file; NAME:PARAMETER=VALUE):\n";
  for (const BuiltinScene& scene : builtin_scenes()) {
    const std::string params = scene.params.empty() ? "" : fmt::format(" [{}]", scene.params);
    const std::string failure = scene.failure.empty() ? "" : fmt::format(" ({})", scene.failure);
    text += fmt::format("  {:<16}{}{}{}\n", scene.name, scene.summary, failure, params);
  }
  return text;
}

Json scenes_json() {
  Json::Array rows;
  for (const BuiltinScene& scene : builtin_scenes())
    rows.emplace_back(Json::Object{{"name", scene.name},
                                   {"summary", scene.summary},
                                   {"parameters", scene.params},
                                   {"class", scene.failure},
                                   {"artifact", scene.complaint}});
  return rows;
}

// render/picture.cpp and render/film.cpp select the writers by these extensions.
constexpr SceneFormat picture_formats[] = {{".png", "8 or 16 bits per channel, sRGB; - writes to stdout"},
                                           {".jpg", "quality 92 or --jpeg-quality, no chroma subsampling (4:4:4)"},
                                           {".webp", "lossless or --webp-quality; several frames make an animation"},
                                           {".avif", "lossless"},
                                           {".jxl", "JPEG XL, lossless"},
                                           {".exr", "half floats in linear light, transparent, data passes as layers"},
                                           {".rgba", "raw sRGB-encoded values, 8 or 16 bits per channel"},
                                           {".pfm", "floats in linear light, before tone mapping"},
                                           {".apng", "lossless animation"},
                                           {".gif", "animation, by the program ffmpeg"},
                                           {".mp4", "H.264 video, by ffmpeg; also .mov and .mkv"},
                                           {".webm", "VP9 video with alpha, by ffmpeg"}};

std::string formats_text() {
  std::string text = "Model formats (input):\n";
  for (const std::span<const SceneFormat> formats : {scene_formats(), assimp_formats()})
    for (const SceneFormat& format : formats) text += fmt::format("  {:<16}{}\n", format.extension, format.summary);
  text += "Image and video formats (output):\n";
  for (const SceneFormat& format : picture_formats)
    text += fmt::format("  {:<16}{}\n", format.extension, format.summary);
  text += "Data passes (--aov NAME,...), as .png or .pfm files or as layers of an .exr:\n";
  for (const Aov& aov : aovs()) text += fmt::format("  {:<16}{}\n", aov.name, aov.meaning);
  return text;
}

Json formats_json() {
  const auto rows = [](std::span<const SceneFormat> formats, std::span<const SceneFormat> others = {}) {
    Json::Array out;
    for (const auto& list : {formats, others})
      for (const SceneFormat& format : list)
        out.emplace_back(Json::Object{{"extension", format.extension}, {"summary", format.summary}});
    return out;
  };
  Json::Array passes;
  for (const Aov& aov : aovs()) passes.emplace_back(Json::Object{{"name", aov.name}, {"meaning", aov.meaning}});
  return Json::Object{{"models", rows(scene_formats(), assimp_formats())},
                      {"images", rows(picture_formats)},
                      {"aovs", std::move(passes)}};
}

std::string texture_filters_text() {
  std::string text = "Texture filters (--texture-filter NAME:PARAMETER=VALUE):\n";
  for (const TextureFilterEntry& filter : texture_filters()) {
    text += fmt::format("  {:<16}{}{}\n", filter.name, filter.summary,
                        filter.source.empty() ? "" : fmt::format(" [{}]", filter.source));
    for (const Param& param : filter.params)
      text += fmt::format("  {:<16}  {}  {}\n", "", range_of(param), param.meaning);
  }
  return text;
}

Json texture_filters_json() {
  Json::Array rows;
  for (const TextureFilterEntry& filter : texture_filters())
    rows.emplace_back(Json::Object{{"name", filter.name}, {"summary", filter.summary}, {"source", filter.source}});
  return rows;
}

struct Topic {
  std::string_view name;
  std::string (*text)();
  Json (*json)();
};
constexpr Topic topics[] = {{"methods", methods_text, methods_json},
                            {"scenes", scenes_text, scenes_json},
                            {"formats", formats_text, formats_json},
                            {"texture-filters", texture_filters_text, texture_filters_json},
                            {"upscalers", upscalers_text, upscalers_json}};

}  // namespace

void run_list(std::span<const std::string> arguments) {
  bool prints_json = false;
  Syntax syntax{
      .verb = "list",
      .summary =
          "List the antialiasing methods, the built-in scenes, the file formats, the texture filters and the upscalers",
      .operands = "[methods|scenes|formats|texture-filters|upscalers]...",
      .examples = "  zoneplate list methods\n  zoneplate list --json\n"};
  syntax.options = {{"--json", "", "As JSON", "Options", true, [&](auto&) { prints_json = true; }}};
  if (!parse(syntax, arguments)) return;

  std::vector<std::string_view> names;
  for (const Topic& topic : topics) names.push_back(topic.name);
  std::vector<std::size_t> chosen;
  for (const std::string& operand : syntax.found_operands) chosen.push_back(parse_choice(operand, names));
  if (chosen.empty()) chosen = {0, 1, 2, 3, 4};

  std::string text;
  Json::Object json{{"format", "zoneplate-list"}, {"version", report_version}};
  for (const std::size_t i : chosen) {
    text += (text.empty() ? "" : "\n") + topics[i].text();
    json.emplace_back(topics[i].name, topics[i].json());
  }
  print(prints_json ? Json(json).indented() + '\n' : text);
}

}  // namespace zoneplate::cli
