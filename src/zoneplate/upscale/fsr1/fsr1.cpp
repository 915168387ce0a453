// SPDX-License-Identifier: Apache-2.0
// FidelityFX Super Resolution 1.0: an upscaling pass whose kernel of twelve taps is turned and stretched along edges
// (EASU), and a sharpening pass (RCAS).
//
// Both passes work on display-referred values, as AMD prescribes. EASU interpolates edges, it does not smooth them: its
// input is to be antialiased, or the staircases of the input are enlarged with sharp steps. Weakness: fine texture
// looks painted, and lines thinner than two input pixels break.
//
// AMD's shader approximates the reciprocals of both passes by integer arithmetic on the bits of floats, which is part
// of what FSR 1 looks like: exact ones, as three.js' FSR1Node has them, change edges by up to a fifth of the range.
//
// Source: AMD, FidelityFX Super Resolution 1.0 (ffx_fsr1.h), 2021.
#include "zoneplate/upscale/fsr1/fsr1.h"

#include <algorithm>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/upscale/alpha.h"
#include "zoneplate/upscale/axis.h"

namespace zoneplate {
namespace upscale {
namespace {

constexpr int rows_a_block = 32;

const float* floats(const DisplayImage& image, int y) { return &image.row(y).data()->r; }
float* floats(DisplayImage& image, int y) { return &image.row(y).data()->r; }

/// The upscaling pass, for the output's rows in any order.
class Easu {
 public:
  /// `columns` and `rows` are the output's axes.
  Easu(const DisplayImage& image, const UpscaleGrid& grid, Reciprocals reciprocals, const Axis& columns,
       const Axis& rows)
      : image_(image), reciprocals_(reciprocals), rows_(rows), right_(columns.beyond), y_(grid.y) {
    for (const int x : columns.first) {
      for (int tap = 0; tap < 4; ++tap)
        columns_[tap].push_back(4 * std::clamp(x - 1 + tap - grid.x, 0, image.width() - 1));
      // The output may read edges from one pixel before the input's first.
      edge_columns_.push_back(4 * std::clamp(x + 1 - grid.x, 0, image.width()));
    }
    compute_edges();
  }

  /// Output row i of `rows`.
  void row(std::size_t i, float* out) const {
    const int y = rows_.first[i] - y_;
    EasuRow row{.columns = {columns_[0].data(), columns_[1].data(), columns_[2].data(), columns_[3].data()},
                .edge = edge_columns_.data(),
                .right = right_.data(),
                .below = rows_.beyond[i]};
    for (int tap = 0; tap < 4; ++tap) row.rows[tap] = floats(image_, std::clamp(y - 1 + tap, 0, image_.height() - 1));
    const int first_edge = std::clamp(y + 1, 0, image_.height());
    row.edges[0] = floats(edges_, first_edge), row.edges[1] = floats(edges_, first_edge + 1);
    EasuKernels::of().upscale_row(row, reciprocals_, out, right_.size());
  }

 private:
  /// The edges of the image with one pixel around it, from the lumas with two pixels around it.
  void compute_edges() {
    const EasuKernels& kernels = EasuKernels::of();
    const int width = image_.width(), height = image_.height();
    Plane<float> luma(width + 4, height);
    parallel_ranges(static_cast<std::size_t>(height), rows_a_block, [&](std::size_t begin, std::size_t end) {
      for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
        const std::span<float> row = luma.row(y);
        kernels.luma_row(floats(image_, y), row.data() + 2, static_cast<std::size_t>(width));
        row[0] = row[1] = row[2];
        row[row.size() - 1] = row[row.size() - 2] = row[row.size() - 3];
      }
    });
    edges_ = DisplayImage(width + 2, height + 2);
    parallel_ranges(static_cast<std::size_t>(height + 2), rows_a_block, [&](std::size_t begin, std::size_t end) {
      for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
        const auto at = [&](int row) { return luma.row(std::clamp(row, 0, height - 1)).data() + 1; };
        kernels.edge_row(at(y - 2), at(y - 1), at(y), reciprocals_, floats(edges_, y),
                         static_cast<std::size_t>(width + 2));
      }
    });
  }

