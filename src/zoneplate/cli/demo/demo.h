#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/report/figure.h"
#include "zoneplate/report/table.h"

namespace zoneplate::cli {

/// How large a lesson is drawn.
struct DemoSize {
  int panel = 360;  ///< pixels of one picture's side; text and gaps follow

  FigureStyle style() const;
};

/// What a lesson shows: a figure, or several that move. The text of the first is said on stdout too.
///
/// Exact     the same bits on every machine and number of threads.
struct Lesson {
  std::vector<Figure> frames;  ///< one: a picture
  int seconds = 1, per = 24;   ///< a frame stays for seconds / per
  std::vector<Table> tables;   ///< those in the figure, for the text
};

/// A row of the list of lessons; each lesson's file makes its own.
struct Demo {
  std::string_view name, summary;
  Lesson (*make)(const DemoSize& size);
  bool is_animated = false;  ///< the lesson has several frames, written as APNG and WebP
};

/// The lessons, in the order of demos.txt.
std::span<const Demo> demos();

/// What the figure says, as text: title, captions, text, wrapped for a terminal, and the tables.
std::string text_of(const Lesson& lesson);

}  // namespace zoneplate::cli
