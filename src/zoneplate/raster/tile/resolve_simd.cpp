// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/resolve.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using D = hn::CappedTag<float, 8>;
using V = hn::Vec<D>;
constexpr D d;

/// Applies `step` to the vectors of each channel.
template <class Step>
HWY_INLINE void each_channel(const FragmentOutputs& color, int first, Linear8& out, Step step) {
  for (std::size_t i = 0; i < Linear8::size; i += hn::Lanes(d)) {
    const std::size_t p = static_cast<std::size_t>(first) + i;
    step(hn::Load(d, color.r + p), out.r + i, i), step(hn::Load(d, color.g + p), out.g + i, i);
    step(hn::Load(d, color.b + p), out.b + i, i), step(hn::Load(d, color.a + p), out.a + i, i);
  }
}

template <class Step>
HWY_INLINE void each_channel(const Linear8& color, Linear8& out, Step step) {
  for (std::size_t i = 0; i < Linear8::size; i += hn::Lanes(d)) {
    step(hn::Load(d, color.r + i), out.r + i), step(hn::Load(d, color.g + i), out.g + i);
    step(hn::Load(d, color.b + i), out.b + i), step(hn::Load(d, color.a + i), out.a + i);
  }
}

/// A sum divided by its weight; a weight of 1 leaves it unchanged.
struct Mean {
  V weight;
  bool is_one;
  explicit HWY_INLINE Mean(float w) : weight(hn::Set(d, w)), is_one(w == 1) {}
  HWY_INLINE V operator()(V sum) const { return is_one ? sum : hn::Div(sum, weight); }
};

void resolve(const FragmentOutputs& color, int first, int rows, float weight, Linear8* const* out) {
  const V zero = hn::Zero(d), w = hn::Set(d, weight);
  const auto each_row = [&](auto mean) HWY_ATTR {
    for (int row = 0; row < rows; ++row)
      each_channel(color, first + row * FragmentBatch::group, *out[row],
                   [&](V c, float* to, std::size_t) HWY_ATTR { hn::Store(mean(c), d, to); });
  };
  if (cancels_exactly(weight)) return each_row([&](V c) HWY_ATTR { return hn::Add(zero, c); });
  each_row([&](V c) HWY_ATTR { return hn::Div(hn::Add(zero, hn::Mul(c, w)), w); });
}

/// The layers in front, over the colour behind them.
HWY_INLINE V laid_over(V front, hn::Mask<D> is_open, V behind, V transmittance) {
  return hn::IfThenElse(is_open, hn::Add(front, hn::Mul(behind, transmittance)), front);
}

HWY_INLINE void put_row_under(const FragmentOutputs& color, int first, float transmittance_cutoff,
                              TransparentStack8& layers) {
  const V least = hn::Set(d, transmittance_cutoff), one = hn::Set(d, 1.0f);
  layers.is_open = false;
  for (std::size_t i = 0; i < Linear8::size; i += hn::Lanes(d)) {
    const std::size_t p = static_cast<std::size_t>(first) + i;
    const V t = hn::Load(d, layers.transmittance + i);
    const auto is_open = hn::Gt(t, least);
    const auto add = [&](const float* from, float* to) HWY_ATTR {
      hn::Store(laid_over(hn::Load(d, to + i), is_open, hn::Load(d, from + p), t), d, to + i);
    };
    add(color.r, layers.r), add(color.g, layers.g), add(color.b, layers.b);
    const V rest = hn::Mul(t, hn::Sub(one, hn::Load(d, color.a + p)));
    const V seen = hn::IfThenElse(is_open, rest, t);
    hn::Store(seen, d, layers.transmittance + i);
    layers.is_open = layers.is_open || !hn::AllFalse(d, hn::Gt(seen, least));
  }
}

void composite_under(const FragmentOutputs& color, int first, float least, TransparentStack8& layers) {
  put_row_under(color, first, least, layers);
}

