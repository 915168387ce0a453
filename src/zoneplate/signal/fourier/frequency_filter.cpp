#include "zoneplate/signal/fourier/frequency_filter.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/signal/fourier/fourier.h"
#include "zoneplate/signal/functions.h"
#include "zoneplate/signal/spec.h"

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

}  // namespace

FilterShape parse_filter_shape(std::string_view text) {
  const Spec spec = parse_spec(text);
  if (spec.name == "ideal") return settle(spec, {}), FilterShape{FilterShape::Kind::Ideal, 0};
  if (spec.name == "gaussian") return settle(spec, {}), FilterShape{FilterShape::Kind::Gaussian, 0};
  if (spec.name == "butterworth")
    return {FilterShape::Kind::Butterworth, settle(spec, {{"order", "steepness", 2, 0.5, 50}})[0]};
  throw Error(ErrorKind::Usage, fmt::format("no filter shape '{}'; wants ideal, gaussian or butterworth", spec.name));
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
