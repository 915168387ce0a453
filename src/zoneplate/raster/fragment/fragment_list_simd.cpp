// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/fragment/fragment_list.h"

#include <hwy/highway.h>

#include "zoneplate/math/elementary_simd.h"
#include "zoneplate/raster/coverage/coverage.h"
#include "zoneplate/raster/geometry/packing_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {

using DI = hn::CappedTag<std::int32_t, 8>;
using DF = hn::CappedTag<float, 8>;
using VI = hn::Vec<DI>;
using MI = hn::Mask<DI>;
using VF = hn::Vec<DF>;
constexpr DI i32;
constexpr DF f32;
constexpr int lanes = static_cast<int>(hn::MaxLanes(DI()));

HWY_INLINE VI set(std::int32_t v) { return hn::Set(i32, v); }

/// The samples of a pixel that one triangle owns, a bit each, and the sum of their positions.
struct Owned {
  VI samples, summands;
};

/// floor((x + n / 2) / n) for integers, n <= 16, with `half` = n / 2 + 1/64 and `inverse` = 1 / n. The 1/64 keeps the
/// rounded product from falling below an integer, and is too small to reach the next one.
HWY_INLINE VI mean(VI x, VF half, VF inverse) {
  return truncated(f32, hn::Mul(hn::Add(hn::ConvertTo(f32, x), half), inverse));
}

/// The bit of each sample.
struct SampleBits {
  alignas(64) std::int32_t bit[FragmentList::max_samples][lanes];
};
constexpr SampleBits make_sample_bits() {
  SampleBits b{};
  for (int s = 0; s < FragmentList::max_samples; ++s)
    for (std::int32_t& bit : b.bit[s]) bit = 1 << s;
  return b;
}
constexpr SampleBits sample_bits = make_sample_bits();

HWY_INLINE VI bit_of(int s) { return hn::Load(i32, sample_bits.bit[s]); }

/// The pixels of a row that are drawn, from one on.
HWY_INLINE MI drawn_lanes(const OwnerRow& row, int first) {
  alignas(64) static constexpr std::int32_t bits[8] = {1, 2, 4, 8, 16, 32, 64, 128};
  const VI drawn = set(static_cast<std::int32_t>(row.drawn >> first));
  return hn::Ne(hn::And(drawn, hn::Load(i32, bits)), hn::Zero(i32));
}

/// Appends the fragments of the mask's lanes.
HWY_INLINE void add(MI mask, VI x, VI y, VI owner, VI at, FragmentList& out) {
  const int count = out.count;
  std::int32_t* const to = reinterpret_cast<std::int32_t*>(out.at) + count;
  if (hn::AllTrue(i32, mask)) {
    hn::StoreU(x, i32, out.x + count), hn::StoreU(y, i32, out.y + count);
    hn::StoreU(owner, i32, out.id + count), hn::StoreU(at, i32, to);
    out.count = count + lanes;
    return;
  }
  const Packing<DI> packing(mask);
  packing.store(x, out.x + count), packing.store(y, out.y + count);
  packing.store(owner, out.id + count), packing.store(at, to);
  out.count = count + packing.count();
}

/// The owners of a vector of pixels.
class Pixels {
 public:
  HWY_INLINE Pixels(const OwnerRow& row, int first)
      : id_(row.id + first),
        samples_(row.sample_count),
        is_per_sample_(row.is_per_sample),
        first_summand_(row.first_summand),
        more_summands_(row.more_summands),
        whole_(row.whole),
        x_(hn::Add(set(row.x + first * 256), hn::ShiftLeft<8>(hn::Iota(i32, 0)))),
        y_(set(row.y)),
        at_(hn::Add(set(static_cast<std::int32_t>(row.pixel) + first), hn::Iota(i32, 0))),
        listed_(hn::VecFromMask(i32, hn::Not(drawn_lanes(row, first)))) {}

  /// Lists the owners of sample s at pixels where s is the first sample that they own.
  HWY_INLINE void list(int s, FragmentList& out) {
    const VI owner = owner_of(s), bit = bit_of(s);
    const MI is_new = hn::Eq(hn::And(listed_, bit), hn::Zero(i32));
    const MI mask = hn::AndNot(hn::Eq(owner, set(no_primitive)), is_new);
    if (hn::AllFalse(i32, mask)) return;
    Owned owned{bit, set(first_summand_[s])};
    if (!is_per_sample_) {
      for (int t = s + 1; t < samples_; ++t) {
        const VI is_own = hn::VecFromMask(i32, hn::Eq(owner, owner_of(t)));
        owned.samples = hn::Or(owned.samples, hn::And(is_own, bit_of(t)));
        owned.summands = hn::Add(owned.summands, hn::And(is_own, set(more_summands_[t])));
      }
      listed_ = hn::Or(listed_, hn::IfThenElseZero(mask, owned.samples));
    }
    add(mask, owner, owned, out);
  }

 private:
  HWY_INLINE VI owner_of(int s) const { return hn::LoadU(i32, id_ + s * sample_stride); }