void composite_spans_under(const FragmentOutputs& color, int rows, float least, TransparentStack8* const* layers) {
  for (int row = 0; row < rows; ++row) put_row_under(color, row * FragmentBatch::group, least, *layers[row]);
}

void over(const TransparentStack8& layers, Linear8& behind) {
  const V one = hn::Set(d, 1.0f);
  for (std::size_t i = 0; i < Linear8::size; i += hn::Lanes(d)) {
    const V t = hn::Load(d, layers.transmittance + i);
    const auto is_open = hn::Gt(t, hn::Zero(d));
    const auto add = [&](const float* front, float* to) HWY_ATTR {
      hn::Store(laid_over(hn::Load(d, front + i), is_open, hn::Load(d, to + i), t), d, to + i);
    };
    add(layers.r, behind.r), add(layers.g, behind.g), add(layers.b, behind.b);
    const V missing = hn::Mul(hn::Sub(one, hn::Load(d, behind.a + i)), t);
    hn::Store(hn::IfThenElse(is_open, hn::Sub(one, missing), one), d, behind.a + i);
  }
}

void resolve_samples(const Linear8& color, const float* weights, int samples, float weight_sum, Linear8& out) {
  const Mean mean(weight_sum);
  each_channel(color, out, [&](V c, float* to) HWY_ATTR {
    V sum = hn::Zero(d);
    for (int s = 0; s < samples; ++s) sum = hn::Add(sum, hn::Mul(c, hn::Set(d, weights[s])));
    hn::Store(mean(sum), d, to);
  });
}

void add(const FragmentOutputs& color, int first, float weight, Linear8& sum) {
  const V w = hn::Set(d, weight);
  each_channel(color, first, sum, [&](V c, float* to, std::size_t) HWY_ATTR {
    hn::Store(hn::Add(hn::Load(d, to), hn::Mul(c, w)), d, to);
  });
}

void divide(const Linear8& sum, float weight, Linear8& out) {
  const Mean mean(weight);
  each_channel(sum, out, [&](V c, float* to) HWY_ATTR { hn::Store(mean(c), d, to); });
}

// Transposes the channels of four fragments to four pixels, one pixel a vector.
void store(const Linear8& color, Linear* out) {
  const hn::FixedTag<float, 4> d4;
  for (std::size_t i = 0; i < Linear8::size; i += 4) {
    const auto r = hn::Load(d4, color.r + i), g = hn::Load(d4, color.g + i);
    const auto b = hn::Load(d4, color.b + i), a = hn::Load(d4, color.a + i);
    const auto rb01 = hn::InterleaveLower(d4, r, b), rb23 = hn::InterleaveUpper(d4, r, b);
    const auto ga01 = hn::InterleaveLower(d4, g, a), ga23 = hn::InterleaveUpper(d4, g, a);
    hn::StoreU(hn::InterleaveLower(d4, rb01, ga01), d4, &out[i].r);
    hn::StoreU(hn::InterleaveUpper(d4, rb01, ga01), d4, &out[i + 1].r);
    hn::StoreU(hn::InterleaveLower(d4, rb23, ga23), d4, &out[i + 2].r);
    hn::StoreU(hn::InterleaveUpper(d4, rb23, ga23), d4, &out[i + 3].r);
  }
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const ResolveKernels PerIsa<ResolveKernels>::HWY_NAMESPACE = {
    .resolve = HWY_NAMESPACE::resolve,
    .composite_under = HWY_NAMESPACE::composite_under,
    .composite_spans_under = HWY_NAMESPACE::composite_spans_under,
    .over = HWY_NAMESPACE::over,
    .resolve_samples = HWY_NAMESPACE::resolve_samples,
    .add = HWY_NAMESPACE::add,
    .divide = HWY_NAMESPACE::divide,
    .store = HWY_NAMESPACE::store};
}  // namespace zoneplate
