// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "zoneplate/antialias/post/rows.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

/// A buffer for one row of a filter's result: it starts as a copy of the source row, is modified while it is in the
/// cache, and is written to the result by `end`.
///
/// Requires  both images have the same size and outlive this object.
/// Cost      large results are written with streaming stores, past the caches.
class ResultRow {
 public:
  ResultRow(const Rgba8Image& from, Rgba8Image& to);

  std::span<Rgba8> begin(int y);
  void end();

 private:
  const Rgba8Image& from_;
  Rgba8Image& to_;
  const RowKernels& kernels_;
  std::vector<Rgba8> values_;
  int y_ = 0;
};

}  // namespace zoneplate::antialias
