// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/convolve.h"

#include <fmt/format.h>
#include <cmath>
#include <optional>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/imaging/signal/alpha.h"
#include "zoneplate/imaging/signal/load.h"
#include "zoneplate/imaging/signal/show.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/signal/filter/convolve.h"
#include "zoneplate/signal/fourier/fourier.h"

namespace zoneplate {
namespace {

/// The difference of two computations of the same result.
struct Deviation {
  double greatest = 0;
  int x = 0, y = 0;
};

Deviation difference(const LinearImage& a, const LinearImage& b) {
  Deviation out;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) {
      const Linear &p = a(x, y), &q = b(x, y);
      for (const float d : {p.r - q.r, p.g - q.g, p.b - q.b, p.a - q.a})
        if (std::abs(static_cast<double>(d)) > out.greatest) out = {std::abs(static_cast<double>(d)), x, y};
    }
  return out;
}

double range_of(const LinearImage& image) {
  float low = image.values()[0].r, high = low;
  for (const Linear& c : image.values()) low = std::min({low, c.r, c.g, c.b}), high = std::max({high, c.r, c.g, c.b});
  return static_cast<double>(high) - static_cast<double>(low);
}

template <class T>
Plane<T> in_space(const Plane<T>& image, const KernelChoice& kernel, Border border) {
  return kernel.is_separable() ? convolve_separable(image, kernel.taps, kernel.taps, {.border = border})
                               : convolve(image, kernel.weights, {.border = border});
}

LinearImage convolved(const LinearImage& image, const KernelChoice& kernel, Border border, Via via) {
  const auto way = [&](const auto& plane, Border rule) {
    return via == Via::Space ? in_space(plane, kernel, rule) : convolve_by_fourier(plane, kernel.weights, rule);
  };
  LinearImage out = way(image, border);
  if (border == Border::Zero) set_alpha(out, way(alpha_of(image), Border::Clamp));
  return out;
}

struct Results {
  LinearImage image;  ///< the image that is written
  double space_ms = 0, frequency_ms = 0;
  std::optional<Deviation> apart;  ///< difference of the two computations
  /// Deviation between this border rule and the product of the unpadded spectra, which is the rule wrap.
  std::optional<Deviation> bare;
};

Results convolved(const ConvolutionOptions& args, const LinearImage& image, const KernelChoice& kernel) {
  Results out;
  LinearImage by_product;
  const Stopwatch watch;
  if (args.via != Via::Frequency) out.image = convolved(image, kernel, args.border, Via::Space);
  out.space_ms = watch.ms();
  if (args.via == Via::Space) return out;
  by_product = convolved(image, kernel, args.border, Via::Frequency);
  out.frequency_ms = watch.ms() - out.space_ms;
  if (args.via == Via::Frequency) {
    out.image = std::move(by_product);
    return out;
  }
  out.apart = difference(out.image, by_product);
  if (args.border != Border::Wrap)
    out.bare = difference(out.image, convolve_by_fourier(image, kernel.weights, Border::Wrap));
  return out;
}

std::string text_of(const std::string& input, const ConvolutionOptions& args, const LinearImage& image,
                    const KernelChoice& kernel, const Results& results) {
  std::string text = fmt::format("{}, {} × {} with {} ({} × {} weights, sum {:.6g}), border {}\n", printable(input),
                                 image.width(), image.height(), kernel.name, kernel.weights.width(),
                                 kernel.weights.height(), kernel.sum(), name_of(args.border));
  if (!results.apart) return text;
  const double range = range_of(image), relative = range > 0 ? results.apart->greatest / range : 0;
  text += fmt::format(
      "  in space {:.1f} ms, by the spectra {:.1f} ms\n"
      "  greatest difference {:.3g} ({:.3g} of the range) at pixel {},{}\n",
      results.space_ms, results.frequency_ms, results.apart->greatest, relative, results.apart->x, results.apart->y);
  if (results.bare)
    text += fmt::format("  the product of the spectra without padding would be {:.3g} off at pixel {},{}\n",
                        results.bare->greatest, results.bare->x, results.bare->y);
  return text;
}

Json::Object json_of(const std::string& input, const ConvolutionOptions& args, const LinearImage& image,
                     const KernelChoice& kernel, const Results& results) {
  Json::Object json{{"input", input},
                    {"output", args.output},
                    {"width", image.width()},
                    {"height", image.height()},
                    {"kernel", kernel.name},
                    {"kernel_width", kernel.weights.width()},
                    {"kernel_height", kernel.weights.height()},
                    {"kernel_sum", kernel.sum()},
                    {"border", name_of(args.border)}};
  const auto add = [&](const char* name, const std::optional<Deviation>& d) {
    if (d) json.emplace_back(name, Json::Object{{"greatest", d->greatest}, {"x", d->x}, {"y", d->y}});
  };
  if (results.apart) json.emplace_back("range", range_of(image));
  add("difference", results.apart);
  add("difference_of_bare_product", results.bare);
  if (results.apart)
    json.emplace_back("ms", Json::Object{{"space", results.space_ms}, {"frequency", results.frequency_ms}});
  return json;
}

/// The result of a kernel with sum 0 is.
bool is_signed(const KernelChoice& kernel) { return std::abs(kernel.sum()) < 1e-6; }

Rgba8Image picture_of(const ConvolutionOptions& args, const KernelChoice& kernel, const LinearImage& result) {
  return is_signed(kernel) ? shown_around_grey(result) : shown(result, args.uses_codes);
}

/// The weights as grey levels, surrounded by weights of 0; the greatest is white. If some are negative, mid-grey is 0.
Rgba8Image kernel_picture(const Plane<float>& weights, int2 size) {
  float low = 0, greatest = 0;
  for (const float w : weights.values()) low = std::min(low, w), greatest = std::max(greatest, std::abs(w));
  const auto level = [&](float w) { return low < 0 ? 0.5f + 0.5f * w / greatest : greatest > 0 ? w / greatest : 0.0f; };

  // Squares in the middle, as large as a margin allows; if there are more weights than pixels, the nearest weight is
  // used.
  const double cell =
      0.75 * std::min(static_cast<double>(size.x) / weights.width(), static_cast<double>(size.y) / weights.height());
  const auto place = [&](int x, int pixels, int count) {
    return static_cast<int>(std::floor((x + 0.5 - pixels / 2.0) / cell + count / 2.0));
  };
  LinearImage image(size.x, size.y);
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const int i = place(x, size.x, weights.width()), j = place(y, size.y, weights.height());
      const bool is_inside = i >= 0 && j >= 0 && i < weights.width() && j < weights.height();
      const float v = level(is_inside ? weights(i, j) : 0);
      image(x, y) = {v, v, v, 1};
    }
  return shown(image, true);
}

