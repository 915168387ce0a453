// SPDX-License-Identifier: Apache-2.0
// Metrics, filters and spectra of arrays, and the catalogues.
#include <algorithm>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/capi/arrays.h"
#include "zoneplate/capi/handles.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/compare.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/render/aov.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/builtin/make.h"
#include "zoneplate/signal/filter/resample.h"
#include "zoneplate/signal/fourier/frequency_filter.h"
#include "zoneplate/signal/fourier/spectrum.h"

namespace zoneplate::capi {
namespace {

/// A method that only needs the display-referred image of a frame.
std::unique_ptr<Resolver> make_filter(const char* method) {
  std::unique_ptr<Resolver> filter = make_resolver(antialias::methods(), method);
  const Request request = filter->request({});
  if (!request.is_display_referred || request.samples.size() != 1 || request.draw || request.planes.any())
    throw Error(ErrorKind::Usage, fmt::format("{} needs a scene, expected a filter of images such as smaa", method));
  return filter;
}

/// An image of floats with the channels of these planes.
std::unique_ptr<zoneplate_image> image_of(const std::vector<Plane<float>>& channels) {
  const std::int64_t height = channels.front().height(), width = channels.front().width();
  const std::size_t count = channels.size();
  const auto values = std::make_shared<std::vector<float>>(channels.front().values().size() * count);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t i = 0; i < channels[k].values().size(); ++i) (*values)[i * count + k] = channels[k].values()[i];
  auto out = std::make_unique<zoneplate_image>();
  out->add("color",
           count == 1 ? array_of(values->data(), ZONEPLATE_FLOAT32, {height, width})
                      : array_of(values->data(), ZONEPLATE_FLOAT32, {height, width, static_cast<std::int64_t>(count)}),
           values);
  return out;
}

FrequencyFilter frequency_filter_of(std::string_view pass, double low, double high, const char* shape) {
  using Pass = FrequencyFilter::Pass;
  constexpr std::string_view names[] = {"low", "high", "band", "stop"};
  constexpr Pass passes[] = {Pass::Low, Pass::High, Pass::Band, Pass::Stop};
  const auto found = std::ranges::find(names, pass);
  if (found == std::end(names)) refuse_name("pass", pass, names);
  FrequencyFilter out{.pass = passes[found - std::begin(names)],
                      .shape = parse_filter_shape(shape == nullptr ? "ideal" : shape),
                      .low = low,
                      .high = high};
  const bool has_low = out.pass == Pass::Low || low > 0, has_high = out.pass == Pass::High || high > 0;
  const bool has_both = out.pass == Pass::Band || out.pass == Pass::Stop;
  if (!has_low || !has_high || (has_both && !(low < high)))
    throw Error(ErrorKind::Usage,
                fmt::format("{}: cut-off frequencies of {} and {}, expected 0 < low < high", pass, low, high));
  return out;
}

/// An image to measure: of values that are not finite, no metric has one.
metrics::Picture finite_picture_of(const zoneplate_array& array, const char* name) {
  metrics::Picture picture = picture_of(array, name);
  if (const std::size_t pixels = metrics::count_not_finite(picture); pixels > 0)
    throw Error(ErrorKind::Input,
                fmt::format("{}: has {} pixels with NaN or infinite values, expected finite ones", name, pixels));
  return picture;
}

metrics::Result measure(const zoneplate_array& reference, const zoneplate_array& test, const char* metric) {
  const metrics::Choice choice = metrics::choose_metric(metrics::metrics(), metric);
  const metrics::Comparands pair{.count = 1,
                                 .reference = [&](std::size_t) { return finite_picture_of(reference, "reference"); },
                                 .test = [&](std::size_t) { return finite_picture_of(test, "test"); }};
  return std::move(metrics::compare(pair, {&choice, 1}, metrics::Unfit::Refuse).results.front());
}

struct Entry {
  std::string_view name, summary;
};

template <class Rows>
std::vector<Entry> entries_of(const Rows& rows) {
  std::vector<Entry> out;
  for (const auto& row : rows) out.push_back({row.name, row.summary});
  return out;
}

std::vector<Entry> entries_of(zoneplate_catalogue catalogue) {
  switch (catalogue) {
    case ZONEPLATE_METHODS:
      return entries_of(antialias::methods());
    case ZONEPLATE_METRICS:
      return entries_of(metrics::metrics());
    case ZONEPLATE_SCENES:
      return entries_of(builtin_makers());
    case ZONEPLATE_KERNELS:
      return entries_of(kernels());
    case ZONEPLATE_PASSES:
      break;
  }
  std::vector<Entry> out;
  for (const Aov& aov : aovs()) out.push_back({aov.name, aov.meaning});
  return out;
}

}  // namespace
}  // namespace zoneplate::capi

using namespace zoneplate;
using namespace zoneplate::capi;

