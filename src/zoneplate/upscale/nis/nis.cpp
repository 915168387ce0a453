// SPDX-License-Identifier: Apache-2.0
// NVIDIA Image Scaling: a separable filter of six taps, replaced by filters along the direction of an edge where one is
// detected, with sharpening that fades with contrast. Only luma is filtered so; colour is bilinear.
//
// Its input is to be antialiased. Weakness: four directions only, so that shallow slopes keep their steps; corrections
// of luma change the saturation of colours; lines break where the detected direction changes.
//
// Source: NVIDIA, Image Scaling SDK 1.0.3 (NIS_Scaler.h, NIS_Config.h), 2021.
#include "zoneplate/upscale/nis/nis.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/upscale/alpha.h"
#include "zoneplate/upscale/axis.h"
#include "zoneplate/upscale/nis/taps.h"

namespace zoneplate {
namespace upscale {
namespace {

constexpr int rows_a_block = 32;
constexpr Param own_scale_param = real_param("scale", "image size over render size, per axis", 1.5, 1, 2);
constexpr Param params[] = {own_scale_param, real_param("sharpness", "from 0, no sharpening, to 1", 0.5, 0, 1)};

/// Calls body(y) for all rows, in parallel for blocks of rows.
template <class Body>
void for_rows(int height, const Body& body) {
  parallel_ranges(static_cast<std::size_t>(height), rows_a_block, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) body(y);
  });
}

const float* floats(const DisplayImage& image, int y) { return &image.row(y).data()->r; }
float* floats(DisplayImage& image, int y) { return &image.row(y).data()->r; }

/// The lumas of an image and of three pixels at its sides, and the edges of the image and of one pixel around it.
class Luma {
 public:
  Luma(const DisplayImage& image, const NisConstants& constants)
      : luma_(image.width() + 2 * nis_border, image.height()), edges_(image.width() + 2, image.height() + 2) {
    const NisKernels& kernels = NisKernels::of();
    for_rows(image.height(), [&](int y) {
      const std::span<float> row = luma_.row(y);
      kernels.luma_row(floats(image, y), row.data() + nis_border, static_cast<std::size_t>(image.width()));
      std::fill_n(row.begin(), nis_border, row[nis_border]);
      std::fill_n(row.end() - nis_border, nis_border, *(row.end() - nis_border - 1));
    });
    for_rows(edges_.height(), [&](int y) {
      const int skipped = nis_border - 1;
      kernels.edge_row(luma(y - 2) + skipped, luma(y - 1) + skipped, luma(y) + skipped, constants, floats(edges_, y),
                       static_cast<std::size_t>(edges_.width()));
    });
  }
  /// Row y, clamped to the image, from three pixels before the image.
  const float* luma(int y) const { return luma_.row(std::clamp(y, 0, luma_.height() - 1)).data(); }
  /// Row y >= -1, from one pixel before the image.
  const float* edges(int y) const { return floats(edges_, std::clamp(y + 1, 0, edges_.height() - 1)); }
  std::size_t width() const { return static_cast<std::size_t>(luma_.width()); }

 private:
  Plane<float> luma_;
  DisplayImage edges_;  ///< four weights per pixel
};

std::int32_t phase_of(float beyond) { return static_cast<std::int32_t>(beyond * static_cast<float>(nis_phases)); }

/// What the rows of an output have in common.
struct Columns {
  std::vector<std::int32_t> luma, edge, pixel[2], phase;
  std::vector<float> right;

