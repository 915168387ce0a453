// SPDX-License-Identifier: Apache-2.0
// The edge response: sharpness as a modulation transfer function, measured at a slanted edge.
//
// The rows sample a straight edge that is not parallel to an axis at many distances. Sorted by distance, they give the
// step response at four samples per pixel, although the image has one. Weakness: curved or textured edges; the image
// should be cropped to one edge.
#include "zoneplate/metrics/edge/edge_response.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "zoneplate/metrics/metric.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::metrics {
namespace {

constexpr int bins_a_pixel = 4;
constexpr int max_reach = 32;  // pixels on each side of the edge; a greater reach only adds noise
constexpr int min_reach = 4;

Plane<double> transposed(const Plane<double>& in) {
  Plane<double> out(in.height(), in.width());
  for (int y = 0; y < in.height(); ++y) {
    for (int x = 0; x < in.width(); ++x) out(y, x) = in(x, y);
  }
  return out;
}

/// True if the image changes more between rows than within rows.
bool is_nearly_horizontal(const Plane<double>& in) {
  double across = 0, down = 0;
  for (int y = 0; y + 1 < in.height(); ++y) {
    for (int x = 0; x + 1 < in.width(); ++x) {
      across += std::abs(in(x + 1, y) - in(x, y));
      down += std::abs(in(x, y + 1) - in(x, y));
    }
  }
  return down > across;
}

/// The edge x = at + slope (y - middle), in pixels; y is that of row centres.
struct Line {
  double at = 0, slope = 0, middle = 0;
  double x(double y) const { return at + slope * (y - middle); }
};

/// x rounded down and clamped to [0, most]; 0 if x is NaN.
int whole_within(double x, int most) { return x > 0 ? static_cast<int>(std::min<double>(x, most)) : 0; }

/// The centroid of a row's change within `reach` of `near`; nothing if the change is less than `least`.
std::optional<double> edge_in_row(std::span<const double> row, double near, double reach, double least) {
  double sum = 0, moment = 0;
  const int n = static_cast<int>(row.size());
  if (!(near + reach >= 0)) return std::nullopt;
  const int first = whole_within(near - reach, n);
  const int last = std::min(n - 2, whole_within(std::ceil(near + reach), n));
  for (int x = first; x <= last; ++x) {
    const double change = row[static_cast<std::size_t>(x + 1)] - row[static_cast<std::size_t>(x)];
    sum += change;
    moment += change * (x + 1);
  }
  if (!(std::abs(sum) >= least)) return std::nullopt;
  return moment / sum;
}

/// The straight line through the rows' edges by least squares; nothing with fewer than 8 rows.
std::optional<Line> fit_line(const Plane<double>& in, const std::optional<Line>& guess, double least) {
  double n = 0, sy = 0, sx = 0, syy = 0, sxy = 0;
  for (int row = 0; row < in.height(); ++row) {
    const double y = row + 0.5;
    const double near = guess ? guess->x(y) : in.width() / 2.0;
    if (near < min_reach || near > in.width() - min_reach) continue;
    const auto x = edge_in_row(in.row(row), near, guess ? min_reach * 2.0 : in.width(), least);
    if (!x) continue;
    n += 1, sy += y, sx += *x, syy += y * y, sxy += y * *x;
  }
  const double spread = n * syy - sy * sy;
  if (n < 8 || !(spread > 0)) return std::nullopt;
  return Line{sx / n, (n * sxy - sy * sx) / spread, sy / n};
}

/// The pixels of one bin of distance from the edge: their number, mean distance (in bins) and mean value.
struct Bin {
  double count = 0, place = 0, value = 0;
};

/// The values at the middles of the bins, extrapolated from the mean distance of each bin's pixels with the slope
/// between its neighbours: with few rows, or rows that repeat, pixels are unevenly distributed within a bin.
std::vector<double> values_at_middles(std::span<const Bin> bins) {
  std::vector<double> values;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const Bin& before = bins[i == 0 ? i : i - 1];
    const Bin& after = bins[i + 1 == bins.size() ? i : i + 1];
    const double slope = (after.value - before.value) / (after.place - before.place);
    values.push_back(bins[i].value + slope * (static_cast<double>(i) + 0.5 - bins[i].place));
  }
  return values;
}

/// The edge spread function at one sample per bin, `reach` pixels to each side of the edge; nothing if a bin is empty.
std::optional<std::vector<double>> gather(const Plane<double>& in, const Line& line, int reach) {
  const double normal = 1 / std::sqrt(1 + line.slope * line.slope);
  const int count = 2 * reach * bins_a_pixel;
  std::vector<Bin> bins(static_cast<std::size_t>(count));
  for (int y = 0; y < in.height(); ++y) {
    for (int x = 0; x < in.width(); ++x) {
      const double place = ((x + 0.5 - line.x(y + 0.5)) * normal + reach) * bins_a_pixel;
      if (place < 0 || place >= count) continue;
      Bin& bin = bins[static_cast<std::size_t>(place)];
      bin.count += 1, bin.place += place, bin.value += in(x, y);
    }
  }
  for (Bin& bin : bins) {
    if (bin.count == 0) return std::nullopt;
    bin.place /= bin.count, bin.value /= bin.count;
  }
  return values_at_middles(bins);
}

