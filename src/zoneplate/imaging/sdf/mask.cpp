// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/sdf/mask.h"

#include <fmt/format.h>
#include <algorithm>

#include "zoneplate/base/error.h"
#include "zoneplate/imaging/signal/load.h"
#include "zoneplate/imaging/signal/show.h"
#include "zoneplate/sdf/field/distance_transform.h"

namespace zoneplate {
namespace {

/// Central differences; one-sided ones at the border.
sdf::DistanceField with_gradient(Plane<float> distance) {
  const int w = distance.width(), h = distance.height();
  sdf::DistanceField field{std::move(distance), Plane<float>(w, h), Plane<float>(w, h)};
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const int x0 = std::max(x - 1, 0), x1 = std::min(x + 1, w - 1), y0 = std::max(y - 1, 0),
                y1 = std::min(y + 1, h - 1);
      const auto slope = [](float a, float b, int step) {
        return step > 0 ? (b - a) / static_cast<float>(step) : 0.0f;
      };
      field.gradient_x(x, y) = slope(field.distance(x0, y), field.distance(x1, y), x1 - x0);
      field.gradient_y(x, y) = slope(field.distance(x, y0), field.distance(x, y1), y1 - y0);
    }
  return field;
}

LinearImage grey(const Plane<float>& plane) {
  LinearImage out(plane.width(), plane.height());
  std::ranges::transform(plane.values(), out.values().begin(), [](float v) { return Linear{v, v, v, 1}; });
  return out;
}

}  // namespace

void make_field_of_mask(const std::string& input, const MaskOptions& args, Delivery& out) {
  constexpr int max_side = 32767;
  const LinearImage image = load_signal(input, {true, {args.layer}}, out);
  if (image.width() > max_side || image.height() > max_side)
    throw Error(ErrorKind::Input, fmt::format("{}: a side of more than {} pixels", input, max_side));
  const Plane<float> luma = luminance(image);
  Plane<std::uint8_t> mask(image.width(), image.height());
  std::int64_t inside = 0;
  for (std::size_t i = 0; i < mask.values().size(); ++i) {
    const float v = args.uses_alpha ? image.values()[i].a : luma.values()[i];
    const bool is_inside = (static_cast<double>(v) > args.threshold) != args.is_inverted;
    mask.values()[i] = is_inside;
    inside += is_inside;
  }
  if (inside == 0 || inside == std::ssize(mask.values()))
    throw Error(ErrorKind::Input,
                fmt::format("{}: {} pixel is inside at a threshold of {:g}, so that there is no boundary", input,
                            inside == 0 ? "no" : "every", args.threshold));
  Plane<float> distances = sdf::signed_distances(mask);
  const auto [low, high] = std::ranges::minmax(distances.values());
  if (!args.output.empty())
    save_result(
        args.output, grey(distances),
        [&] { return show_field(with_gradient(distances), args.view.view, args.view.spacing, 1); }, out);
  print_result(args,
               fmt::format("{}, {} × {} pixels, {} inside, distances from {:.3f} to {:.3f} pixels\n", title_of(input),
                           image.width(), image.height(), inside, low, high),
               {{"input", input},
                {"output", args.output},
                {"width", image.width()},
                {"height", image.height()},
                {"inside", inside},
                {"least", low},
                {"greatest", high}},
               out);
}

void draw_mask_of_field(const std::string& input, const MaskOptions& args, Delivery& out) {
  constexpr double max_pixels = 1 << 28;
  const LinearImage image = load_as_stored(input, signal_choice(args), out).image;
  Plane<float> distances(image.width(), image.height());
  std::ranges::transform(image.values(), distances.values().begin(), &Linear::r);
  const double width = std::max(1.0, std::floor(image.width() * args.scale + 0.5)),
               height = std::max(1.0, std::floor(image.height() * args.scale + 0.5));
  if (width * height > max_pixels)
    throw Error(ErrorKind::Usage, fmt::format("--scale: {:.0f} × {:.0f} pixels are too many", width, height));
  const Plane<float> mask = sdf::drawn_field(distances, static_cast<int>(width), static_cast<int>(height), args.scale);
  if (!args.output.empty())
    save_result(
        args.output, grey(mask), [&] { return shown(grey(mask), false); }, out);
  print_result(args, fmt::format("{}, {} × {} pixels\n", title_of(input), mask.width(), mask.height()),
               {{"input", input}, {"output", args.output}, {"width", mask.width()}, {"height", mask.height()}}, out);
}

}  // namespace zoneplate
