#include "zoneplate/scene/import_budget.h"

#include <gtest/gtest.h>

#include <ctime>
#include <string>

#include "zoneplate/math/random.h"
#include "zoneplate/scene/damage_for_test.h"
#include "zoneplate/scene/obj.h"
#include "zoneplate/scene/ply.h"
#include "zoneplate/scene/stl.h"

namespace zoneplate {
namespace {

constexpr int knots = 100, corners = 4096, points = 256;

/// A corner of an outline that crosses itself all over, which takes as long to cut as any.
std::uint32_t knot_corner(int i) { return hash(static_cast<std::uint32_t>(i)) % points; }

std::string place(std::uint32_t point) {
  return std::to_string(hash(point, 1) % 1000) + " " + std::to_string(hash(point, 2) % 1000) + " 0\n";
}

std::string ply_of_knots() {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(points) +
                     "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(knots) +
                     "\nproperty list uint uint vertex_indices\nend_header\n";
  for (std::uint32_t p = 0; p < points; ++p) text += place(p);
  for (int k = 0; k < knots; ++k) {
    text += std::to_string(corners);
    for (int i = 0; i < corners; ++i) text += " " + std::to_string(knot_corner(i));
    text += "\n";
  }
  return text;
}

std::string obj_of_knots() {
  std::string text;
  for (std::uint32_t p = 0; p < points; ++p) text += "v " + place(p);
  for (int k = 0; k < knots; ++k) {
    text += "f";
    for (int i = 0; i < corners; ++i) text += " " + std::to_string(1 + knot_corner(i));
    text += "\n";
  }
  return text;
}

std::string stl_of_knots() {
  std::string text = "solid knots\n";
  for (int k = 0; k < knots; ++k) {
    text += "facet normal 0 0 1 outer loop\n";
    for (int i = 0; i < corners; ++i) text += "vertex " + place(knot_corner(i));
    text += "endloop endfacet\n";
  }
  return text;
}

/// Loads a text of knots that takes much longer than it may; the message.
template <class Load>
std::string hurried(const Load& load, const std::string& text) {
  const MemoryFile file;
  const std::string path = file.write({text.begin(), text.end()});
  const std::clock_t begin = std::clock();
  std::string message = "loaded";
  try {
    load(path, {.seconds = 0.1});
  } catch (const Error& error) {
    message = error.what();
  }
  // A knot takes some tenths of a second, all of them many times this; a few may be at work when the time is over.
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 4.0);
  return message.substr(std::min(message.size(), path.size()));
}

TEST(ImportBudget, TimeRunsOutBetweenTheFacesOfABlock) {
  const std::string late = ": takes longer to load than the limit of 100 ms";
  EXPECT_EQ(hurried(load_obj, obj_of_knots()), late);
  EXPECT_EQ(hurried(load_ply, ply_of_knots()), late);
  EXPECT_EQ(hurried(load_stl, stl_of_knots()), late);
}

}  // namespace
}  // namespace zoneplate