double mean_over(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Normalizes the step to rise from 0 to 1.
void normalize_step(std::vector<double>& spread) {
  const std::size_t outer = spread.size() / 4;
  double low = mean_over(std::span(spread).first(outer)), high = mean_over(std::span(spread).last(outer));
  if (low > high) std::ranges::reverse(spread), std::swap(low, high);
  for (double& v : spread) v = (v - low) / (high - low);
}

/// |transform| of the line spread function at one frequency, with a Hamming window centred on the edge.
double transform(const std::vector<double>& spread, double frequency) {
  const std::size_t n = spread.size() - 1;
  double re = 0, im = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double place = static_cast<double>(i + 1) - static_cast<double>(spread.size()) / 2;  // in bins from the edge
    const double window = 0.54 + 0.46 * cos_pi(2 * place / static_cast<double>(spread.size()));
    const double change = (spread[i + 1] - spread[i]) * window;
    const SineCosine wave = sin_cos_pi(2 * frequency * place / bins_a_pixel);
    re += change * wave.cosine;
    im += change * wave.sine;
  }
  return std::sqrt(re * re + im * im);
}

void measure_transfer(EdgeResponse& edge) {
  constexpr int steps = 200;
  const double whole = transform(edge.spread, 0);
  for (int i = 0; i <= steps; ++i) {
    const double f = static_cast<double>(i) / steps;
    const double bin = sinc(f / bins_a_pixel);  // attenuation by the mean over a bin, and by the difference of two bins
    edge.frequency.push_back(f);
    edge.transfer.push_back(transform(edge.spread, f) / whole / (bin * bin));
  }
  edge.nyquist_transfer = edge.transfer[steps / 2];
  edge.half_transfer = 1;
  for (std::size_t i = 1; i < edge.transfer.size(); ++i) {
    const double before = edge.transfer[i - 1], here = edge.transfer[i];
    if (here > 0.5) continue;
    edge.half_transfer = edge.frequency[i - 1] + (before - 0.5) / (before - here) / steps;
    break;
  }
}

/// The interpolated distance at which the spread first rises above `level`, searched from `first`.
double crossing(const EdgeResponse& edge, std::size_t first, double level) {
  for (std::size_t i = first + 1; i < edge.spread.size(); ++i) {
    const double before = edge.spread[i - 1], here = edge.spread[i];
    if (here < level || before >= level) continue;
    return edge.distance[i - 1] + (level - before) / (here - before) / bins_a_pixel;
  }
  return edge.distance.back();
}

void measure_spread(EdgeResponse& edge) {
  const auto [low, high] = std::ranges::minmax(edge.spread);
  edge.overshoot = std::max({0.0, high - 1, -low});

  // The rise starts at the last sample on the dark side that is below a tenth.
  std::size_t start = 0;
  for (std::size_t i = 0; i < edge.spread.size() && edge.spread[i] < 0.5; ++i) {
    if (edge.spread[i] < 0.1) start = i;
  }
  edge.rise = crossing(edge, start, 0.9) - crossing(edge, start, 0.1);
}

}  // namespace

std::optional<EdgeResponse> measure_edge(const LinearImage& image) {
  Plane<double> in = luminance_plane(image);
  if (in.width() <= 2 * min_reach || in.height() <= 2 * min_reach) return std::nullopt;
  if (is_nearly_horizontal(in)) in = transposed(in);
  const auto [low, high] = std::ranges::minmax(in.values());
  const double least = (high - low) / 2;
  if (!(least > 0)) return std::nullopt;

  // The first fit uses whole rows, the next ones the pixels near the line.
  std::optional<Line> line = fit_line(in, std::nullopt, least);
  for (int pass = 0; pass < 2 && line; ++pass) line = fit_line(in, line, least);
  if (!line) return std::nullopt;

  const double ends[] = {line->x(0), line->x(in.height())};
  const double room = std::min(std::ranges::min(ends), in.width() - std::ranges::max(ends));
  const int reach = std::max(min_reach, whole_within(room, max_reach));
  auto spread = gather(in, *line, reach);
  if (!spread) return std::nullopt;

  EdgeResponse edge;
  edge.angle_deg = std::abs(angle_of(line->slope, 1)) * 180 / std::numbers::pi;
  edge.spread = std::move(*spread);
  normalize_step(edge.spread);
  for (std::size_t i = 0; i < edge.spread.size(); ++i) {
    edge.distance.push_back((static_cast<double>(i) + 0.5) / bins_a_pixel - reach);
  }
  measure_transfer(edge);
  measure_spread(edge);
  return edge;
}

Metric edge_response() {
  return {.name = "edge_response",
          .summary = "MTF50 of the one straight, slanted edge of the image, in linear light",
          .source = "ISO 12233:2017, annex D",
          .unit = "cycles/pixel",
          .better = Better::Higher,
          .perfect = std::nullopt,
          .is_default = false,
          .needs_whole_image = true,
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            const auto expected = measure_edge(reference[0].linear), found = measure_edge(test[0].linear);
            if (!expected || !found) return std::nullopt;
            Score score{.value = found->half_transfer, .more = {}};
            score.more = {{"reference_mtf50", expected->half_transfer, "cycles/pixel"},
                          {"mtf_nyquist", found->nyquist_transfer, ""},
                          {"reference_mtf_nyquist", expected->nyquist_transfer, ""},
                          {"rise", found->rise, "pixels"},
                          {"reference_rise", expected->rise, "pixels"},
                          {"overshoot", found->overshoot, "share of the step"},
                          {"angle", found->angle_deg, "degrees"}};
            score.curves = {
                {"edge spread", "distance (pixels)", "share of the step", found->distance, found->spread},
                {"modulation transfer", "frequency (cycles/pixel)", "transfer", found->frequency, found->transfer}};
            return score;
          }};
}

}  // namespace zoneplate::metrics
