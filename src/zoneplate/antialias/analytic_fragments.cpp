#include "zoneplate/antialias/analytic_fragments.h"

#include <algorithm>

namespace zoneplate::antialias {
namespace {

constexpr std::uint32_t hashes = 256;  // of a pixel's fragments

/// Calls use(part, polygon) for what of the polygon lies in each cell of a grid × grid over the pixel, row by row.
template <class Use>
void for_parts(const ConvexPolygon& polygon, int grid, Use use) {
  const double step = 1.0 / grid;
  ConvexPolygon row, rest = polygon, cell, right;
  for (int j = 0; j < grid && !rest.empty(); ++j) {
    ConvexPolygon below;
    if (j + 1 < grid)
      cut(rest, {0, -1, (j + 1) * step}, row, below);
    else
      row = rest;
    rest = below;
    for (int i = 0; i < grid && !row.empty(); ++i) {
      right.count = 0;
      if (i + 1 < grid)
        cut(row, {-1, 0, (i + 1) * step}, cell, right);
      else
        cell = row;
      if (!cell.empty()) use(static_cast<std::uint32_t>(j * grid + i), cell);
      row = right;
    }
  }
}

}  // namespace

FragmentList::FragmentList(const PolynomialFilter& filter, int shading, int mask)
    : filter_(filter), shading_(shading), mask_(std::max(shading, mask)) {
  for_parts(unit_square(), shading_, [&](std::uint32_t, const ConvexPolygon& part) {
    whole_.push_back(area_moments(part));
    whole_weights_.resize(whole_.size() * filter_.weight_count());
    filter_.add_weights(part, std::span(whole_weights_).last(filter_.weight_count()));
  });
}

void FragmentList::clear() {
  fragments_.clear();
  weights_.clear();
  layers_.clear();
}

void FragmentList::add_whole(std::int32_t id, int x, int y) {
  const auto layer = static_cast<std::uint32_t>(layers_.size());
  layers_.push_back({id, Surface::Opaque});
  for (std::size_t i = 0; i < whole_.size(); ++i)
    fragments_.push_back({x, y, static_cast<std::uint32_t>(i), layer, 1, whole_[i]});
  weights_.insert(weights_.end(), whole_weights_.begin(), whole_weights_.end());
}

void FragmentList::begin_pixel(int x, int y) {
  x_ = x, y_ = y;
  head_.assign(hashes, -1);
}

void FragmentList::add(const PixelCells& cells) {
  for (const PixelCells::Cell& cell : cells.cells()) {
    if (cell.layers == 0) continue;
    now_.clear();
    bool is_masked = false;
    for (const std::uint32_t number : cells.layers_of(cell)) {
      const PixelTriangle& t = cells.triangle(number);
      now_.push_back({t.id, t.surface});
      is_masked = is_masked || t.surface == Surface::Masked;
    }
    add_parts(cell.polygon, is_masked ? mask_ : shading_);
  }
}

void FragmentList::add_parts(const ConvexPolygon& polygon, int grid) {
  if (grid == 1) return add_part(polygon, 0);
  for_parts(polygon, grid, [&](std::uint32_t part, const ConvexPolygon& p) { add_part(p, part); });
}

/// One fragment for what of a part of the pixel shows the same, in however many polygons.
std::size_t FragmentList::fragment_of(std::uint32_t part) {
  std::int32_t& head = head_[(static_cast<std::uint32_t>(now_[0].id) + part * 31u) % hashes];
  for (std::int32_t i = head; i >= 0; i = next_[static_cast<std::size_t>(i)]) {
    const Fragment& f = fragments_[static_cast<std::size_t>(i)];
    if (f.part == part && std::ranges::equal(layers_of(f), now_)) return static_cast<std::size_t>(i);
  }
  const std::size_t added = fragments_.size();
  const auto first = static_cast<std::uint32_t>(layers_.size()), count = static_cast<std::uint32_t>(now_.size());
  layers_.insert(layers_.end(), now_.begin(), now_.end());
  fragments_.push_back({x_, y_, part, first, count, {}});
  weights_.resize(weights_.size() + filter_.weight_count());
  next_.resize(fragments_.size(), -1);
  next_[added] = head;
  head = static_cast<std::int32_t>(added);
  return added;
}

void FragmentList::add_part(const ConvexPolygon& polygon, std::uint32_t part) {
  const std::size_t i = fragment_of(part);
  const AreaMoments m = area_moments(polygon);
  AreaMoments& sum = fragments_[i].moments;
  sum = {sum.area + m.area, sum.x + m.x, sum.y + m.y};
  filter_.add_weights(polygon, std::span(weights_).subspan(i * filter_.weight_count(), filter_.weight_count()));
}

}  // namespace zoneplate::antialias
