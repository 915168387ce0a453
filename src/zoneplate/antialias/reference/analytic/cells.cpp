// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/cells.h"

#include <algorithm>
#include <cmath>

namespace zoneplate::antialias {
namespace {

/// The line whose inner side is where a is nearer than b.
Line nearer(const PixelTriangle& a, const PixelTriangle& b) { return {a.zx - b.zx, a.zy - b.zy, a.z - b.z}; }

enum class Order { InFront, Behind, Crossing };

/// The order of triangle a relative to b over a polygon.
Order order_over(const ConvexPolygon& polygon, const PixelTriangle& a, const PixelTriangle& b) {
  const Line line = nearer(a, b);
  const double least = on_line * (std::abs(line.a) + std::abs(line.b));  // minimum distance of a corner from the line
  double sum = 0;
  bool in_front = false, behind = false;
  for (int i = 0; i < polygon.count; ++i) {
    const double d = line.distance(polygon[i]);
    in_front = in_front || d > least;
    behind = behind || d < -least;
    sum += d;
  }
  if (in_front && behind) return Order::Crossing;
  if (in_front || behind) return in_front ? Order::InFront : Order::Behind;
  // A polygon so close to the line belongs to one side of it; only if depths are equal everywhere, ids decide.
  if (sum != 0) return sum > 0 ? Order::InFront : Order::Behind;
  return a.id < b.id ? Order::InFront : Order::Behind;
}

/// The line along which a and b intersect, scaled to distances in pixels; inside is where a is nearer.
Line crossing(const PixelTriangle& a, const PixelTriangle& b) {
  const Line line = nearer(a, b);
  const double slope = std::sqrt(line.a * line.a + line.b * line.b);
  return {line.a / slope, line.b / slope, line.c / slope};
}

}  // namespace

void PixelCells::clear(const ConvexPolygon& region) {
  triangles_.clear();
  layers_.clear();
  cells_.clear();
  cells_.push_back({region, 0, 0});
  free_ = 1;
  is_full_ = false;
}

void PixelCells::insert(const PixelTriangle& triangle) {
  const auto number = static_cast<std::uint32_t>(triangles_.size());
  triangles_.push_back(triangle);
  const std::size_t count = cells_.size();
  for (std::size_t i = 0; i < count && !is_full_; ++i) insert_in(i, number);
}

/// True if the cell's last layer is opaque and nearer than the triangle over the whole polygon.
bool PixelCells::is_hidden(const ConvexPolygon& polygon, const Cell& cell, const PixelTriangle& triangle) const {
  if (cell.layers == 0) return false;
  const PixelTriangle& last = triangles_[layers_[cell.first_layer + cell.layers - 1]];
  return last.alpha_mode == AlphaMode::Opaque && order_over(polygon, triangle, last) == Order::Behind;
}

void PixelCells::insert_in(std::size_t at, std::uint32_t number) {
  // Most cells do not overlap the triangle or hide it, which is tested before anything is cut.
  const PixelTriangle& triangle = triangles_[number];
  if (triangle.covers_all) {
    if (is_hidden(cells_[at].polygon, cells_[at], triangle)) return;
  } else {
    for (const Line& edge : triangle.edge)
      if (is_outside(cells_[at].polygon, edge)) return;
    ConvexPolygon overlap = cells_[at].polygon;
    for (const Line& edge : triangle.edge) {
      overlap = clipped(overlap, edge);
      if (overlap.empty()) return;
    }
    if (is_hidden(overlap, cells_[at], triangle)) return;
  }
  const Cell cell = cells_[at];
  if (triangle.is_piece)
    for (const std::uint32_t layer : layers_of(cell))
      if (triangles_[layer].id == triangle.id) return;

  // The region of the cell outside the triangle is stored unchanged, in up to three parts; the triangle is inserted
  // into the layers of the rest.
  free_ = at;
  ConvexPolygon rest = cell.polygon, inside, outside;
  if (!triangle.covers_all)
    for (const Line& edge : triangle.edge) {
      cut(rest, edge, inside, outside);
      if (!outside.empty()) store(outside, cell.first_layer, cell.layers);
      rest = inside;
    }
  pieces_.assign(1, {rest, 0});
  sort_in(cell, number);
}

void PixelCells::sort_in(const Cell& cell, std::uint32_t number) {
  while (!pieces_.empty() && !is_full_) {
    const Piece piece = pieces_.back();
    pieces_.pop_back();
    if (piece.polygon.count <= many_corners) {
      if (!piece.polygon.empty()) place(piece, cell, number);
      continue;
    }
    ConvexPolygon first, second;
    halve(piece.polygon, first, second);
    pieces_.push_back({second, piece.next_layer});
    pieces_.push_back({first, piece.next_layer});
  }
}

/// Finds the piece's first layer behind the triangle, and cuts the piece where they intersect.
void PixelCells::place(const Piece& piece, const Cell& cell, std::uint32_t number) {
  // Triangles are usually inserted nearest first: a triangle behind the last layer is behind all layers.
  const PixelTriangle& triangle = triangles_[number];
  if (cell.layers > 1) {
    const PixelTriangle& last = triangles_[layers_[cell.first_layer + cell.layers - 1]];
    if (last.alpha_mode != AlphaMode::Opaque && order_over(piece.polygon, triangle, last) == Order::Behind)
      return store_with(piece.polygon, cell, cell.layers, number);
  }
  for (std::uint32_t at = piece.next_layer; at < cell.layers; ++at) {
    const PixelTriangle& layer = triangles_[layers_[cell.first_layer + at]];
    const Order order = order_over(piece.polygon, triangle, layer);
    if (order == Order::InFront) return store_with(piece.polygon, cell, at, number);
    const bool is_last = layer.alpha_mode == AlphaMode::Opaque;
    if (order == Order::Behind) {
      if (is_last) return store(piece.polygon, cell.first_layer, cell.layers);
      continue;
    }
    ConvexPolygon inside, outside;
    cut(piece.polygon, crossing(triangle, layer), inside, outside);
    if (is_last)
      store(outside, cell.first_layer, cell.layers);
    else
      pieces_.push_back({outside, at + 1});
    return store_with(inside, cell, at, number);
  }
  store_with(piece.polygon, cell, cell.layers, number);
}

void PixelCells::store(const ConvexPolygon& polygon, std::uint32_t first_layer, std::uint32_t layers) {
  if (polygon.count > many_corners) {
    ConvexPolygon first, second;
    halve(polygon, first, second);
    store(first, first_layer, layers);
    return store(second, first_layer, layers);
  }
  if (free_ < cells_.size()) {
    cells_[free_] = {polygon, first_layer, layers};
    free_ = cells_.size();
    return;
  }
  cells_.push_back({polygon, first_layer, layers});
  free_ = cells_.size();
  is_full_ = is_full_ || cells_.size() > max_cells || layers_.size() > max_layers;
}

/// Stores the cell's layers with the triangle inserted before layer `at`; an opaque triangle is the last layer.
void PixelCells::store_with(const ConvexPolygon& polygon, const Cell& cell, std::uint32_t at, std::uint32_t number) {
  if (at == cell.layers && cell.first_layer + at == layers_.size()) {
    is_full_ = layers_.size() >= max_layers;
    // The cell's list is at the end: the lists of other cells that start with it keep their lengths.
    layers_.push_back(number);
    return store(polygon, cell.first_layer, at + 1);
  }
  if (layers_.size() + cell.layers >= max_layers) {
    is_full_ = true;
    return;
  }
  const auto first = static_cast<std::uint32_t>(layers_.size());
  const std::uint32_t behind = triangles_[number].alpha_mode == AlphaMode::Opaque ? 0 : cell.layers - at;
  for (std::uint32_t i = 0; i < at; ++i) layers_.push_back(layers_[cell.first_layer + i]);
  layers_.push_back(number);
  for (std::uint32_t i = at; i < at + behind; ++i) layers_.push_back(layers_[cell.first_layer + i]);
  store(polygon, first, at + 1 + behind);
}

}  // namespace zoneplate::antialias
