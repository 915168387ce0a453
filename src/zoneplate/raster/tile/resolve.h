// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/image/pixel.h"
#include "zoneplate/raster/types/batch.h"

namespace zoneplate {

/// Transparent layers of a pixel, composited front to back: their colour, and the transmittance to what is behind them.
///
/// Exact     in float, as written. Layers behind a transmittance of `transmittance_cutoff` or less are left out, and
///           are not shaded.
/// Source    Porter and Duff, Compositing Digital Images, 1984: over, from the front.
struct TransparentStack {
  float r = 0, g = 0, b = 0;
  float transmittance = 1;

  /// colour += layer × transmittance; transmittance ×= 1 - alpha. No effect if the transmittance is not above `least`.
  void composite_under(const Linear& layer, float least);
  /// The layers over the colour behind all of them. The result is opaque if that colour is.
  Linear over(const Linear& behind) const;
};

/// The transmittance at or below which layers are left out, if no channel of a surface exceeds `brightest`: everything
/// behind it, the opaque surface included, changes a channel by at most 2^-25, half of the smallest half float. 0 for
/// +infinity: no layer is left out.
inline float transmittance_cutoff(float brightest) { return 0x1p-25f / (brightest > 1 ? brightest : 1.0f); }

/// The same for eight pixels of a row.
struct alignas(64) TransparentStack8 {
  static constexpr int size = Linear8::size;
  float r[size], g[size], b[size], transmittance[size];
  bool is_open;  ///< some pixel's transmittance is above the limit

  void clear();
};

/// True if multiplication and division by a weight cancel exactly: it is a power of two.
inline bool cancels_exactly(float weight) { return (std::bit_cast<std::uint32_t>(weight) & 0x7fffffu) == 0; }

/// Sums and means of samples, for spans of eight pixels whose fragments are consecutive in `color`, from `first` on.
///
/// Exact     in float, as written: products, sums from 0 on in the order of the samples, one division.
struct ResolveKernels : PerIsa<ResolveKernels> {
  /// out = (0 + color × weight) / weight: one surface owns all samples. For consecutive spans.
  void (*resolve)(const FragmentOutputs& color, int first, int rows, float weight, Linear8* const* out);
  /// TransparentStack::composite_under for eight fragments.
  void (*composite_under)(const FragmentOutputs& color, int first, float least, TransparentStack8& layers);
  /// The same for consecutive spans, from the first fragment on.
  void (*composite_spans_under)(const FragmentOutputs& color, int rows, float least, TransparentStack8* const* layers);
  /// TransparentStack::over.
  void (*over)(const TransparentStack8& layers, Linear8& behind);
  /// out = ((0 + color × weights[0]) + color × weights[1] + ...) / weight_sum.
  void (*resolve_samples)(const Linear8& color, const float* weights, int samples, float weight_sum, Linear8& out);
  /// sum += color × weight.
  void (*add)(const FragmentOutputs& color, int first, float weight, Linear8& sum);
  /// out = sum / weight.
  void (*divide)(const Linear8& sum, float weight, Linear8& out);
  /// The pixels one by one.
  void (*store)(const Linear8& color, Linear* out);
};

}  // namespace zoneplate