  Columns(const Crop& made, const UpscaleGrid& grid, int width) {
    Axis axis = Axis::by_centre(made.x, made.x + made.width, grid.to.width, grid.width);
    for (std::size_t i = 0; i < axis.first.size(); ++i) {
      const int x = std::clamp(axis.first[i] - grid.x, -1, width - 1);
      luma.push_back(x - 2 + nis_border);
      edge.push_back(4 * (x + 1));
      for (int k = 0; k < 2; ++k) pixel[k].push_back(4 * std::clamp(x + k, 0, width - 1));
      phase.push_back(phase_of(axis.beyond[i]));
    }
    right = std::move(axis.beyond);
  }
};

DisplayImage scaled(const DisplayImage& image, const UpscaleGrid& grid, const NisConstants& constants) {
  const Crop made = grid.made();
  const Luma luma(image, constants);
  const NisTaps taps = nis_taps();
  const NisKernels& kernels = NisKernels::of();
  const Columns columns(made, grid, image.width());
  const Axis axis = Axis::by_centre(made.y, made.y + made.height, grid.to.height, grid.height);
  DisplayImage out(made.width, made.height);
  parallel_ranges(static_cast<std::size_t>(made.height), rows_a_block, [&](std::size_t begin, std::size_t end) {
    std::vector<float> filtered(luma.width());
    for (std::size_t o = begin; o < end; ++o) {
      const int y = axis.first[o] - grid.y;
      NisRow row{.columns = filtered.data(),
                 .edges = {luma.edges(y), luma.edges(y + 1)},
                 .luma = columns.luma.data(),
                 .edge = columns.edge.data(),
                 .pixel = {columns.pixel[0].data(), columns.pixel[1].data()},
                 .right = columns.right.data(),
                 .right_phase = columns.phase.data(),
                 .below = axis.beyond[o],
                 .below_phase = phase_of(axis.beyond[o])};
      for (int t = 0; t < 6; ++t) row.lumas[t] = luma.luma(y - 2 + t);
      for (int k = 0; k < 2; ++k) row.pixels[k] = floats(image, std::clamp(y + k, 0, image.height() - 1));
      kernels.column_row(row.lumas, taps.scale + 8 * row.below_phase, filtered.data(), luma.width());
      kernels.scale_row(row, taps, constants, floats(out, static_cast<int>(o)), static_cast<std::size_t>(made.width));
    }
  });
  return out;
}

DisplayImage sharpened(const DisplayImage& image, const UpscaleGrid& grid, const NisConstants& constants) {
  const Crop made = grid.made();
  const Luma luma(image, constants);
  DisplayImage out(made.width, made.height);
  const int left = made.x - grid.x;
  for_rows(made.height, [&](int o) {
    const int y = made.y + o - grid.y;
    const float* rows[5];
    for (int t = 0; t < 5; ++t) rows[t] = luma.luma(y - 2 + t) + nis_border + left;
    NisKernels::of().sharpen_row(rows, luma.edges(y) + std::ptrdiff_t{4} * (left + 1),
                                 floats(image, y) + std::ptrdiff_t{4} * left, constants, floats(out, o),
                                 static_cast<std::size_t>(made.width));
  });
  return out;
}

class Nis : public SpatialUpscaler {
 public:
  explicit Nis(float sharpness) : sharpness_(sharpness) {}
  int radius() const override { return 3 + continued_radius; }
  DisplayImage upscale(const DisplayImage& image, const UpscaleGrid& grid) const override {
    return upscale_nis(image, grid, sharpness_);
  }

 private:
  float sharpness_;
};

}  // namespace

DisplayImage upscale_nis(const DisplayImage& image, const UpscaleGrid& grid, float sharpness) {
  // A frame of half an odd size is rounded down.
  if (grid.to.width > 2 * grid.width + 1 || grid.to.height > 2 * grid.height + 1)
    throw Error(ErrorKind::Usage, "nis: the output is more than twice as large as the input, which is its limit");
  const bool is_same_size = grid.to.width == grid.width && grid.to.height == grid.height;
  const NisConstants constants(sharpness);
  return filter_with_alpha(
      image, grid,
      [&](const DisplayImage& values) {
        return is_same_size ? sharpened(values, grid, constants) : scaled(values, grid, constants);
      },
      &Display::g);
}

Upscaler nis() {
  return {.name = "nis",
          .summary = "NVIDIA Image Scaling: six taps along four directions, with sharpening of luma",
          .source = "NVIDIA 2021, SDK 1.0.3",
          .params = params,
          .make_spatial = [](const Settings& s) -> std::unique_ptr<SpatialUpscaler> {
            return std::make_unique<Nis>(static_cast<float>(s.number("sharpness")));
          }};
}

}  // namespace upscale
}  // namespace zoneplate
