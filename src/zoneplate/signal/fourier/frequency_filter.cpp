// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/fourier/frequency_filter.h"

#include <cassert>
#include <cmath>

#include "zoneplate/base/parallel.h"
#include "zoneplate/base/spec.h"
#include "zoneplate/signal/fourier/fourier.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate {
namespace {

constexpr double ln2 = 0.69314718055994531;

double fall(const FilterShape& shape, double u) {
  if (u == 0) return 1;
  switch (shape.kind) {
    case FilterShape::Kind::Ideal:
      return u < 1 ? 1 : u == 1 ? 0.5 : 0;
    case FilterShape::Kind::Gaussian:
      return u > 40 ? 0 : natural_exp(-ln2 * (u * u));
    case FilterShape::Kind::Butterworth:
      break;
  }
  return 1 / (1 + natural_exp(2 * shape.order * natural_log(u)));
}

constexpr Param butterworth_params[] = {real_param("order", "steepness", 2, 0.5, 50)};

struct ShapeEntry {
  std::string_view name;
  FilterShape::Kind kind;
  std::span<const Param> params = {};
};
constexpr ShapeEntry shapes[] = {{"ideal", FilterShape::Kind::Ideal},
                                 {"gaussian", FilterShape::Kind::Gaussian},
                                 {"butterworth", FilterShape::Kind::Butterworth, butterworth_params}};

}  // namespace

FilterShape parse_filter_shape(std::string_view text) {
  const auto spec = parse_spec("filter shape", std::span<const ShapeEntry>(shapes), text);
  return {spec.row.kind, spec.row.params.empty() ? 0 : spec.settings.number("order")};
}

double response(const FrequencyFilter& filter, double f) {
  using Pass = FrequencyFilter::Pass;
  assert(f >= 0);
  switch (filter.pass) {
    case Pass::Low:
      return fall(filter.shape, f / filter.high);
    case Pass::High:
      return 1 - fall(filter.shape, f / filter.low);
    case Pass::Band:
    case Pass::Stop:
      break;
  }
  const double u = std::abs(f * f - filter.low * filter.high) / (f * (filter.high - filter.low));
  const double band = f == 0 ? 0 : fall(filter.shape, u);
  return filter.pass == Pass::Band ? band : 1 - band;
}

Plane<float> filtered(const Plane<float>& plane, const FrequencyFilter& filter, Border border) {
  assert(border == Border::Wrap || border == Border::Reflect);
  if (plane.empty()) return plane;
  if (border == Border::Reflect) {
    const auto twice = padded(plane, {.right = plane.width(), .bottom = plane.height()}, Border::Reflect);
    return cropped(filtered(twice, filter, Border::Wrap), 0, 0, plane.width(), plane.height());
  }
  Spectrum spectrum = fourier(plane);
  parallel_for(static_cast<std::size_t>(plane.height()), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    const double fy = bin_frequency(y, plane.height());
    for (int x = 0; x < spectrum.half.width(); ++x) {
      const double fx = bin_frequency(x, plane.width());
      spectrum.half(x, y) *= response(filter, std::sqrt(fx * fx + fy * fy));
    }
  });
  return inverse_fourier(spectrum);
}

LinearImage filtered(const LinearImage& image, const FrequencyFilter& filter, Border border) {
  LinearImage out(image.width(), image.height());
  for (float Linear::*channel : {&Linear::r, &Linear::g, &Linear::b, &Linear::a}) {
    Plane<float> plane(image.width(), image.height());
    for (std::size_t i = 0; i < plane.values().size(); ++i) plane.values()[i] = image.values()[i].*channel;
    plane = filtered(plane, filter, border);
    for (std::size_t i = 0; i < plane.values().size(); ++i) out.values()[i].*channel = plane.values()[i];
  }
  return out;
}

}  // namespace zoneplate