/// The spectrum of the kernel on a plane of the image's size.
Spectrum spectrum_of(const Plane<float>& weights, int width, int height) {
  Plane<double> plane(width, height);
  for (int y = 0; y < weights.height(); ++y)
    for (int x = 0; x < weights.width(); ++x)
      plane(border_index(x, width, Border::Wrap), border_index(y, height, Border::Wrap)) +=
          static_cast<double>(weights(x, y));
  return fourier(plane);
}

Rgba8Image figure_of(const std::string& input, const ConvolutionOptions& args, const LinearImage& image,
                     const KernelChoice& kernel, const LinearImage& result) {
  const Spectrum of_image = fourier(luminance(image)), of_result = fourier(luminance(result));
  const Spectrum of_kernel = spectrum_of(kernel.weights, image.width(), image.height());
  // With a common scale in decibels, the third image is the sum of the other two.
  const double image_peak = strongest_magnitude(of_image), kernel_peak = strongest_magnitude(of_kernel);
  return compose(
      {.title = fmt::format("{} with {}", title_of(input), kernel.name),
       .rows = {{{fitted(shown(image, args.uses_codes)), "Image\nThe input."},
                 {kernel_picture(kernel.weights, panel_size(image.width(), image.height())),
                  fmt::format("Kernel\n{} × {} weights, enlarged, with a border of zeros.", kernel.weights.width(),
                              kernel.weights.height())},
                 {fitted(picture_of(args, kernel, result)),
                  "Convolution\nEach pixel is a weighted sum of its neighbourhood."}},
                {{magnitude_panel(of_image, {.peak = image_peak}),
                  "Spectrum of the image\nFrequency 0 in the middle, ½ cycle per pixel at the edges; 80 dB from black "
                  "to the maximum."},
                 {magnitude_panel(of_kernel, {.peak = kernel_peak}),
                  "Spectrum of the kernel\nOn the same frequency scale."},
                 {magnitude_panel(of_result, {.peak = image_peak * kernel_peak}),
                  "Spectrum of the convolution\nThe product of the other two."}}},
       .text = {}});
}

void convolve_image(const ConvolutionOptions& args, const std::string& input, Delivery& out) {
  Signal signal = load_as_stored(input, signal_choice(args, true), out);
  if (args.is_side_by_side) signal = in_rec709(std::move(signal));
  const LinearImage& image = signal.image;
  const KernelChoice& kernel = args.kernel;
  const Results results = convolved(args, image, kernel);
  if (!args.output.empty() && args.is_side_by_side)
    save_picture(args.output, figure_of(input, args, image, kernel, results.image), out);
  else if (!args.output.empty() && is_signed(kernel))
    save_signal(args.output, {results.image, signal.meaning, signal.origin}, out,
                [&] { return picture_of(args, kernel, results.image); });
  else if (!args.output.empty())
    save_signal(args.output, {results.image, signal.meaning, signal.origin}, out);
  print_result(args, text_of(input, args, image, kernel, results), json_of(input, args, image, kernel, results), out);
}

}  // namespace

void convolve_signal(const std::string& input, ConvolutionOptions args, Delivery& out) {
  if (!args.kernel_file.empty())
    out.read(args.kernel_file, [&] { args.kernel = parse_kernel_choice(args.kernel_file); });
  args.values ? convolve_row(args, out) : convolve_image(args, input, out);
}

}  // namespace zoneplate
