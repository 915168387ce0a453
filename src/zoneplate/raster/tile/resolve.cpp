// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/resolve.h"

#include <algorithm>

namespace zoneplate {

void TransparentStack::composite_under(const Linear& layer, float least) {
  if (!(transmittance > least)) return;
  r = r + layer.r * transmittance, g = g + layer.g * transmittance, b = b + layer.b * transmittance;
  transmittance = transmittance * (1 - layer.a);
}

Linear TransparentStack::over(const Linear& behind) const {
  if (!(transmittance > 0)) return {r, g, b, 1};
  return {r + behind.r * transmittance, g + behind.g * transmittance, b + behind.b * transmittance,
          1 - (1 - behind.a) * transmittance};
}

void TransparentStack8::clear() {
  for (float* const channel : {r, g, b}) std::fill_n(channel, size, 0.0f);
  std::fill_n(transmittance, size, 1.0f);
  is_open = true;
}

namespace scalar {
namespace {

constexpr auto size = Linear8::size;

Linear at(const FragmentOutputs& color, int first, std::size_t i) {
  const std::size_t p = static_cast<std::size_t>(first) + i;
  return {color.r[p], color.g[p], color.b[p], color.a[p]};
}
Linear divided(Linear c, float weight) { return {c.r / weight, c.g / weight, c.b / weight, c.a / weight}; }

void resolve(const FragmentOutputs& color, int first, int rows, float weight, Linear8* const* out) {
  for (int row = 0; row < rows; ++row, first += FragmentBatch::group)
    for (std::size_t i = 0; i < size; ++i)
      out[row]->set(i, divided(Linear{0, 0, 0, 0} + at(color, first, i) * weight, weight));
}

TransparentStack get(const TransparentStack8& layers, std::size_t i) {
  return {layers.r[i], layers.g[i], layers.b[i], layers.transmittance[i]};
}

void composite_under(const FragmentOutputs& color, int first, float least, TransparentStack8& layers) {
  layers.is_open = false;
  for (std::size_t i = 0; i < size; ++i) {
    TransparentStack l = get(layers, i);
    l.composite_under(at(color, first, i), least);
    layers.r[i] = l.r, layers.g[i] = l.g, layers.b[i] = l.b, layers.transmittance[i] = l.transmittance;
    layers.is_open = layers.is_open || l.transmittance > least;
  }
}

void composite_spans_under(const FragmentOutputs& color, int rows, float least, TransparentStack8* const* layers) {
  for (int row = 0; row < rows; ++row) composite_under(color, row * FragmentBatch::group, least, *layers[row]);
}

void over(const TransparentStack8& layers, Linear8& behind) {
  for (std::size_t i = 0; i < size; ++i) behind.set(i, get(layers, i).over(behind.get(i)));
}

void resolve_samples(const Linear8& color, const float* weights, int samples, float weight_sum, Linear8& out) {
  for (std::size_t i = 0; i < size; ++i) {
    Linear sum{0, 0, 0, 0};
    for (int s = 0; s < samples; ++s) sum = sum + color.get(i) * weights[s];
    out.set(i, divided(sum, weight_sum));
  }
}

void add(const FragmentOutputs& color, int first, float weight, Linear8& sum) {
  for (std::size_t i = 0; i < size; ++i) sum.set(i, sum.get(i) + at(color, first, i) * weight);
}

void divide(const Linear8& sum, float weight, Linear8& out) {
  for (std::size_t i = 0; i < size; ++i) out.set(i, divided(sum.get(i), weight));
}

void store(const Linear8& color, Linear* out) {
  for (std::size_t i = 0; i < size; ++i) out[i] = color.get(i);
}

}  // namespace

}  // namespace scalar

template <>
const ResolveKernels PerIsa<ResolveKernels>::scalar = {.resolve = scalar::resolve,
                                                       .composite_under = scalar::composite_under,
                                                       .composite_spans_under = scalar::composite_spans_under,
                                                       .over = scalar::over,
                                                       .resolve_samples = scalar::resolve_samples,
                                                       .add = scalar::add,
                                                       .divide = scalar::divide,
                                                       .store = scalar::store};
}  // namespace zoneplate