  const DisplayImage& image_;
  Reciprocals reciprocals_;
  const Axis& rows_;
  std::vector<std::int32_t> columns_[4], edge_columns_;
  const std::vector<float>& right_;
  int y_;
  DisplayImage edges_;  ///< four floats per pixel of the input and of a border of one pixel
};

DisplayImage upscale_opaque(const DisplayImage& image, const UpscaleGrid& grid, const Fsr1Options& options) {
  const Crop made = grid.made();
  // Sharpening reads one more pixel on each side, which is that at the edge of the whole output.
  const int border = options.sharpens ? 1 : 0;
  const Axis columns = Axis::by_step(made.x - border, made.x + made.width + border, grid.to.width, grid.width);
  const Axis rows = Axis::by_step(made.y - border, made.y + made.height + border, grid.to.height, grid.height);
  const Easu easu(image, grid, options.rcas.reciprocals, columns, rows);
  DisplayImage out(made.width, made.height);
  parallel_ranges(static_cast<std::size_t>(made.height), rows_a_block, [&](std::size_t begin, std::size_t end) {
    if (!options.sharpens) {
      for (std::size_t y = begin; y < end; ++y) easu.row(y, floats(out, static_cast<int>(y)));
      return;
    }
    // Three rows of upscaled pixels, with a pixel on each side, move down the block.
    const std::size_t width = 4 * columns.first.size();
    std::vector<float> window(3 * width);
    const auto upscaled = [&](std::size_t row) { return window.data() + row % 3 * width; };
    easu.row(begin, upscaled(begin)), easu.row(begin + 1, upscaled(begin + 1));
    for (std::size_t y = begin; y < end; ++y) {
      easu.row(y + 2, upscaled(y + 2));
      RcasKernels::of().sharpen_row(upscaled(y) + 4, upscaled(y + 1) + 4, upscaled(y + 2) + 4, options.rcas,
                                    floats(out, static_cast<int>(y)), static_cast<std::size_t>(made.width));
    }
  });
  return out;
}

class Fsr1 : public SpatialUpscaler {
 public:
  explicit Fsr1(const Fsr1Options& options) : options_(options) {}
  int radius() const override { return continued_radius + (options_.sharpens ? 3 : 2); }
  DisplayImage upscale(const DisplayImage& image, const UpscaleGrid& grid) const override {
    return upscale_fsr1(image, grid, options_);
  }

 private:
  Fsr1Options options_;
};

constexpr std::string_view sharpenings[] = {"rcas", "none"};
constexpr std::string_view switches[] = {"off", "on"};
constexpr std::string_view maths[] = {"amd", "three"};
constexpr Param params[] = {
    scale_param,
    {.name = "sharpen", .meaning = "the second pass", .value = 0, .names = sharpenings},
    real_param("sharpness", "stops below the strongest sharpening", 0.2, 0, 2),
    {.name = "denoise", .meaning = "sharpens single outliers less", .value = 0, .names = switches},
    {.name = "math", .meaning = "reciprocals: as AMD's shader, or as three.js", .value = 0, .names = maths}};

}  // namespace

DisplayImage upscale_fsr1(const DisplayImage& image, const UpscaleGrid& grid, const Fsr1Options& options) {
  // Alpha has a channel of its own: RCAS keeps it between its neighbours, so that opaque pixels stay opaque.
  return filter_with_alpha(
      image, grid, [&](const DisplayImage& values) { return upscale_opaque(values, grid, options); }, &Display::a);
}

Upscaler fsr1() {
  return {.name = "fsr1",
          .summary = "FidelityFX Super Resolution 1.0: a kernel along edges (EASU), then sharpening (RCAS)",
          .source = "AMD 2021, ffx_fsr1.h",
          .params = params,
          .make_spatial = [](const Settings& s) -> std::unique_ptr<SpatialUpscaler> {
            Fsr1Options options{.sharpens = s.chosen("sharpen") == "rcas"};
            options.rcas.sharpness = exp2(-static_cast<float>(s.number("sharpness")));
            options.rcas.denoises = s.chosen("denoise") == "on";
            options.rcas.reciprocals = s.chosen("math") == "amd" ? Reciprocals::Approximate : Reciprocals::Exact;
            return std::make_unique<Fsr1>(options);
          }};
}

}  // namespace upscale
}  // namespace zoneplate
