// SPDX-License-Identifier: Apache-2.0
// SMAA's lookup textures, byte for byte.
//
// Source: Jimenez, Echevarria, Sousa, Gutierrez, SMAA: Enhanced Subpixel Morphological Antialiasing, Eurographics 2012;
// the generators AreaTex.py and SearchTex.py of v2.8, whose order of operations is kept.
#include "zoneplate/antialias/post/smaa/tables.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <mutex>
#include <utility>

namespace zoneplate::antialias {
namespace {

struct Point {
  double x, y;
};

AreaPair operator+(AreaPair a, AreaPair b) { return {a.below + b.below, a.above + b.above}; }
AreaPair half(AreaPair a) { return {a.below / 2, a.above / 2}; }

/// The areas of the pixel column [left, left + 1] below and above the line from p to q.
AreaPair area_under(Point p, Point q, int left) {
  const double dx = q.x - p.x, dy = q.y - p.y;
  const double x1 = left, x2 = left + 1.0;
  const double y1 = p.y + dy * (x1 - p.x) / dx, y2 = p.y + dy * (x2 - p.x) / dx;
  const bool is_inside = (x1 >= p.x && x1 < q.x) || (x2 > p.x && x2 <= q.x);
  if (!is_inside) return {};

  const bool is_trapezoid = std::signbit(y1) == std::signbit(y2) || std::abs(y1) < 1e-4 || std::abs(y2) < 1e-4;
  if (is_trapezoid) {
    const double a = (y1 + y2) / 2;
    return a < 0 ? AreaPair{std::abs(a), 0} : AreaPair{0, std::abs(a)};
  }
  const double crossing = -p.y * dx / dy + p.x;
  double whole = 0;
  const double fraction = std::modf(crossing, &whole);
  const double a1 = crossing > p.x ? y1 * fraction / 2 : 0.0;
  const double a2 = crossing < q.x ? y2 * (1 - fraction) / 2 : 0.0;
  const double a = std::abs(a1) > std::abs(a2) ? a1 : -a2;
  return a < 0 ? AreaPair{std::abs(a1), std::abs(a2)} : AreaPair{std::abs(a2), std::abs(a1)};
}

/// Rounds a short U shape: interpolates from half the root of twice the area to the area, over 32 pixels.
AreaPair smoothed(double length, AreaPair a) {
  const double p = std::clamp(length / 32, 0.0, 1.0);
  const auto smooth = [p](double v) {
    const double b = std::sqrt(v * 2) * 0.5;
    return b + (v - b) * p;
  };
  return {smooth(a.below), smooth(a.above)};
}

}  // namespace

AreaPair orthogonal_area(int pattern, int left, int right, double offset, bool is_smooth) {
  const double d = left + right + 1, o1 = 0.5 + offset, o2 = o1 - 1;
  const Point middle{d / 2, 0};
  const auto down = [&](double height) { return area_under({0, height}, middle, left); };
  const auto up = [&](double height) { return area_under(middle, {d, height}, left); };
  const auto z = [&](double from, double to) {
    const AreaPair line = area_under({0, from}, {d, to}, left);
    return offset != 0 ? half(line + (down(from) + up(to))) : line;
  };
  const auto u = [&](double height) {
    return is_smooth ? smoothed(d, down(height)) + smoothed(d, up(height)) : down(height) + up(height);
  };
  switch (pattern) {
    case 1:
      return left <= right ? down(o2) : AreaPair{};
    case 2:
      return left >= right ? up(o2) : AreaPair{};
    case 3:
      return u(o2);
    case 4:
      return left <= right ? down(o1) : AreaPair{};
    case 6:
      return z(o1, o2);
    case 7:
    case 14:
      return area_under({0, o1}, {d, o2}, left);
    case 8:
      return left >= right ? up(o1) : AreaPair{};
    case 9:
      return z(o2, o1);
    case 11:
    case 13:
      return area_under({0, o2}, {d, o1}, left);
    case 12:
      return u(o1);
    default:
      return {};
  }
}

namespace {

/// The first cell of a pattern, in units of a pattern's size: x by the left end, y by the right one.
struct Cell {
  int x, y;
};
constexpr Cell orthogonal_cells[16] = {{0, 0}, {3, 0}, {0, 3}, {3, 3}, {1, 0}, {4, 0}, {1, 3}, {4, 3},
                                       {0, 1}, {3, 1}, {0, 4}, {3, 4}, {1, 1}, {4, 1}, {1, 4}, {4, 4}};
constexpr Cell diagonal_cells[16] = {{0, 0}, {1, 0}, {0, 2}, {1, 2}, {2, 0}, {3, 0}, {2, 2}, {3, 2},
                                     {0, 1}, {1, 1}, {0, 3}, {1, 3}, {2, 1}, {3, 1}, {2, 3}, {3, 3}};

/// A line by which a diagonal pattern is revectorised, from a corner of the first pixel to one beyond the last; a
/// pattern has one or two.
struct DiagonalLine {
  Point from, to;
};
struct DiagonalLines {
  int count;
  DiagonalLine line[2];
};
constexpr DiagonalLines diagonal_lines[16] = {{2, {{{1, 1}, {1, 1}}, {{1, 0}, {1, 0}}}},
                                              {2, {{{1, 0}, {0, 0}}, {{1, 0}, {1, 0}}}},
                                              {2, {{{0, 0}, {1, 0}}, {{1, 0}, {1, 0}}}},
                                              {1, {{{1, 0}, {1, 0}}, {}}},
                                              {2, {{{1, 1}, {0, 0}}, {{1, 1}, {1, 0}}}},
                                              {2, {{{1, 1}, {0, 0}}, {{1, 0}, {1, 0}}}},
                                              {1, {{{1, 1}, {1, 0}}, {}}},
                                              {2, {{{1, 1}, {1, 0}}, {{1, 0}, {1, 0}}}},
                                              {2, {{{0, 0}, {1, 1}}, {{1, 0}, {1, 1}}}},
                                              {1, {{{1, 0}, {1, 1}}, {}}},
                                              {2, {{{0, 0}, {1, 1}}, {{1, 0}, {1, 0}}}},
                                              {2, {{{1, 0}, {1, 1}}, {{1, 0}, {1, 0}}}},
                                              {1, {{{1, 1}, {1, 1}}, {}}},
                                              {2, {{{1, 1}, {1, 1}}, {{1, 0}, {1, 1}}}},
                                              {2, {{{1, 1}, {1, 1}}, {{1, 1}, {1, 0}}}},
                                              {2, {{{1, 1}, {1, 1}}, {{1, 0}, {1, 0}}}}};

/// The fraction of 30 × 30 points of the pixel at `corner` that are on the positive side of the line from p to q.
///
/// Rounding is monotonic, so that along a row of points the side changes at most once, and bisection finds where.
double share_beyond(Point p, Point q, Point corner) {
  constexpr int points = 30;
  if (p.x == q.x && p.y == q.y) return 1;
  const double mx = (p.x + q.x) / 2, my = (p.y + q.y) / 2;
  const double a = q.y - p.y, b = p.x - q.x;
  const auto is_beyond = [&](int i, int j) {
    const double x = corner.x + i / static_cast<double>(points - 1), y = corner.y + j / static_cast<double>(points - 1);
    return a * (x - mx) + b * (y - my) > 0;
  };
  int count = 0;
  for (int j = 0; j < points; ++j) {
    const bool rises = a >= 0;
    int low = 0, high = points;  // the first point that is on the same side as the row's end
    while (low < high) {
      const int i = (low + high) / 2;
      if (is_beyond(i, j) == rises)
        high = i;
      else
        low = i + 1;
    }
    count += rises ? points - low : low;
  }
  return count / static_cast<double>(points * points);
}

}  // namespace

AreaPair diagonal_area(int pattern, int left, int right, double offset_x, double offset_y) {
  const double d = left + right + 1;
  const Cell& cell = diagonal_cells[pattern];
  const DiagonalLines& lines = diagonal_lines[pattern];
  AreaPair sum;
  for (int i = 0; i < lines.count; ++i) {
    Point p = lines.line[i].from, q = lines.line[i].to;
    if (cell.x > 0) p = {p.x + offset_x, p.y + offset_y};
    if (cell.y > 0) q = {q.x + offset_x, q.y + offset_y};
    q = {q.x + d, q.y + d};
    const double l = left;
    sum = sum + AreaPair{1 - share_beyond(p, q, {1 + l, l}), share_beyond(p, q, {1 + l, 1 + l})};
  }
  return lines.count == 2 ? half(sum) : sum;
}

std::int32_t diagonal_lines_of(int left_code, int right_code) {
  const auto is_pattern = [&](const Cell& cell) { return cell.x == left_code && cell.y == right_code; };
  const DiagonalLines& lines =
      diagonal_lines[std::find_if(std::begin(diagonal_cells), std::end(diagonal_cells), is_pattern) - diagonal_cells];
  const auto bits = [](const DiagonalLine& line) {
    return static_cast<std::int32_t>(line.from.x + 2 * line.from.y + 4 * line.to.x + 8 * line.to.y);
  };
  return bits(lines.line[0]) | bits(lines.line[lines.count - 1]) << 4;
}

namespace {

constexpr double orthogonal_offsets[7] = {0, -0.25, 0.25, -0.125, 0.125, -0.375, 0.375};
constexpr Point diagonal_offsets[5] = {{0, 0}, {0.25, -0.25}, {-0.25, 0.25}, {0.125, -0.125}, {-0.125, 0.125}};

void put(std::uint8_t* codes, AreaPair area, AreaRounding rounding) {
  const auto code = [&](double v) {
    return static_cast<std::uint8_t>(255 * v + (rounding == AreaRounding::Nearest ? 0.5 : 0.0));
  };
  codes[0] = code(area.below), codes[1] = code(area.above);
}

AreaSlot make_slot(int slot, AreaRounding rounding) {
  constexpr int orthogonal_size = 16, diagonal_size = 20;
  AreaSlot out;
  for (int p = 0; p < 16; ++p) {
    const auto at = [](auto& codes, Cell cell, int size, int left, int right) {
      return &codes[static_cast<std::size_t>(2 * ((size * cell.y + right) * AreaSlot::size + size * cell.x + left))];
    };
    for (int right = 0; right < orthogonal_size; ++right)
      for (int left = 0; left < orthogonal_size; ++left)
        put(at(out.orthogonal, orthogonal_cells[p], orthogonal_size, left, right),
            orthogonal_area(p, left * left, right * right, orthogonal_offsets[slot], true), rounding);
    if (slot >= 5) continue;
    for (int right = 0; right < diagonal_size; ++right)
      for (int left = 0; left < diagonal_size; ++left)
        put(at(out.diagonal, diagonal_cells[p], diagonal_size, left, right),
            diagonal_area(p, left, right, diagonal_offsets[slot].x, diagonal_offsets[slot].y), rounding);
  }
  return out;
}

}  // namespace

const AreaSlot& area_slot(int slot, AreaRounding rounding) {
  static std::mutex mutex;
  static std::map<std::pair<int, AreaRounding>, AreaSlot> slots;
  const std::lock_guard lock(mutex);
  const auto found = slots.find({slot, rounding});
  return found != slots.end() ? found->second
                              : slots.emplace(std::pair{slot, rounding}, make_slot(slot, rounding)).first->second;
}

std::vector<std::uint8_t> make_search_table() {
  // A fetch between four pixels weights them by 1, 3, 7 and 21 in 32, so that its value determines which are set.
  constexpr int unset = -1;
  std::array<int, 33> bits;
  bits.fill(unset);
  for (int e = 0; e < 16; ++e)
    bits[static_cast<std::size_t>((e & 1) + 3 * (e >> 1 & 1) + 7 * (e >> 2 & 1) + 21 * (e >> 3 & 1))] = e;

  constexpr int e0 = 1, e1 = 2, e2 = 4, e3 = 8;
  const auto left_length = [](int across, int along) {
    if (!(along & e3)) return 0;
    return along & e2 && !(across & (e1 | e3)) ? 2 : 1;
  };
  const auto right_length = [](int across, int along) {
    if (!(along & e3) || across & (e1 | e3)) return 0;
    return along & e2 && !(across & (e0 | e2)) ? 2 : 1;
  };
  std::vector<std::uint8_t> table(64 * 16);
  for (std::size_t y = 0; y < 16; ++y)
    for (std::size_t x = 0; x < 64; ++x) {
      const int across = bits[x % 33], along = bits[32 - y];
      if (across == unset || along == unset) continue;
      const int length = x < 33 ? left_length(across, along) : right_length(across, along);
      table[64 * y + x] = static_cast<std::uint8_t>(127 * length);
    }
  return table;
}

}  // namespace zoneplate::antialias
