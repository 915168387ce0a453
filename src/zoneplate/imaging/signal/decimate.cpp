// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/decimate.h"

#include <fmt/format.h>
#include <cmath>

#include "zoneplate/base/utf8.h"
#include "zoneplate/imaging/signal/load.h"
#include "zoneplate/imaging/signal/reduce.h"
#include "zoneplate/imaging/signal/show.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/signal/filter/aliasing.h"
#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate {
namespace {

/// An image, decimated without and with a filter.
struct Pair {
  LinearImage image, naive, filtered;
};

/// Aliasing of a kernel, measured in this image and predicted from its response for a flat spectrum.
struct Figures {
  std::string kernel;
  AliasFigures measured, expected;
};

std::vector<Figures> measure(const DecimateOptions& args, const Pair& pair) {
  std::vector<std::string> names{args.kernel};
  if (args.compares_all) {
    names.clear();
    for (const KernelEntry& entry : kernels()) names.emplace_back(entry.name);
  }
  const Plane<float> plane = luminance(pair.image);
  std::vector<Figures> rows;
  for (const std::string& name : names) {
    const Kernel kernel = make_kernel(name);
    rows.push_back({name, measure_aliases(plane, pair.naive.width(), pair.naive.height(), kernel),
                    predict_aliases(kernel, args.by)});
  }
  return rows;
}

// No energy is -400 dB, displayed as "none".
std::string shown_db(double db) { return db <= -399 || !std::isfinite(db) ? "none" : fmt::format("{:.1f}", db); }

std::string text_of(const std::string& input, const Pair& pair, const std::vector<Figures>& rows) {
  std::string text = fmt::format(
      "{}, {} × {} to {} × {}\n"
      "Aliased energy in dB relative to no filter: all of it, and from 1.5 times the new Nyquist frequency on (far);\n"
      "error in the passband relative to the ideal result: the whole passband, and its lower half (coarse).\n"
      "  {:<16}{:>9}{:>9}{:>9}{:>9}   {:>9}{:>9}{:>9}{:>9}\n",
      printable(input), pair.image.width(), pair.image.height(), pair.naive.width(), pair.naive.height(),
      "measured (theory)", "all", "far", "error", "coarse", "(all", "far", "error", "coarse)");
  for (const Figures& row : rows) {
    const AliasFigures &m = row.measured, &e = row.expected;
    text += fmt::format("  {:<17}{:>9}{:>9}{:>9}{:>9}   {:>9}{:>9}{:>9}{:>9}\n", row.kernel, shown_db(m.all_db),
                        shown_db(m.far_db), shown_db(m.pass_db), shown_db(m.pass_half_db), shown_db(e.all_db),
                        shown_db(e.far_db), shown_db(e.pass_db), shown_db(e.pass_half_db));
  }
  return text;
}

Json json_of(const AliasFigures& f) {
  const auto db = [](double v) { return v <= -399 ? Json("-inf") : Json(v); };
  return Json::Object{{"all_db", db(f.all_db)},
                      {"far_db", db(f.far_db)},
                      {"error_db", db(f.pass_db)},
                      {"coarse_error_db", db(f.pass_half_db)}};
}

Json::Object json_of(const std::string& input, const DecimateOptions& args, const Pair& pair,
                     const std::vector<Figures>& rows) {
  Json::Object figures;
  for (const Figures& row : rows)
    figures.emplace_back(row.kernel,
                         Json::Object{{"measured", json_of(row.measured)}, {"expected", json_of(row.expected)}});
  return {
      {"input", input}, {"output", args.output},        {"width", pair.naive.width()}, {"height", pair.naive.height()},
      {"by", args.by},  {"kernels", std::move(figures)}};
}

Rgba8Image figure_of(const std::string& input, const DecimateOptions& args, const Pair& pair) {
  const auto image = [&](const LinearImage& of, const std::string& caption) {
    return Panel{fitted(shown(of, args.uses_codes)), caption};
  };
  // A common scale: the amplitude of a wave is its magnitude divided by the number of pixels.
  constexpr double range_db = 50;
  const auto pixels = [](const Spectrum& of) { return static_cast<double>(of.width) * of.height(); };
  const Spectrum whole = fourier(luminance(pair.image));
  const double amplitude = strongest_magnitude(whole) / pixels(whole);
  const auto spectrum = [&](const Spectrum& of, const std::string& caption) {
    return Panel{magnitude_panel(of, {range_db, amplitude * pixels(of)}), caption};
  };
  return compose(
      {.title = fmt::format("{}, downsampled by {:g}", title_of(input), args.by),
       .rows =
           {{image(pair.image, fmt::format("Image\n{} × {} pixels.", pair.image.width(), pair.image.height())),
             image(pair.naive, fmt::format("Sampled\nOne pixel of every {0:g} × {0:g}, without a filter. Frequencies "
                                           "above the new Nyquist frequency "
                                           "alias to low ones: moire.",
                                           args.by)),
             image(pair.filtered,
                   fmt::format(
                       "Filtered, then sampled\nBy {}. Frequencies above the new Nyquist frequency are removed first.",
                       args.kernel))},
            {spectrum(
                 whole,
                 fmt::format(
                     "Its spectrum\nThe new grid represents the middle, up to {:.3g} cycle per pixel. Black is {:g} dB "
                     "below the maximum, in all three.",
                     0.5 / args.by, range_db)),
             spectrum(fourier(luminance(pair.naive)),
                      "Spectrum\nThe middle, with all frequencies outside folded into it."),
             spectrum(fourier(luminance(pair.filtered)), "Spectrum\nThe middle alone.")}},
       .text = {}});
}

/// The signal in fewer pixels, in its own space.
Signal smaller(const DecimateOptions& args, const Signal& signal, const std::string& kernel) {
  const auto side = [&](int n) { return std::max(1, static_cast<int>(std::floor(n / args.by + 0.5))); };
  return {resampled(signal.image, side(signal.image.width()), side(signal.image.height()), kernel, Border::Clamp),
          signal.meaning, signal.origin};
}

}  // namespace

void decimate_image(const std::string& input, const DecimateOptions& args, Delivery& out) {
  Signal signal = load_as_stored(input, signal_choice(args), out);
  Signal naive = smaller(args, signal, "nearest"), filtered = smaller(args, signal, args.kernel);
  if (!args.naive_path.empty()) save_signal(args.naive_path, naive, out);
  if (!args.filtered_path.empty()) save_signal(args.filtered_path, filtered, out);
  const Pair pair{in_rec709(std::move(signal)).image, in_rec709(std::move(naive)).image,
                  in_rec709(std::move(filtered)).image};
  if (!args.output.empty()) save_picture(args.output, figure_of(input, args, pair), out);
  const std::vector<Figures> rows = measure(args, pair);
  print_result(args, text_of(input, pair, rows), json_of(input, args, pair, rows), out);
}

}  // namespace zoneplate
