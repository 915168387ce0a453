// SPDX-License-Identifier: Apache-2.0
// Ghosts: history of a surface that is gone, and what removes it.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/lessons/temporal/moving_film.h"

namespace zoneplate::lessons {
namespace ghosting_lesson {
namespace {

constexpr int factor = 4, jump = 8;  // the scene jumps before frame 8
constexpr std::array shown_frames = {0, 1, 3, 7};

struct Cure {
  const char *method, *heading, *words;
};
constexpr std::array<Cure, 4> cures = {
    {{"taa:rectify=none,reject=none,rest=test,blend=fixed,alpha=0.1", "No test",
      "Each frame keeps nine tenths of a disc that is gone."},
     {"taa:rectify=clamp,box=extremes,reject=none,rest=test", "Clamp",
      "History stays among the colours around: ghosts remain where these vary."},
     {"taa", "Object, depth and clip", "Where the last frame had another object, history is dropped."},
     {"oracle-taa", "The oracle", "Rays to the last frame's triangles decide. Only antialiased fringes remain."}}};

/// The sum of the absolute errors of green over the disc's old place.
double error_at(const LinearImage& reference, const LinearImage& test) {
  const int left = reference.width() * 8 / 100, right = reference.width() * 32 / 100;
  const int top = reference.height() * 12 / 100, bottom = reference.height() * 44 / 100;
  double sum = 0;
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x)
      sum += std::abs(static_cast<double>(test(x, y).g) - static_cast<double>(reference(x, y).g));
  return sum;
}

Lesson make(const DemoSize& size, const Settings&) {
  const int side = size.panel, height = side * 3 / 4;
  const auto film = [&](const char* method) {
    return film_of_scene("teleport", method, jump + shown_frames.back() + 1, side, height);
  };
  const std::vector<LinearImage> reference = film("ssaa:n=4");
  Figure figure{.title = "Ghosting: history of what is no longer there", .rows = {{}}};
  Table table{{"frames after the jump"}, {}};
  for (const int k : shown_frames) table.rows.push_back({std::to_string(k + 1)});
  const double all = error_at(reference[jump], reference[jump - 1]);
  for (const Cure& cure : cures) {
    const std::vector<LinearImage> images = film(cure.method);
    table.head.emplace_back(cure.heading);
    for (std::size_t k = 0; k < shown_frames.size(); ++k) {
      const auto frame = static_cast<std::size_t>(jump + shown_frames[k]);
      table.rows[k].push_back(number(100 * error_at(reference[frame], images[frame]) / all, 1) + "\u00a0%");
    }
    figure.rows[0].push_back({crop_of(shown(images[jump]), side * 20 / 100, height * 28 / 100, factor, side),
                              fmt::format("{}\n{}", cure.heading, cure.words)});
  }
  figure.rows.push_back({{table_picture(table, size.style(), 4 * size.panel + 3 * size.style().gap_px), ""}});
  figure.text =
      "A disc jumps away; the crops are of the first frame after it. The table has the error at its old place, "
      "relative "
      "to that of keeping the disc, against 16 samples per pixel: it includes the edges of the wall, which the tests "
      "leave "
      "with few samples.";
  return {.frames = {figure}, .tables = {table}};
}

}  // namespace
}  // namespace ghosting_lesson

Demo demo_ghosting() {
  return {"ghosting", "the image of an object that has jumped away, and the tests that remove it",
          ghosting_lesson::make};
}

}  // namespace zoneplate::lessons
