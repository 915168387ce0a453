// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/lessons/wheel_film.h"

#include <gtest/gtest.h>

#include <cmath>

namespace zoneplate::lessons {
namespace {

constexpr double pi = 3.141592653589793;

std::vector<double> wave(double shift, int harmonics) {
  std::vector<double> profile(128);
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const double x = 2 * pi * (static_cast<double>(i) / 128 - shift);
    profile[i] = 0.5;
    for (int h = 1; h <= harmonics; ++h) profile[i] += 0.2 / h * std::cos(h * x);
  }
  return profile;
}

TEST(WheelFilm, FindsADisplacementByCorrelation) {
  for (const double shift : {0.0, 0.001, -0.1, 0.25, -0.333, 0.49}) {
    EXPECT_NEAR(displacement(wave(0.2, 1), wave(0.2 + shift, 1)), shift, 1e-4);
    EXPECT_NEAR(displacement(wave(-0.4, 6), wave(-0.4 + shift, 6)), shift, 5e-4);
  }
  EXPECT_NEAR(fundamental(wave(0.123, 6)), 0.2, 1e-12);
}

// The statements of the lesson, measured in rendered frames and not by its own formulas.
TEST(WheelFilm, AtNineTenthsOfASpokeAFrameTheWheelRollsBackwards) {
  const WheelFilm film = film_wheel(12, 40, 160);
  constexpr int speed = 36;  // 0.9 of 40
  double closed = 0, open = 0;
  for (int frame = 0; frame < 5; ++frame) {
    const auto now = spoke_profile(film, film.at(frame * speed));
    const auto next = spoke_profile(film, film.at((frame + 1) * speed));
    EXPECT_NEAR(displacement(now, next), -0.1, 0.001) << "frame " << frame;
    closed += fundamental(now);
    open += fundamental(spoke_profile(film, exposed(film, frame * speed, speed)));
  }
  const double theory = std::abs(std::sin(0.9 * pi) / (0.9 * pi));
  EXPECT_NEAR(theory, 0.109, 0.0005);
  EXPECT_NEAR(open / closed, theory, 0.05 * theory);

  // The apparent motion of a slow wheel is its actual motion; a motion by a whole spoke during the exposure leaves no
  // contrast.
  EXPECT_NEAR(displacement(spoke_profile(film, film.at(0)), spoke_profile(film, film.at(8))), 0.2, 0.002);
  EXPECT_LT(fundamental(spoke_profile(film, exposed(film, 3, 40))), 0.003 * closed);
}

TEST(WheelFilm, ExposesTheMeanOfItsInstants) {
  WheelFilm film{.spokes = 3, .steps = 4, .camera = {}, .instants = {}};
  for (const float v : {0.0f, 1.0f, 2.0f, 5.0f}) film.instants.emplace_back(2, 2, Linear{v, 2 * v, 0, 1});
  EXPECT_EQ(exposed(film, 0, 4)(1, 1), (Linear{2, 4, 0, 1}));
  EXPECT_EQ(exposed(film, 3, 2)(0, 1), (Linear{2.5f, 5, 0, 1}));
  EXPECT_EQ(exposed(film, -1, 1)(0, 0), (Linear{5, 10, 0, 1}));
}

}  // namespace
}  // namespace zoneplate::lessons
