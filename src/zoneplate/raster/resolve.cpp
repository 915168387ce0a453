#include "zoneplate/raster/resolve.h"

namespace zoneplate::scalar {
namespace {

constexpr auto size = Linear8::size;

Linear at(const Shaded& color, int first, std::size_t i) {
  const std::size_t p = static_cast<std::size_t>(first) + i;
  return {color.r[p], color.g[p], color.b[p], color.a[p]};
}
Linear divided(Linear c, float weight) { return {c.r / weight, c.g / weight, c.b / weight, c.a / weight}; }

void resolve(const Shaded& color, int first, float weight, Linear8& out) {
  for (std::size_t i = 0; i < size; ++i) out.set(i, divided(Linear{0, 0, 0, 0} + at(color, first, i) * weight, weight));
}

void over(const Shaded& color, int first, Linear8& behind) {
  for (std::size_t i = 0; i < size; ++i) {
    const Linear front = at(color, first, i);
    behind.set(i, front + behind.get(i) * (1 - front.a));
  }
}

void over_rows(const Shaded& color, int rows, Linear8* const* behind) {
  for (int row = 0; row < rows; ++row) over(color, row * Batch::group, *behind[row]);
}

void resolve_samples(const Linear8& color, const float* weights, int samples, float weight_sum, Linear8& out) {
  for (std::size_t i = 0; i < size; ++i) {
    Linear sum{0, 0, 0, 0};
    for (int s = 0; s < samples; ++s) sum = sum + color.get(i) * weights[s];
    out.set(i, divided(sum, weight_sum));
  }
}

void add(const Shaded& color, int first, float weight, Linear8& sum) {
  for (std::size_t i = 0; i < size; ++i) sum.set(i, sum.get(i) + at(color, first, i) * weight);
}

void divide(const Linear8& sum, float weight, Linear8& out) {
  for (std::size_t i = 0; i < size; ++i) out.set(i, divided(sum.get(i), weight));
}

void put(const Linear8& color, Linear* out) {
  for (std::size_t i = 0; i < size; ++i) out[i] = color.get(i);
}

}  // namespace

const ResolveKernels resolve_kernels = {.resolve = resolve,
                                        .over = over,
                                        .over_rows = over_rows,
                                        .resolve_samples = resolve_samples,
                                        .add = add,
                                        .divide = divide,
                                        .put = put};

}  // namespace zoneplate::scalar
