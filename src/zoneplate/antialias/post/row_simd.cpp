#include <hwy/highway.h>

#include <hwy/cache_control.h>

#include "zoneplate/antialias/post/row_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using Bytes = hn::CappedTag<std::uint8_t, 32>;
constexpr Bytes db;

void copy(const std::uint8_t* from, std::uint8_t* to, std::size_t n) {
  const std::size_t lanes = hn::Lanes(db);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) hn::StoreU(hn::LoadU(db, from + i), db, to + i);
  for (; i < n; ++i) to[i] = from[i];
}

void stream(const std::uint8_t* from, std::uint8_t* to, std::size_t n) {
  const std::size_t lanes = hn::Lanes(db);
  std::size_t i = 0;
  for (; i < n && reinterpret_cast<std::uintptr_t>(to + i) % lanes != 0; ++i) to[i] = from[i];
  for (; i + lanes <= n; i += lanes) hn::Stream(hn::LoadU(db, from + i), db, to + i);
  for (; i < n; ++i) to[i] = from[i];
  hwy::FlushStream();
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const RowKernels PerIsa<RowKernels>::HWY_NAMESPACE = {.copy = HWY_NAMESPACE::copy, .stream = HWY_NAMESPACE::stream};
}  // namespace zoneplate
