// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/result_row.h"

#include <cassert>
#include <cstring>

namespace zoneplate {
namespace antialias {
namespace {

/// Results of at least this size are written past the caches: a quarter of a typical last-level cache.
constexpr std::size_t min_streamed = 8 << 20;

}  // namespace

ResultRow::ResultRow(const Rgba8Image& from, Rgba8Image& to)
    : from_(from), to_(to), kernels_(RowKernels::of()), values_(static_cast<std::size_t>(from.width())) {
  assert(to.width() == from.width() && to.height() == from.height());
}

std::span<Rgba8> ResultRow::begin(int y) {
  y_ = y;
  const std::span<const Rgba8> row = from_.row(y);
  kernels_.copy(&row[0].r, &values_[0].r, row.size_bytes());
  return values_;
}

void ResultRow::end() {
  const std::span<Rgba8> row = to_.row(y_);
  const bool is_large = to_.values().size() * sizeof(Rgba8) >= min_streamed;
  (is_large ? kernels_.stream : kernels_.copy)(&values_[0].r, &row[0].r, row.size_bytes());
}

}  // namespace antialias
}  // namespace zoneplate
