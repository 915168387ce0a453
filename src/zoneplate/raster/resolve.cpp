#include "zoneplate/raster/resolve.h"

namespace zoneplate::scalar {
namespace {

Linear at(const Shaded& color, int i) { return {color.r[i], color.g[i], color.b[i], color.a[i]}; }
Linear divided(Linear c, float weight) { return {c.r / weight, c.g / weight, c.b / weight, c.a / weight}; }

void resolve(const Shaded& color, int first, float weight, Linear* out) {
  for (int i = 0; i < Batch::group; ++i) out[i] = divided(Linear{0, 0, 0, 0} + at(color, first + i) * weight, weight);
}

void over(const float* color, float* behind) {
  for (int i = 0; i < Batch::group; ++i)
    for (int c = 0; c < 4; ++c)
      behind[c * Batch::group + i] =
          color[c * Batch::group + i] + behind[c * Batch::group + i] * (1 - color[3 * Batch::group + i]);
}

void resolve_samples(const float* color, const float* weights, int samples, float weight_sum, Linear* out) {
  for (int i = 0; i < Batch::group; ++i) {
    const Linear c{color[i], color[Batch::group + i], color[2 * Batch::group + i], color[3 * Batch::group + i]};
    Linear sum{0, 0, 0, 0};
    for (int s = 0; s < samples; ++s) sum = sum + c * weights[s];
    out[i] = divided(sum, weight_sum);
  }
}

void add(const Shaded& color, int first, float weight, Linear* sum) {
  for (int i = 0; i < Batch::group; ++i) sum[i] = sum[i] + at(color, first + i) * weight;
}

void divide(const Linear* sum, float weight, int n, Linear* out) {
  for (int i = 0; i < n; ++i) out[i] = divided(sum[i], weight);
}

}  // namespace

const ResolveKernels resolve_kernels = {
    .resolve = resolve, .over = over, .resolve_samples = resolve_samples, .add = add, .divide = divide};

}  // namespace zoneplate::scalar
