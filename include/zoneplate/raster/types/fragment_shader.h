// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "zoneplate/raster/types/batch.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// Computes the colours of fragments, a batch at a time. Its functions are called from many threads at once.
class FragmentShader {
 public:
  virtual ~FragmentShader() = default;
  /// Writes the required results of the batch's fragments, each to the entry of its index.
  virtual void shade(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const = 0;
  /// Writes the alpha of each fragment and returns the cutoff: an alpha-tested surface is present where alpha is at
  /// least the cutoff.
  virtual float alpha(const FragmentBatch& batch, float* out) const = 0;
  /// An upper bound of every channel of any surface's colour, premultiplied; it bounds how many transparent layers are
  /// shaded.
  virtual float brightest() const { return std::numeric_limits<float>::infinity(); }
  /// Whether a material's batches need dbdx and dbdy.
  virtual bool needs_derivatives([[maybe_unused]] int material) const { return true; }
  /// Whether batches need their coverage.
  virtual bool needs_coverage() const { return false; }
  /// The memory of an instance's vertices that shading reads: vertex v at first + v × stride. The rasterizer prefetches
  /// it. Null: shading reads none.
  struct VertexMemory {
    const std::byte* first = nullptr;  ///< vertex 0
    std::size_t stride = 0;            ///< bytes from one vertex to the next
  };
  /// The memory to prefetch for fragments of an instance; none by default.
  virtual VertexMemory vertex_memory([[maybe_unused]] std::uint32_t instance, [[maybe_unused]] int material) const {
    return {};
  }
};

}  // namespace zoneplate
#pragma GCC visibility pop
