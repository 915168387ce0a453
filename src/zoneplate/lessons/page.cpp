// SPDX-License-Identifier: Apache-2.0
// Lessons as a page for a browser.
#include <algorithm>
#include <utility>

#include "zoneplate/image/hex_color.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/report/html_page.h"

namespace zoneplate::lessons {
namespace {

/// The heading and the other lines of a caption.
struct CaptionParts {
  std::string name, text;
};
CaptionParts parts_of(const std::string& caption) {
  const std::size_t end = caption.find('\n');
  if (end == std::string::npos) return {caption, ""};
  return {caption.substr(0, end), caption.substr(end + 1)};
}

/// The indices of the pictures of a panel's frames; equal frames have one picture, and a still panel has one index.
Json::Array frames_of(const Lesson& lesson, std::size_t row, std::size_t i, const AddPicture& add) {
  std::vector<std::pair<const Rgba8Image*, std::uint64_t>> added;
  Json::Array out;
  for (const Figure& frame : lesson.frames) {
    const Rgba8Image& image = frame.rows[row][i].picture;
    const auto known = std::ranges::find_if(added, [&](const auto& entry) { return *entry.first == image; });
    const std::uint64_t index = known == added.end() ? add(image) : known->second;
    if (known == added.end()) added.emplace_back(&image, index);
    out.push_back(index);
  }
  if (added.size() == 1) out.resize(1);
  return out;
}

Json curve_of(const Curve& curve, std::size_t place) {
  constexpr std::string_view marks[] = {"line", "dashed", "points", "line-and-points", "stems", "steps", "area"};
  Json::Array points;
  for (const auto& [x, y] : curve.points) points.push_back(Json::Array{x, y});
  return Json::Object{{"name", curve.name},
                      {"mark", marks[static_cast<std::size_t>(curve.mark)]},
                      {"color", hex_color(curve_color(curve, place))},
                      {"opacity", curve.opacity},
                      {"labels", Json::Array(curve.labels.begin(), curve.labels.end())},
                      {"labels_are_below", curve.labels_are == Curve::Beside::LeftBelow},
                      {"points", std::move(points)}};
}

Json plot_of(const Plot& plot) {
  const auto axis = [](const Axis& a) {
    return Json::Object{{"label", a.label}, {"low", a.low}, {"high", a.high}, {"is_logarithmic", a.is_logarithmic}};
  };
  Json::Array curves;
  for (const Curve& curve : plot.curves) curves.push_back(curve_of(curve, curves.size()));
  return Json::Object{{"title", plot.title}, {"x", axis(plot.x)}, {"y", axis(plot.y)}, {"curves", std::move(curves)}};
}

}  // namespace

Json page_scene(const NamedLesson& named, const AddPicture& add) {
  const Lesson& lesson = named.lesson;
  const Figure& figure = lesson.frames.at(0);
  Json::Array images, plots, tables, chosen;
  for (std::size_t row = 0; row < figure.rows.size(); ++row)
    for (std::size_t i = 0; i < figure.rows[row].size(); ++i) {
      // Panels without captions are signs between others, and drawn tables.
      const std::string& caption = figure.rows[row][i].caption;
      if (caption.empty()) continue;
      const auto [name, text] = parts_of(caption);
      if (figure.rows[row][i].picture.empty()) {
        plots.push_back(Json::Object{{"name", name}, {"text", text}, {"plot", plot_of(*figure.rows[row][i].plot)}});
        continue;
      }
      chosen.push_back(static_cast<std::uint64_t>(images.size()));
      images.push_back(Json::Object{{"name", name}, {"text", text}, {"frames", frames_of(lesson, row, i, add)}});
    }
  for (const Table& table : lesson.tables) tables.push_back(page_table(table, ""));
  Json::Object out{{"name", named.name},          {"title", figure.title},
                   {"text", figure.text},         {"images", std::move(images)},
                   {"chosen", std::move(chosen)}, {"fps", static_cast<double>(lesson.per) / lesson.seconds},
                   {"tables", std::move(tables)}};
  if (!plots.empty()) out.emplace_back("plots", std::move(plots));
  return out;
}

std::string page_of(std::span<const NamedLesson> lessons) {
  std::vector<PagePicture> pictures;
  Json::Array scenes;
  const auto add = [&](const Rgba8Image& image) {
    pictures.push_back(page_picture(image));
    return pictures.size() - 1;
  };
  for (const NamedLesson& lesson : lessons) scenes.push_back(page_scene(lesson, add));
  const std::string title =
      lessons.size() == 1 ? lessons[0].lesson.frames.at(0).title : "Lessons about aliasing and its remedies";
  return html_page(title, Json::Object{{"title", title}, {"scenes", std::move(scenes)}}, pictures);
}

}  // namespace zoneplate::lessons
