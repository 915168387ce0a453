// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/masks.h"

#include <algorithm>

namespace zoneplate::antialias {

void MaskedPolygons::clear() {
  edges_.clear();
  stored_.clear();
  layers_.clear();
  answers_.clear();
}

void MaskedPolygons::begin_pixel(int x, int y) {
  x_ = x, y_ = y;
  stored_before_ = stored_.size(), layers_before_ = layers_.size();
  answers_before_ = answers_.size(), asked_before_ = edges_.size();
  masked_.clear();
  known_answer_.clear();
}

void MaskedPolygons::abandon_pixel() {
  stored_.resize(stored_before_);
  layers_.resize(layers_before_);
  answers_.resize(answers_before_);
  edges_.shrink(asked_before_);
}

/// Assigns an index to each masked triangle of the pixel; false if there are too many.
bool MaskedPolygons::knows_masked(std::span<const Layer> layers) {
  for (const Layer& layer : layers) {
    if (layer.alpha_mode != AlphaMode::Mask || std::ranges::find(masked_, layer.id) != masked_.end()) continue;
    if (masked_.size() == max_triangles) return false;
    masked_.push_back(layer.id);
    known_answer_.resize(masked_.size() * static_cast<std::size_t>(grid_ * grid_), 0);
  }
  return true;
}

bool MaskedPolygons::add(const ConvexPolygon& polygon, std::span<const Layer> layers) {
  const auto max_polygons = static_cast<std::size_t>(std::max(8192, 4 * grid_ * grid_));
  if (!knows_masked(layers) || stored_.size() - stored_before_ > max_polygons) return false;
  for_grid(polygon, {0, 0}, 1.0 / grid_, grid_, [&](int column, int row, const ConvexPolygon& p) {
    store(p, static_cast<std::uint32_t>(row * grid_ + column), layers);
  });
  return true;
}

void MaskedPolygons::store(const ConvexPolygon& polygon, std::uint32_t part, std::span<const Layer> layers) {
  stored_.push_back({polygon, x_, y_, part, static_cast<std::uint32_t>(layers_.size()),
                     static_cast<std::uint32_t>(layers.size()), static_cast<std::uint32_t>(answers_.size())});
  layers_.insert(layers_.end(), layers.begin(), layers.end());
  for (const Layer& layer : layers)
    if (layer.alpha_mode == AlphaMode::Mask) answers_.push_back(answer_of(layer.id, part));
}

std::uint32_t MaskedPolygons::answer_of(std::int32_t id, std::uint32_t part) {
  const auto number = static_cast<std::size_t>(std::ranges::find(masked_, id) - masked_.begin());
  std::uint32_t& known = known_answer_[number * static_cast<std::size_t>(grid_ * grid_) + part];
  if (known == 0) known = edges_.add_query(x_, y_, id, part) + 1;
  return known - 1;
}

void MaskedPolygons::resolve(AreaFragmentList& out) {
  edges_.solve();
  for (std::size_t i = 0; i < stored_.size(); ++i) {
    const Stored& s = stored_[i];
    if (i == 0 || s.x != stored_[i - 1].x || s.y != stored_[i - 1].y) out.begin_pixel(s.x, s.y);
    seen_.clear();
    walk(s, s.polygon, 0, s.first_answer, out);
  }
}

/// Adds the visible parts of a piece behind seen_, from a layer on; `answer` is the index of the next masked layer's
/// query.
void MaskedPolygons::walk(const Stored& stored, const ConvexPolygon& polygon, std::uint32_t layer, std::uint32_t answer,
                          AreaFragmentList& out) {
  if (polygon.count > many_corners) {
    ConvexPolygon first, second;
    halve(polygon, first, second);
    walk(stored, first, layer, answer, out);
    return walk(stored, second, layer, answer, out);
  }
  const std::size_t in_front = seen_.size();
  for (; layer < stored.layers; ++layer) {
    const Layer& here = layers_[stored.first_layer + layer];
    if (here.alpha_mode == AlphaMode::Mask) break;
    seen_.push_back(here);
  }
  if (layer == stored.layers) {
    if (!seen_.empty()) out.add_fine(polygon, stored.part, seen_);
  } else {
    edges_.split(
        answers_[answer], polygon,
        [&](const ConvexPolygon& piece) {
          seen_.push_back(layers_[stored.first_layer + layer]);
          out.add_fine(piece, stored.part, seen_);
          seen_.pop_back();
        },
        [&](const ConvexPolygon& piece) { walk(stored, piece, layer + 1, answer + 1, out); });
  }
  seen_.resize(in_front);
}

}  // namespace zoneplate::antialias