zoneplate_status zoneplate_measure(const zoneplate_array* reference, const zoneplate_array* test, const char* metric,
                                   double* value, zoneplate_image** map, zoneplate_image** figures) {
  return guarded([&] {
    metrics::Result result =
        measure(required(reference, "reference"), required(test, "test"), &required(metric, "metric"));
    auto made_map = std::make_unique<zoneplate_image>(), made_figures = std::make_unique<zoneplate_image>();
    if (!result.score.map.empty()) made_map->add("map", std::move(result.score.map));
    for (const metrics::Figure& figure : result.score.more) made_figures->add(figure.name, std::vector{figure.value});
    required(value, "value") = result.value;
    if (map != nullptr) *map = made_map.release();
    if (figures != nullptr) *figures = made_figures.release();
  });
}

zoneplate_status zoneplate_filter(const zoneplate_array* pixels, const char* method, zoneplate_image** image) {
  return guarded([&] {
    const std::unique_ptr<Resolver> filter = make_filter(&required(method, "method"));
    metrics::Picture picture = picture_of(required(pixels, "pixels"), "pixels");
    if (picture.is_scene_linear)
      throw Error(ErrorKind::Usage, "pixels: are linear light, expected sRGB codes (uint8 or uint16)");
    const bool has_alpha = pixels->dimensions == 3 && pixels->shape[2] == 4;
    const DisplayImage result = filter->post_process(std::move(picture.display), Frame());
    std::unique_ptr<zoneplate_image> out;
    if (pixels->type == ZONEPLATE_UINT16)
      out = std::make_unique<zoneplate_image>(quantize16(result), has_alpha);
    else
      out = std::make_unique<zoneplate_image>(quantize8(result), has_alpha);
    required(image, "image") = out.release();
  });
}

zoneplate_status zoneplate_resample(const zoneplate_array* pixels, int32_t width, int32_t height, const char* kernel,
                                    zoneplate_image** image) {
  return guarded([&] {
    const zoneplate_array& from = required(pixels, "pixels");
    if (width < 1 || height < 1 || width > 32768 || height > 32768)
      throw Error(ErrorKind::Usage, fmt::format("size: is {}x{}, expected 1 to 32768", width, height));
    const Kernel filter = make_kernel(kernel == nullptr ? "lanczos3" : kernel);
    std::unique_ptr<zoneplate_image> out;
    if (from.type == ZONEPLATE_FLOAT32) {
      std::vector<Plane<float>> channels = channels_of(from, "pixels");
      for (Plane<float>& channel : channels) channel = resample(channel, width, height, filter);
      out = image_of(channels);
    } else {
      const metrics::Picture picture = picture_of(from, "pixels");
      const bool has_alpha = from.dimensions == 3 && from.shape[2] == 4;
      const LinearImage resampled = resample(picture.linear, width, height, filter);
      out = std::make_unique<zoneplate_image>(quantize8(make_display(resampled, {.is_transparent = true})), has_alpha);
    }
    required(image, "image") = out.release();
  });
}

zoneplate_status zoneplate_frequency_filter(const zoneplate_array* pixels, const char* pass, double low, double high,
                                            const char* shape, zoneplate_image** image) {
  return guarded([&] {
    const FrequencyFilter filter = frequency_filter_of(&required(pass, "pass"), low, high, shape);
    std::vector<Plane<float>> channels = channels_of(required(pixels, "pixels"), "pixels");
    for (Plane<float>& channel : channels) channel = filtered(channel, filter);
    required(image, "image") = image_of(channels).release();
  });
}

zoneplate_status zoneplate_spectrum(const zoneplate_array* plane, zoneplate_image** spectrum) {
  return guarded([&] {
    const std::vector<Plane<float>> channels = channels_of(required(plane, "plane"), "plane");
    if (channels.size() != 1) throw Error(ErrorKind::Usage, "plane: has several channels, expected height x width");
    const Spectrum found = fourier(channels.front());
    auto out = std::make_unique<zoneplate_image>();
    out->add("magnitude", centred_log_magnitude(found));
    out->add("phase", centred_phase(found));
    RadialProfile profile = radial_profile(found, std::max(1, std::min(found.width, found.height()) / 2));
    std::vector<double> frequency;
    for (std::size_t i = 0; i < profile.power.size(); ++i)
      frequency.push_back((static_cast<double>(i) + 0.5) * profile.ring_width);
    out->add("power", std::move(profile.power));
    out->add("frequency", std::move(frequency));
    required(spectrum, "spectrum") = out.release();
  });
}

zoneplate_status zoneplate_list(zoneplate_catalogue catalogue, size_t index, const char** name, const char** summary) {
  return guarded([&] {
    const std::vector<Entry> entries = entries_of(catalogue);
    if (index >= entries.size()) throw Error(ErrorKind::Usage, "index: is past the last entry");
    required(name, "name") = entries[index].name.data();  // literals, which end with 0
    required(summary, "summary") = entries[index].summary.data();
  });
}
