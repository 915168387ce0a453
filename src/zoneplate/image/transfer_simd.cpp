#include "zoneplate/image/transfer_simd.h"

#include "zoneplate/image/transfer_kernels.h"
#include "zoneplate/math/for_lanes_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {

void encode(const float* linear, float* code, std::size_t n) {
  for_lanes(n, [=](auto d, std::size_t i) { hn::StoreU(encode_srgb(d, hn::LoadU(d, linear + i)), d, code + i); });
}

void decode(const float* code, float* linear, std::size_t n) {
  for_lanes(n, [=](auto d, std::size_t i) { hn::StoreU(decode_srgb(d, hn::LoadU(d, code + i)), d, linear + i); });
}

template <class T>
HWY_INLINE void quantize(float greatest, const float* values, T* codes, std::size_t n) {
  for_lanes(n, [=](auto d, std::size_t i) {
    const hn::Rebind<T, decltype(d)> dt;
    const auto x = clamp_unit(d, hn::LoadU(d, values + i));
    const auto scaled = hn::Add(hn::Mul(x, hn::Set(d, greatest)), hn::Set(d, 0.5f));
    hn::StoreU(hn::DemoteTo(dt, truncated(d, scaled)), dt, codes + i);
  });
}

void quantize8(const float* values, std::uint8_t* codes, std::size_t n) { quantize(255.0f, values, codes, n); }

void quantize16(const float* values, std::uint16_t* codes, std::size_t n) { quantize(65535.0f, values, codes, n); }

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const TransferKernels PerIsa<TransferKernels>::HWY_NAMESPACE = {.encode = HWY_NAMESPACE::encode,
                                                                .decode = HWY_NAMESPACE::decode,
                                                                .quantize8 = HWY_NAMESPACE::quantize8,
                                                                .quantize16 = HWY_NAMESPACE::quantize16};
}  // namespace zoneplate
