// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/math/halves_simd.h"
#include "zoneplate/scene/geometry/smooth_sums.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using K = SmoothSumKernels;
using D = hn::CappedTag<float, 8>;
using V = hn::Vec<D>;
using Words = hn::Rebind<std::uint32_t, D>;
constexpr D d;
constexpr Words words;
constexpr std::size_t lanes = sizeof(V) / sizeof(float);

struct Vectors {
  V x, y, z;
};

HWY_INLINE V dot(const Vectors& a, const Vectors& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vectors operator-(const Vectors& a, const Vectors& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vectors cross(const Vectors& a, const Vectors& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

/// A group of `lanes` triangles, one per lane. A load reads one float beyond a vertex, so that copies are loaded if the
/// group contains the last vertex or has fewer triangles than lanes.
class Group {
 public:
  HWY_INLINE Group(const std::uint32_t* index, std::size_t triangles, std::size_t vertices)
      : index_(index), count_(triangles < lanes ? triangles : lanes) {
    if (count_ == lanes && !has(static_cast<std::uint32_t>(vertices - 1))) return;
    has_copies_ = true;
  }

  HWY_INLINE std::size_t count() const { return count_; }
  HWY_INLINE std::uint32_t vertex(std::size_t i, std::size_t k) const { return index_[3 * i + k]; }

  /// The three floats of corner k.
  HWY_INLINE Vectors corner(const float* list, std::size_t k) const {
    if (HWY_LIKELY(!has_copies_)) return load([&](std::size_t i) { return list + std::size_t{3} * vertex(i, k); });
    float copies[lanes][4] = {};
    for (std::size_t i = 0; i < lanes; ++i)
      for (std::size_t c = 0; c < 3; ++c) copies[i][c] = list[std::size_t{3} * vertex(i < count_ ? i : 0, k) + c];
    return load([&](std::size_t i) { return copies[i]; });
  }

  /// Whether none, some or all corners of a group are in the range.
  enum class Share { None, Some, All };
  HWY_INLINE Share share(VertexRange own) const {
    if (count_ < lanes || own.size == 0) return Share::Some;
    const auto begin = hn::Set(words, own.begin), last = hn::Set(words, own.size - 1);
    auto all = hn::Zero(words), any = hn::Zero(words);  // masks of the corners in the range
    for (std::size_t part = 0; part < 3; ++part) {
      const auto place = hn::Sub(hn::LoadU(words, index_ + part * lanes), begin);
      const auto is_here = hn::VecFromMask(words, hn::Eq(hn::Min(place, last), place));
      all = part == 0 ? is_here : hn::And(all, is_here);
      any = hn::Or(any, is_here);
    }
    if (hn::AllFalse(words, hn::MaskFromVec(any))) return Share::None;
    return hn::AllTrue(words, hn::MaskFromVec(all)) ? Share::All : Share::Some;
  }

 private:
  HWY_INLINE bool has(std::uint32_t v) const {
    const auto vertex = hn::Set(words, v);
    const auto is = [&](std::size_t part) {
      return hn::VecFromMask(words, hn::Eq(hn::LoadU(words, index_ + part * lanes), vertex));
    };
    return !hn::AllFalse(words, hn::MaskFromVec(hn::Or(hn::Or(is(0), is(1)), is(2))));
  }

  /// Loads four floats per lane and discards the fourth.
  template <class Place>
  static HWY_INLINE Vectors load(const Place& place) {
    const hn::CappedTag<float, 4> four;
    const auto row = [&](std::size_t i) {
      if constexpr (lanes == 8)
        return combined(d, hn::LoadU(four, place(i + 4)), hn::LoadU(four, place(i)));
      else
        return hn::LoadU(four, place(i));
    };
    const V a = row(0), b = row(1), c = row(2), e = row(3);
    const V low_even = hn::InterleaveLower(d, a, c), low_odd = hn::InterleaveLower(d, b, e);
    return {hn::InterleaveLower(d, low_even, low_odd), hn::InterleaveUpper(d, low_even, low_odd),
            hn::InterleaveLower(d, hn::InterleaveUpper(d, a, c), hn::InterleaveUpper(d, b, e))};
  }

  const std::uint32_t* index_;
  std::size_t count_;
  bool has_copies_ = false;
};

/// The contributions of a group's triangles at one corner: pairs of x and y, and z.
struct Shares {
  alignas(32) float pair[2 * lanes], z[lanes];

  HWY_INLINE void set(const Vectors& area, V scale) {
    const V x = hn::Mul(area.x, scale), y = hn::Mul(area.y, scale);
    const V low = hn::InterleaveLower(d, x, y), high = hn::InterleaveUpper(d, x, y);
    if constexpr (lanes == 8) {
      hn::Store(hn::ConcatLowerLower(d, high, low), d, pair);
      hn::Store(hn::ConcatUpperUpper(d, high, low), d, pair + lanes);
    } else {
      hn::Store(low, d, pair);
      hn::Store(high, d, pair + lanes);
    }
    hn::Store(hn::Mul(area.z, scale), d, z);
  }
  HWY_INLINE void add(std::size_t i, float* sum) const {
    const hn::CappedTag<float, 2> two;
    hn::StoreU(hn::Add(hn::LoadU(two, sum), hn::LoadU(two, pair + 2 * i)), two, sum);
    sum[2] += z[i];
  }
};

HWY_INLINE void measure(const Group& group, const float* position, Shares* shares) {
  const Vectors a = group.corner(position, 0), b = group.corner(position, 1), c = group.corner(position, 2);
  const Vectors ab = b - a, ac = c - a, bc = c - b, area = cross(ab, ac);
  const V square = dot(area, area), ab_square = dot(ab, ab), ac_square = dot(ac, ac), bc_square = dot(bc, bc);
  const V products[3] = {hn::Mul(ab_square, ac_square), hn::Mul(ab_square, bc_square), hn::Mul(ac_square, bc_square)};
  auto is_sound = hn::Gt(square, hn::Mul(hn::Set(d, K::thin), products[0]));
  for (const V p : products) {
    is_sound = hn::And(is_sound, hn::Gt(p, hn::Set(d, K::min_square)));
    is_sound = hn::And(is_sound, hn::Lt(p, hn::Set(d, K::max_square)));
  }
  const V one = hn::IfThenElse(is_sound, hn::Set(d, 1), hn::Set(d, __builtin_nanf("")));
  for (std::size_t k = 0; k < 3; ++k) shares[k].set(area, hn::Div(one, products[k]));
}

void add(const float* position, std::size_t vertices, const std::uint32_t* index, std::size_t triangles,
         VertexRange own, float* sum) {
  Shares shares[3];
  for (std::size_t first = 0; first < triangles; first += lanes) {
    const Group group(index + 3 * first, triangles - first, vertices);
    const Group::Share share = group.share(own);
    if (share == Group::Share::None) continue;
    measure(group, position, shares);
    if (share == Group::Share::All) {
      for (std::size_t i = 0; i < lanes; ++i)
        for (std::size_t k = 0; k < 3; ++k) shares[k].add(i, sum + std::size_t{3} * group.vertex(i, k));
    } else {
      for (std::size_t i = 0; i < group.count(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
          if (const std::uint32_t v = group.vertex(i, k); v - own.begin < own.size)
            shares[k].add(i, sum + std::size_t{3} * v);
    }
  }
}

void normalize(float* sum, std::size_t count, char* mark) {
  for (std::size_t first = 0; first < count; first += lanes) {
    const std::size_t here = count - first < lanes ? count - first : lanes;
    float copies[3 * lanes] = {};
    float* const n = here < lanes ? copies : sum + 3 * first;
    for (std::size_t i = 0; here < lanes && i < 3 * here; ++i) copies[i] = sum[3 * first + i];
    Vectors v;
    hn::LoadInterleaved3(d, n, v.x, v.y, v.z);
    const V square = dot(v, v), scale = hn::Div(hn::Set(d, 1), hn::Sqrt(square));
    const auto is_sound = hn::And(hn::Gt(square, hn::Set(d, K::min_square)), hn::Lt(square, hn::Set(d, K::max_square)));
    const V zero = hn::Zero(d);
    hn::StoreInterleaved3(hn::IfThenElse(is_sound, hn::Mul(v.x, scale), zero),
                          hn::IfThenElse(is_sound, hn::Mul(v.y, scale), hn::Set(d, 1)),
                          hn::IfThenElse(is_sound, hn::Mul(v.z, scale), zero), d, n);
    for (std::size_t i = 0; here < lanes && i < 3 * here; ++i) sum[3 * first + i] = copies[i];
    if (HWY_LIKELY(hn::AllTrue(d, is_sound))) continue;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, is_sound, bits);
    for (std::size_t i = 0; i < here; ++i)
      if ((bits[0] >> i & 1) == 0) mark[first + i] = 1;
  }
}

void mark_turns(const float* position, const float* normal, std::size_t vertices, const std::uint32_t* index,
                std::size_t triangles, char* mark) {
  const V zero = hn::Zero(d);
  for (std::size_t first = 0; first < triangles; first += lanes) {
    const Group group(index + 3 * first, triangles - first, vertices);
    const Vectors a = group.corner(position, 0), b = group.corner(position, 1), c = group.corner(position, 2);
    const Vectors area = cross(b - a, c - a);
    const V least = hn::Mul(hn::Set(d, K::cos_25_squared), dot(area, area));
    for (std::size_t k = 0; k < 3; ++k) {
      const V along = dot(group.corner(normal, k), area);
      const auto is_even = hn::And(hn::Gt(along, zero), hn::Gt(hn::Mul(along, along), least));
      if (HWY_LIKELY(hn::AllTrue(d, is_even))) continue;
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, is_even, bits);
      for (std::size_t i = 0; i < group.count(); ++i)
        if ((bits[0] >> i & 1) == 0) __atomic_store_n(&mark[group.vertex(i, k)], char{1}, __ATOMIC_RELAXED);
    }
  }
}

}  // namespace
}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const SmoothSumKernels PerIsa<SmoothSumKernels>::HWY_NAMESPACE = {
    .add = HWY_NAMESPACE::add, .normalize = HWY_NAMESPACE::normalize, .mark_turns = HWY_NAMESPACE::mark_turns};
}  // namespace zoneplate