  /// Appends the fragments of the mask.
  HWY_INLINE void add(MI mask, VI owner, const Owned& owned, FragmentList& out) const {
    const VF n = hn::ConvertTo(f32, hn::ShiftRight<24>(owned.summands)), inverse = hn::Div(hn::Set(f32, 1), n);
    const VF half = hn::Add(hn::Mul(n, hn::Set(f32, 0.5f)), hn::Set(f32, 1 / 64.0f));
    const VI all = set((1 << samples_) - 1), low = set(4095);
    const MI is_whole = is_per_sample_ ? hn::Ne(all, all) : hn::Eq(owned.samples, all);
    const VI x = hn::IfThenElse(is_whole, set(whole_.x), mean(hn::And(owned.summands, low), half, inverse));
    const VI y =
        hn::IfThenElse(is_whole, set(whole_.y), mean(hn::And(hn::ShiftRight<12>(owned.summands), low), half, inverse));
    HWY_NAMESPACE::add(mask, hn::Add(x_, x), hn::Add(y_, y), owner, hn::Add(at_, hn::ShiftLeft<12>(owned.samples)),
                       out);
  }

  const std::int32_t* id_;
  int samples_;
  bool is_per_sample_;
  const std::int32_t *first_summand_, *more_summands_;
  SamplePosition whole_;
  VI x_, y_, at_;
  VI listed_;  ///< the samples whose owners are listed or not drawn: a bit each
};

/// Lists a vector of pixels with one sample each.
HWY_INLINE void list_single(const OwnerRow& row, int first, FragmentList& out) {
  const VI pixel = hn::Iota(i32, first), owner = hn::LoadU(i32, row.id + first);
  const MI mask = hn::And(hn::Ne(owner, set(no_primitive)), drawn_lanes(row, first));
  if (hn::AllFalse(i32, mask)) return;
  const VI x = hn::Add(set(row.x + row.whole.x), hn::ShiftLeft<8>(pixel));
  const VI at = hn::Add(set(static_cast<std::int32_t>(row.pixel) + (1 << 12)), pixel);
  add(mask, x, set(row.y + row.whole.y), owner, at, out);
}

// Vectors of fewer than eight lanes keep the order of eight lanes: by first samples, then by pixels.
void list(const OwnerRow& row, FragmentList& out) {
  if (row.sample_count == 1 && !row.is_per_sample) {
    for (int first = 0; first < FragmentBatch::group; first += lanes) list_single(row, first, out);
  } else if constexpr (lanes == FragmentBatch::group) {
    Pixels pixels(row, 0);
    for (int s = 0; s < row.sample_count; ++s) pixels.list(s, out);
  } else {
    Pixels left(row, 0), right(row, lanes);
    for (int s = 0; s < row.sample_count; ++s) left.list(s, out), right.list(s, out);
  }
}

using DF4 = hn::FixedTag<float, 4>;
using VF4 = hn::Vec<DF4>;

/// Transposes the channels of four fragments to four pixels, and back.
struct Turned {
  VF4 v[4];
  HWY_INLINE Turned(VF4 r, VF4 g, VF4 b, VF4 a) {
    const DF4 d;
    const VF4 rb01 = hn::InterleaveLower(d, r, b), rb23 = hn::InterleaveUpper(d, r, b);
    const VF4 ga01 = hn::InterleaveLower(d, g, a), ga23 = hn::InterleaveUpper(d, g, a);
    v[0] = hn::InterleaveLower(d, rb01, ga01), v[1] = hn::InterleaveUpper(d, rb01, ga01);
    v[2] = hn::InterleaveLower(d, rb23, ga23), v[3] = hn::InterleaveUpper(d, rb23, ga23);
  }
};

HWY_INLINE void add_one(VF4 color, float weight, std::uint32_t at, float* sum) {
  const DF4 d;
  float* const to = sum + 4 * FragmentList::pixel(at);
  hn::StoreU(hn::Add(hn::LoadU(d, to), hn::Mul(color, hn::Set(d, weight))), d, to);
}

void add(const FragmentOutputs& color, const std::uint32_t* at, const float* weight, int count, float* sum) {
  const DF4 d;
  for (int i = 0; i < count; i += 4) {
    const Turned turned(hn::Load(d, color.r + i), hn::Load(d, color.g + i), hn::Load(d, color.b + i),
                        hn::Load(d, color.a + i));
    const int n = count - i < 4 ? count - i : 4;
    for (int k = 0; k < n; ++k) add_one(turned.v[k], weight[i + k], at[i + k], sum);
  }
}

void divide(const float* sum, float weight, Linear8& out) {
  const DF4 d;
  const VF4 by = hn::Set(d, weight);
  for (int i = 0; i < Linear8::size; i += 4) {
    const float* const of = sum + 4 * i;
    const Turned turned(hn::LoadU(d, of), hn::LoadU(d, of + 4), hn::LoadU(d, of + 8), hn::LoadU(d, of + 12));
    hn::Store(hn::Div(turned.v[0], by), d, out.r + i), hn::Store(hn::Div(turned.v[1], by), d, out.g + i);
    hn::Store(hn::Div(turned.v[2], by), d, out.b + i), hn::Store(hn::Div(turned.v[3], by), d, out.a + i);
  }
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const FragmentListKernels PerIsa<FragmentListKernels>::HWY_NAMESPACE = {
    .list = HWY_NAMESPACE::list, .add = HWY_NAMESPACE::add, .divide = HWY_NAMESPACE::divide};
}  // namespace zoneplate
