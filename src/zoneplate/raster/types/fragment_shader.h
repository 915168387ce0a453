#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "zoneplate/raster/types/batch.h"

namespace zoneplate {

/// Gives colour to surface points, a batch at a time. Called from many threads at once.
class FragmentShader {
 public:
  virtual ~FragmentShader() = default;
  struct OutputMask {
    bool normal = false, uv = false, albedo = false;
  };
  virtual void shade(const FragmentBatch& batch, OutputMask wanted, FragmentOutputs& out) const = 0;
  /// Alpha of masked surfaces' points, and the cutoff at and above which such a point is there.
  virtual float alpha(const FragmentBatch& batch, float* out) const = 0;
  /// What no channel of any surface's colour, premultiplied, is above; it bounds how many layers are shaded.
  virtual float brightest() const { return std::numeric_limits<float>::infinity(); }
  /// Whether a material's batches need dbdx and dbdy.
  virtual bool needs_derivatives([[maybe_unused]] int material) const { return true; }
  /// Where shading reads of an instance's vertices: vertex v at first + v × stride, so that it may be asked for before
  /// it is needed; null: nowhere.
  struct VertexMemory {
    const std::byte* first = nullptr;
    std::size_t stride = 0;
  };
  virtual VertexMemory vertex_memory([[maybe_unused]] std::uint32_t instance, [[maybe_unused]] int material) const {
    return {};
  }
};

}  // namespace zoneplate
