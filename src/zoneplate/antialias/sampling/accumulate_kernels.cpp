#include "zoneplate/antialias/sampling/accumulate_kernels.h"

namespace zoneplate::scalar {
namespace {

using Kernels = AccumulateKernels;

float greater(float a, float b) { return a > b ? a : b; }

float greatest(const float* c) { return greater(greater(c[0], c[1]), greater(c[2], 0)); }

void weigh_karis(float exposure, float* color, float* weight, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    float* const c = color + 4 * i;
    const float luma = greater((Kernels::luma[0] * c[0] + Kernels::luma[1] * c[1]) + Kernels::luma[2] * c[2], 0);
    weight[i] = 1 / (1 + luma * exposure);
    for (int k = 0; k < 4; ++k) c[k] = c[k] * weight[i];
  }
}

void map_max3(float* color, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float scale = 1 / (1 + greatest(color + 4 * i));
    for (std::size_t k = 0; k < 3; ++k) color[4 * i + k] *= scale;
  }
}

void premultiply(float* color, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < 3; ++k) color[4 * i + k] *= color[4 * i + 3];
}

void spread(const float* in, std::size_t step, const float* across, int taps, const float* down, float* const* rows,
            int row_count, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    float sum = across[0] * in[i];
    for (int d = 1; d < taps; ++d) sum += across[d] * in[i + static_cast<std::size_t>(d) * step];
    for (int k = 0; k < row_count; ++k) rows[k][i] += down[k] * sum;
  }
}

void mean(const float* color, const float* weight, bool is_max3, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    float c[4];
    for (std::size_t k = 0; k < 4; ++k) c[k] = color[4 * i + k] / weight[i];
    const float most = greatest(c), held = most < Kernels::greatest_mapped ? most : Kernels::greatest_mapped;
    const float scale = is_max3 ? 1 / (1 - held) : 1.0f;
    for (std::size_t k = 0; k < 3; ++k) out[4 * i + k] = c[k] * scale;
    out[4 * i + 3] = c[3];
  }
}

}  // namespace

}  // namespace zoneplate::scalar

namespace zoneplate {

template <>
const AccumulateKernels PerIsa<AccumulateKernels>::scalar = {.weigh_karis = scalar::weigh_karis,
                                                             .map_max3 = scalar::map_max3,
                                                             .premultiply = scalar::premultiply,
                                                             .spread = scalar::spread,
                                                             .mean = scalar::mean};

}  // namespace zoneplate
