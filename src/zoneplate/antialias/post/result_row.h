#pragma once

#include <span>
#include <vector>

#include "zoneplate/antialias/post/rows.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

/// One row of a filter's result at a time: it begins as the picture's, is changed where it lies in the caches, and is
/// written to the result when it is done.
///
/// Requires  both pictures of one size; they outlive it.
/// Cost      a large result goes past the caches, which would not keep it anyway.
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
