#include "zoneplate/raster/point_list.h"

#include <hwy/highway.h>

#include "zoneplate/raster/coverage.h"
#include "zoneplate/raster/packing_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {

using I = hn::CappedTag<std::int32_t, 8>;
using F = hn::CappedTag<float, 8>;
using VI = hn::Vec<I>;
using MI = hn::Mask<I>;
using VF = hn::Vec<F>;
constexpr I i32;
constexpr F f32;
constexpr int lanes = static_cast<int>(hn::MaxLanes(I()));

HWY_INLINE VI set(std::int32_t v) { return hn::Set(i32, v); }

/// The samples of a pixel that one triangle owns, a bit each, and the sum of their places.
struct Owned {
  VI samples, places;
};

/// floor((x + n / 2) / n) of whole numbers, n <= 16, where `half` is n / 2 + 1/64 and `inverse` 1 / n: what is added
/// keeps the product's rounding from going below a whole number, and is too little to reach the next.
HWY_INLINE VI mean(VI x, VF half, VF inverse) {
  return hn::ConvertTo(i32, hn::Mul(hn::Add(hn::ConvertTo(f32, x), half), inverse));
}

/// A vector's width of pixels.
class Pixels {
 public:
  HWY_INLINE Pixels(const OwnerRow& row, int first)
      : row_(row),
        id_(row.id + first),
        wanted_(hn::Ne(hn::And(hn::ShiftRightSame(set(static_cast<std::int32_t>(row.wanted)), first), bit_of_lane()),
                       hn::Zero(i32))),
        x_(hn::Add(set(row.x + first * 256), hn::ShiftLeft<8>(hn::Iota(i32, 0)))),
        at_(hn::Add(set(static_cast<std::int32_t>(row.pixel) + first), hn::Iota(i32, 0))) {}

  HWY_INLINE VI owner(int s) const { return hn::LoadU(i32, id_ + s * tile_pixels); }
  HWY_INLINE MI is_there(VI owner) const { return hn::AndNot(hn::Eq(owner, set(no_triangle)), wanted_); }

  /// Adds those of the mask.
  HWY_INLINE void put(MI mask, VI owner, const Owned& owned, PointList& out) const {
    VI x = set(128), y = set(128);
    if (row_.sample_count > 1 || row_.is_per_sample) {
      const VF n = hn::ConvertTo(f32, hn::ShiftRight<24>(owned.places)), inverse = hn::Div(hn::Set(f32, 1), n);
      const VF half = hn::Add(hn::Mul(n, hn::Set(f32, 0.5f)), hn::Set(f32, 1 / 64.0f));
      const VI all = set((1 << row_.sample_count) - 1), low = set(4095);
      const MI is_centre = row_.is_per_sample ? hn::Ne(all, all) : hn::Eq(owned.samples, all);
      x = hn::IfThenElse(is_centre, x, mean(hn::And(owned.places, low), half, inverse));
      y = hn::IfThenElse(is_centre, y, mean(hn::And(hn::ShiftRight<12>(owned.places), low), half, inverse));
    }
    x = hn::Add(x_, x), y = hn::Add(set(row_.y), y);
    const VI at = hn::Add(at_, hn::ShiftLeft<12>(owned.samples));
    std::int32_t* const to = reinterpret_cast<std::int32_t*>(out.at) + out.count;
    if (hn::AllTrue(i32, mask)) {
      hn::StoreU(x, i32, out.x + out.count), hn::StoreU(y, i32, out.y + out.count);
      hn::StoreU(owner, i32, out.id + out.count), hn::StoreU(at, i32, to);
      out.count += lanes;
      return;
    }
    const Packing packing(mask);
    packing.store(x, out.x + out.count), packing.store(y, out.y + out.count);
    packing.store(owner, out.id + out.count), packing.store(at, to);
    out.count += packing.count();
  }

 private:
  static HWY_INLINE VI bit_of_lane() {
    alignas(64) static constexpr std::int32_t bits[8] = {1, 2, 4, 8, 16, 32, 64, 128};
    return hn::Load(i32, bits);
  }
  const OwnerRow& row_;
  const std::int32_t* id_;
  MI wanted_;
  VI x_, at_;
};

HWY_INLINE void list_first_at(const Pixels& pixels, const OwnerRow& row, int s, PointList& out) {
  const VI owner = pixels.owner(s);
  MI mask = pixels.is_there(owner);
  Owned owned{set(1 << s), set(row.first_place[s])};
  if (row.is_per_sample) {
    if (!hn::AllFalse(i32, mask)) pixels.put(mask, owner, owned, out);
    return;
  }
  for (int t = 0; t < s; ++t) mask = hn::AndNot(hn::Eq(owner, pixels.owner(t)), mask);
  if (hn::AllFalse(i32, mask)) return;
  for (int t = s + 1; t < row.sample_count; ++t) {
    const MI is_own = hn::Eq(owner, pixels.owner(t));
    owned.samples = hn::Or(owned.samples, hn::IfThenElseZero(is_own, set(1 << t)));
    owned.places = hn::Add(owned.places, hn::IfThenElseZero(is_own, set(row.more_places[t])));
  }
  pixels.put(mask, owner, owned, out);
}

// Vectors of fewer than eight lanes keep the order of eight: by first samples, and of those by pixels.
void list(const OwnerRow& row, PointList& out) {
  for (int s = 0; s < row.sample_count; ++s)
    for (int first = 0; first < Batch::group; first += lanes) list_first_at(Pixels(row, first), row, s, out);
}

using Quad = hn::FixedTag<float, 4>;
using VQ = hn::Vec<Quad>;

/// Four points' channels to four points and back.
struct Turned {
  VQ v[4];
  HWY_INLINE Turned(VQ r, VQ g, VQ b, VQ a) {
    const Quad d;
    const VQ rb01 = hn::InterleaveLower(d, r, b), rb23 = hn::InterleaveUpper(d, r, b);
    const VQ ga01 = hn::InterleaveLower(d, g, a), ga23 = hn::InterleaveUpper(d, g, a);
    v[0] = hn::InterleaveLower(d, rb01, ga01), v[1] = hn::InterleaveUpper(d, rb01, ga01);
    v[2] = hn::InterleaveLower(d, rb23, ga23), v[3] = hn::InterleaveUpper(d, rb23, ga23);
  }
};

HWY_INLINE void add_one(VQ color, float weight, std::uint32_t at, float* sum) {
  const Quad d;
  float* const to = sum + 4 * PointList::pixel(at);
  hn::StoreU(hn::Add(hn::LoadU(d, to), hn::Mul(color, hn::Set(d, weight))), d, to);
}

void add(const Shaded& color, const std::uint32_t* at, const float* weight, int count, float* sum) {
  const Quad d;
  for (int i = 0; i < count; i += 4) {
    const Turned turned(hn::Load(d, color.r + i), hn::Load(d, color.g + i), hn::Load(d, color.b + i),
                        hn::Load(d, color.a + i));
    const int n = count - i < 4 ? count - i : 4;
    for (int k = 0; k < n; ++k) add_one(turned.v[k], weight[i + k], at[i + k], sum);
  }
}

void divide(const float* sum, float weight, Linear8& out) {
  const Quad d;
  const VQ by = hn::Set(d, weight);
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
const PointListKernels PointListKernels::HWY_NAMESPACE = {
    .list = HWY_NAMESPACE::list, .add = HWY_NAMESPACE::add, .divide = HWY_NAMESPACE::divide};
}  // namespace zoneplate
