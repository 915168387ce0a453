// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/base/spec.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/report/json.h"
#include "zoneplate/report/table.h"

namespace zoneplate::lessons {

/// The size of a lesson.
struct DemoSize {
  int panel = 360;  ///< side of one panel in pixels; text and gaps scale with it

  FigureStyle style() const { return {.text_px = std::max(8, panel / 20), .gap_px = std::max(6, panel / 15)}; }
};

/// A lesson: a figure, or the frames of an animated one. The text of the first frame is also printed to stdout.
///
/// Exact     the same bits on every machine and number of threads.
struct Lesson {
  std::vector<Figure> frames;  ///< one frame: a still image
  int seconds = 1, per = 24;   ///< a frame is displayed for seconds / per
  std::vector<Table> tables;   ///< the figure's tables, for the text
};

/// An entry of the list of lessons; each lesson's file defines its own.
struct Demo {
  std::string_view name, summary;
  Lesson (*make)(const DemoSize& size, const Settings& settings);
  std::span<const Param> params = {};
  bool is_animated = false;  ///< the lesson has several frames, written as APNG and WebP
};

/// The lessons, in the order of demos.txt.
std::span<const Demo> demos();

/// A lesson with its name.
struct NamedLesson {
  std::string name;
  Lesson lesson;
};

/// Takes a picture of a page, and gives its index.
using AddPicture = std::function<std::uint64_t(const Rgba8Image&)>;

/// A lesson as a scene of a page (report/html_page.h): the panels that have captions, and the tables. Panels of plots
/// without a picture are in `plots`: { name, text, plot }.
Json page_scene(const NamedLesson& lesson, const AddPicture& add);

/// The lessons as a page for a browser.
std::string page_of(std::span<const NamedLesson> lessons);

/// The texts of the figure, wrapped for a terminal: title, captions, text and tables.
std::string text_of(const Lesson& lesson);

}  // namespace zoneplate::lessons
