// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/fragments.h"

#include <algorithm>

namespace zoneplate::antialias {
namespace {

constexpr std::uint32_t hashes = 256;  // hash values of a pixel's fragments

}  // namespace

void AreaFragmentTable::clear() {
  fragments_.clear();
  weights_.clear();
  layers_.clear();
}

void AreaFragmentTable::begin_pixel(int x, int y) {
  x_ = x, y_ = y;
  first_of_pixel_ = fragments_.size(), layers_of_pixel_ = layers_.size();
  head_.assign(hashes, -1);
}

void AreaFragmentTable::abandon_pixel() {
  fragments_.resize(first_of_pixel_);
  weights_.resize(first_of_pixel_ * weights_each_);
  layers_.resize(layers_of_pixel_);
  head_.assign(hashes, -1);
}

void AreaFragmentTable::append(const AreaFragment& fragment, Layer layer, std::span<const double> weights) {
  fragments_.push_back(fragment);
  fragments_.back().first_layer = static_cast<std::uint32_t>(layers_.size());
  fragments_.back().layers = 1;
  layers_.push_back(layer);
  weights_.insert(weights_.end(), weights.begin(), weights.end());
}

std::size_t AreaFragmentTable::find(std::uint32_t part, bool is_fine, std::span<const Layer> layers) {
  std::int32_t& head = head_[(static_cast<std::uint32_t>(layers[0].id) + part * 31u) % hashes];
  for (std::int32_t i = head; i >= 0; i = next_[static_cast<std::size_t>(i)]) {
    const AreaFragment& f = fragments_[static_cast<std::size_t>(i)];
    if (f.part == part && f.is_fine == is_fine && std::ranges::equal(layers_of(f), layers))
      return static_cast<std::size_t>(i);
  }
  const std::size_t added = fragments_.size();
  const auto first = static_cast<std::uint32_t>(layers_.size()), count = static_cast<std::uint32_t>(layers.size());
  layers_.insert(layers_.end(), layers.begin(), layers.end());
  fragments_.push_back({x_, y_, part, first, count, {}, is_fine});
  weights_.resize(fragments_.size() * weights_each_);
  next_.resize(fragments_.size(), -1);
  next_[added] = head;
  head = static_cast<std::int32_t>(added);
  return added;
}

AreaFragmentList::AreaFragmentList(const PolynomialFilter& filter, int shading)
    : filter_(filter), shading_(shading), table_(filter.weight_count()) {
  for_grid(unit_square(), {0, 0}, 1.0 / shading_, shading_, [&](int, int, const ConvexPolygon& part) {
    whole_.push_back(area_moments(part));
    whole_weights_.resize(whole_.size() * filter_.weight_count());
    filter_.add_weights(part, std::span(whole_weights_).last(filter_.weight_count()));
  });
}

void AreaFragmentList::add_whole(std::int32_t id, int x, int y) {
  for (std::size_t i = 0; i < whole_.size(); ++i)
    table_.append({.x = x, .y = y, .part = static_cast<std::uint32_t>(i), .moments = whole_[i]},
                  {id, AlphaMode::Opaque},
                  std::span(whole_weights_).subspan(i * filter_.weight_count(), filter_.weight_count()));
}

void AreaFragmentList::add(const ConvexPolygon& polygon, std::span<const Layer> layers) {
  if (shading_ == 1) return add_part(polygon, 0, false, layers);
  for_grid(polygon, {0, 0}, 1.0 / shading_, shading_, [&](int column, int row, const ConvexPolygon& p) {
    add_part(p, static_cast<std::uint32_t>(row * shading_ + column), false, layers);
  });
}

void AreaFragmentList::add_fine(const ConvexPolygon& polygon, std::uint32_t part, std::span<const Layer> layers) {
  add_part(polygon, part, true, layers);
}

void AreaFragmentList::add_part(const ConvexPolygon& polygon, std::uint32_t part, bool is_fine,
                                std::span<const Layer> layers) {
  const std::size_t i = table_.find(part, is_fine, layers);
  const AreaMoments m = area_moments(polygon);
  AreaMoments& sum = table_.fragment(i).moments;
  sum = {sum.area + m.area, sum.x + m.x, sum.y + m.y};
  filter_.add_weights(polygon, table_.weights_of(i));
}

}  // namespace zoneplate::antialias
