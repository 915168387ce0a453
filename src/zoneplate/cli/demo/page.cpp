// SPDX-License-Identifier: Apache-2.0
// Lessons as a page for a browser.
#include "zoneplate/cli/demo/demo.h"
#include "zoneplate/report/html_page.h"

namespace zoneplate::cli {
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

/// Adds a picture and returns its index; that of an equal picture, if it is one of those from `first` on.
std::uint64_t add(const Rgba8Image& image, std::vector<PagePicture>& pictures, std::size_t first) {
  PagePicture picture = page_picture(image);
  for (std::size_t i = first; i < pictures.size(); ++i)
    if (pictures[i].png == picture.png) return i;
  pictures.push_back(std::move(picture));
  return pictures.size() - 1;
}

Json scene_of(const NamedLesson& named, std::vector<PagePicture>& pictures) {
  const Lesson& lesson = named.lesson;
  const Figure& figure = lesson.frames.at(0);
  Json::Array images, tables, chosen;
  for (std::size_t row = 0; row < figure.rows.size(); ++row)
    for (std::size_t i = 0; i < figure.rows[row].size(); ++i) {
      // Panels without captions are signs between others, and drawn tables.
      const std::string& caption = figure.rows[row][i].caption;
      if (caption.empty()) continue;
      const auto [name, text] = parts_of(caption);
      Json::Array frames;
      const std::size_t first = pictures.size();
      for (const Figure& frame : lesson.frames) frames.push_back(add(frame.rows[row][i].picture, pictures, first));
      if (pictures.size() - first == 1) frames.resize(1);  // a still panel of an animated lesson
      chosen.push_back(static_cast<std::uint64_t>(images.size()));
      images.push_back(Json::Object{{"name", name}, {"text", text}, {"frames", std::move(frames)}});
    }
  for (const Table& table : lesson.tables) tables.push_back(page_table(table, ""));
  return Json::Object{{"name", named.name},          {"title", figure.title},
                      {"text", figure.text},         {"images", std::move(images)},
                      {"chosen", std::move(chosen)}, {"fps", static_cast<double>(lesson.per) / lesson.seconds},
                      {"tables", std::move(tables)}};
}

}  // namespace

std::string page_of(std::span<const NamedLesson> lessons) {
  std::vector<PagePicture> pictures;
  Json::Array scenes;
  for (const NamedLesson& lesson : lessons) scenes.push_back(scene_of(lesson, pictures));
  const std::string title =
      lessons.size() == 1 ? lessons[0].lesson.frames.at(0).title : "Lessons about aliasing and its remedies";
  return html_page(title, Json::Object{{"title", title}, {"scenes", std::move(scenes)}}, pictures);
}

}  // namespace zoneplate::cli
