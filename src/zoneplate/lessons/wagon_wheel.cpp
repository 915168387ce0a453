// SPDX-License-Identifier: Apache-2.0
// Aliasing in time: a wheel that turns by nearly one spoke per frame appears to turn backwards.
//
// The apparent motion is measured in the rendered frames: the displacement by correlation of consecutive frames, the
// contrast by the amplitude of the wave with a period of one spoke.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/lessons/wheel_film.h"
#include "zoneplate/signal/fourier/series.h"

namespace zoneplate::lessons {
namespace wagon_wheel_lesson {
namespace {

// Steps per spoke: their mean is within 0.1 % of the integral over an open shutter.
constexpr int spokes = 12, steps = 40;
constexpr int shown_speed = 36;  // steps per frame: 0.9 spokes
// The number of frames after which the wheel has turned by whole spokes and the animation repeats.
constexpr int frames = 10;
static_assert(frames * shown_speed % steps == 0);
constexpr std::array speeds = {4, 10, 20, 30, 36, 40, 44, 50};  // speeds of the table, in steps per frame

struct Motion {
  double apparent = 0, contrast = 0;
};

/// Films the wheel at a speed, with closed and open shutter, and measures both.
Motion measured(const WheelFilm& film, int speed) {
  std::vector<std::vector<double>> closed, open;
  for (int frame = 0; frame <= frames; ++frame) closed.push_back(spoke_profile(film, film.at(frame * speed)));
  for (int frame = 0; frame < 2; ++frame) open.push_back(spoke_profile(film, exposed(film, frame * speed, speed)));
  double sum = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    // A turn by half a spoke has no direction: only its magnitude counts.
    const double d = displacement(closed[i], closed[i + 1]);
    sum += std::abs(d) > 0.49 ? std::abs(d) : d;
  }
  return {sum / frames,
          (fundamental(open[0]) + fundamental(open[1])) / (fundamental(closed[0]) + fundamental(closed[1]))};
}

std::string signed_number(double value, int decimals) {
  const std::string text = number(value, decimals);
  if (std::abs(value) > 0.495) return "±" + text;
  return value > 0.0005 ? "+" + text : text;
}

std::string percent(double fraction) { return number(100 * fraction, 1) + "\u00a0%"; }

double spokes_of(int speed) { return static_cast<double>(speed) / steps; }

Table speed_table(const std::vector<Motion>& motions) {
  Table table{{"true speed", "apparent: theory", "apparent: measured", "contrast: theory", "contrast: measured"}, {}};
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const double cycles = spokes_of(speeds[i]);
    table.rows.push_back({"+" + number(cycles, 2), signed_number(apparent_frequency(cycles, 1), 3),
                          signed_number(motions[i].apparent, 3), percent(shutter_contrast(cycles)),
                          percent(motions[i].contrast)});
  }
  return table;
}

struct Captions {
  std::string slow, closed, open;
};
Captions captions_of(const Motion& motion) {
  const double cycles = spokes_of(shown_speed);
  return {
      fmt::format("True motion, {} times slower\nThe wheel rolls to the right: it turns clockwise by {} spokes per "
                  "frame.",
                  number(cycles * frames, 0), number(cycles, 1)),
      fmt::format("Instantaneous frames\nTurns by +{} and by {} spokes look the same. The smaller one is perceived: {} "
                  "spokes per frame (measured {}), backwards.",
                  number(cycles, 1), signed_number(cycles - 1, 1), signed_number(apparent_frequency(cycles, 1), 3),
                  signed_number(motion.apparent, 4)),
      fmt::format("Shutter always open\nEach frame is the mean of {} instants. The spokes keep |sinc {}| = {} of their "
                  "contrast (measured {}): only a faint shadow turns backwards.",
                  shown_speed, number(cycles, 1), percent(shutter_contrast(cycles)), percent(motion.contrast))};
}

constexpr const char* about =
    "Speeds in spokes per frame; a turn by half a spoke has no direction. An open shutter is a box filter in time: it "
    "does not restore the true speed, but it suppresses the alias. As in space, the filter must come before sampling.";

Lesson make(const DemoSize& size, const Settings&) {
  const WheelFilm film = film_wheel(spokes, steps, size.panel);
  std::vector<Motion> motions;
  for (const int speed : speeds) motions.push_back(measured(film, speed));
  const auto shown_place = std::find(speeds.begin(), speeds.end(), shown_speed) - speeds.begin();
  const Captions captions = captions_of(motions[static_cast<std::size_t>(shown_place)]);
  const Table table = speed_table(motions);
  const Rgba8Image drawn = table_picture(table, size.style(), 3 * size.panel + 2 * size.style().gap_px);

  Lesson lesson{.tables = {table}};
  for (int frame = 0; frame < frames; ++frame) {
    const int at = frame * shown_speed;
    lesson.frames.push_back({.title = "A wheel that rolls forwards appears to roll backwards",
                             .rows = {{{shown(film.at(frame * steps / frames)), captions.slow},
                                       {shown(film.at(at)), captions.closed},
                                       {shown(exposed(film, at, shown_speed)), captions.open}},
                                      {{drawn, ""}}},
                             .text = about});
  }
  return lesson;
}

}  // namespace
}  // namespace wagon_wheel_lesson

Demo demo_wagon_wheel() {
  return {"wagon-wheel",
          "an animation: a wheel that appears to roll backwards, with closed and open shutter",
          wagon_wheel_lesson::make,
          {},
          true};
}

}  // namespace zoneplate::lessons
