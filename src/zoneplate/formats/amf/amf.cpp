// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/amf/amf.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/formats/3mf/flaws.h"
#include "zoneplate/formats/3mf/placement.h"
#include "zoneplate/formats/amf/parse.h"
#include "zoneplate/formats/xml/xml.h"
#include "zoneplate/formats/zip/zip.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

void parse(std::span<const std::uint8_t> bytes, AmfParser& handler, FlawList& flaws, ImportBudget& budget) {
  if (!is_zip(bytes)) {
    XmlParser parser(handler, budget.file(), budget);
    parser.feed(bytes);
    return parser.finish();
  }
  ZipArchive archive(bytes, budget);
  const std::vector<std::string>& names = archive.names();
  if (names.empty()) throw Error(ErrorKind::Input, budget.file() + ": is an archive without files");
  const auto found = std::find_if(names.begin(), names.end(), [](const std::string& n) { return n.ends_with(".amf"); });
  const auto file = static_cast<std::size_t>(found == names.end() ? 0 : found - names.begin());
  XmlParser parser(handler, budget.file() + ": " + printable(names[file]), budget);
  const bool is_intact = archive.read(file, [&](std::span<const std::uint8_t> piece) { parser.feed(piece); });
  parser.finish();
  if (!is_intact) flaws.add(Flaw::Checksum, [&] { return names[file] + ": its checksum is wrong"; });
}

}  // namespace

Scene load_amf(const std::string& path, const LoadLimits& limits) {
  const FileBytes file(path, limits.memory);
  ImportBudget budget(path == "-" ? "standard input" : path, limits);
  Scene scene;
  scene.up = {0, 0, 1};
  FlawList flaws(budget, scene.warnings);
  model_3mf::Model model;
  AmfParser handler(model, flaws, budget);
  parse(file.bytes(), handler, flaws, budget);
  handler.finish();
  ModelFolder files("", budget, scene);
  const auto no_parts = [](const std::string&) { return std::optional<std::vector<std::uint8_t>>(); };
  ObjectPlacer placer([&](const std::string&) { return &model; }, no_parts, files, flaws);
  placer.place_all(model, top_objects(model, budget));
  flaws.report();
  if (scene.instances.empty()) throw budget.nothing_to_draw(scene.warnings, "holds nothing to draw");
  return scene;
}

}  // namespace zoneplate
