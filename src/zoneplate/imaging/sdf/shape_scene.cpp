// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/sdf/shape_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/font/font.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"

namespace zoneplate {
namespace {

constexpr int max_side = 32768;

}  // namespace

std::function<sdf::Outline(std::string_view, double)> text_outlines(const ShapeSceneOptions& args) {
  return [path = args.font, font = std::shared_ptr<const Font>()](std::string_view text, double size) mutable {
    if (!font) font = std::make_shared<const Font>(path.empty() ? dejavu_path("DejaVuSans.ttf") : path);
    return text_outline(*font, text, size);
  };
}

namespace {

sdf::SceneFile read_shape_scene(const std::string& operand, const sdf::SceneFileOptions& options) {
  constexpr std::size_t max_bytes = std::size_t{1} << 28;
  const MappedFileWatch watch;
  const FileBytes file(operand);
  if (file.bytes().size() > max_bytes)
    throw Error(ErrorKind::Input,
                fmt::format("{}: {} bytes; a scene of shapes has at most {}", operand, file.bytes().size(), max_bytes));
  sdf::SceneFile scene =
      sdf::read_scene_file({reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()}, operand, options);
  watch.check(operand);
  return scene;
}

}  // namespace

sdf::SceneFile load_shape_scene(const std::string& operand, const sdf::SceneFileOptions& options, Delivery& out) {
  sdf::SceneFile scene;
  out.read(operand, [&] { scene = read_shape_scene(operand, options); });
  return scene;
}

sdf::Raster raster_of(const sdf::SceneFile& scene, const ShapeSceneOptions& args, const std::string& operand) {
  constexpr double margin = 8;  // units around shapes without a canvas
  sdf::Bounds area{{0, 0}, {static_cast<double>(scene.width), static_cast<double>(scene.height)}};
  if (scene.width == 0) {
    if (scene.bounds.empty())
      throw Error(ErrorKind::Input,
                  fmt::format("{}: no canvas, and no shape of finite size; add `canvas WIDTH HEIGHT`", operand));
    area = scene.bounds.grown(margin);
    area = {{std::floor(area.low.x), std::floor(area.low.y)}, {std::ceil(area.high.x), std::ceil(area.high.y)}};
  }
  const sdf::Point extent = area.high - area.low;
  sdf::Raster raster{.origin = area.low, .scale = args.scale};
  double width = std::ceil(extent.x * args.scale - 1e-9), height = std::ceil(extent.y * args.scale - 1e-9);
  if (args.size) {
    width = args.size->x, height = args.size->y;
    raster.scale = std::min(width / extent.x, height / extent.y);
    raster.origin = (area.low + area.high) * 0.5 - sdf::Point{width, height} * (0.5 / raster.scale);
  }
  const auto check = [&](bool fits, const std::string& limit) {
    if (!fits)
      throw Error(ErrorKind::Usage, fmt::format("{}: an image of {:.0f} × {:.0f} pixels is too large, the limit is {}",
                                                operand, width, height, limit));
  };
  const std::uint64_t pixels = args.limits.load.pixels;
  check(width <= max_side && height <= max_side, fmt::format("{} per side", max_side));
  check(width * height <= static_cast<double>(pixels), fmt::format("{} (--max-pixels)", pixels));
  raster.width = std::max(1, static_cast<int>(width)), raster.height = std::max(1, static_cast<int>(height));
  return raster;
}

}  // namespace zoneplate
