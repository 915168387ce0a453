// SPDX-License-Identifier: Apache-2.0
// Convolution of one row of numbers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/imaging/signal/convolve.h"
#include "zoneplate/signal/filter/convolve.h"

namespace zoneplate {
namespace {

struct ConvolvedRow {
  std::vector<double> in, taps, out;
  std::optional<double> apart;
};

Plane<float> plane_of(const std::vector<double>& row) {
  Plane<float> plane(static_cast<int>(row.size()), 1);
  for (std::size_t i = 0; i < row.size(); ++i) plane.values()[i] = static_cast<float>(row[i]);
  return plane;
}

ConvolvedRow convolved_row(const ConvolutionOptions& args) {
  const KernelChoice& kernel = args.kernel;
  ConvolvedRow row{{args.values->values().begin(), args.values->values().end()}, kernel.taps, {}, {}};
  if (!kernel.is_separable()) {
    if (kernel.weights.height() != 1) throw Error(ErrorKind::Usage, "--kernel: --values requires one row of numbers");
    row.taps.assign(kernel.weights.values().begin(), kernel.weights.values().end());
  }
  const Plane<float> in = plane_of(row.in), taps = plane_of(row.taps);
  const Plane<float> out = args.via == Via::Frequency ? convolve_by_fourier(in, taps, args.border)
                                                      : convolve(in, taps, {.border = args.border});
  row.out.assign(out.values().begin(), out.values().end());
  if (args.via == Via::Both) {
    const Plane<float> other = convolve_by_fourier(in, taps, args.border);
    row.apart = 0;
    for (std::size_t i = 0; i < row.out.size(); ++i)
      row.apart = std::max(*row.apart, std::abs(row.out[i] - static_cast<double>(other.values()[i])));
  }
  return row;
}

std::string joined(const std::vector<double>& values) {
  std::string text;
  for (const double v : values) text += fmt::format("{:>8.5g}", v);
  return text;
}

Plot row_plot(const ConvolutionOptions& args, const ConvolvedRow& row) {
  Curve in{"values", {}, Curve::Mark::Stems, Curve::grey},
      out{"convolved with " + args.kernel.name, {}, Curve::Mark::LineAndPoints, 1};
  for (std::size_t i = 0; i < row.in.size(); ++i) {
    in.points.emplace_back(static_cast<double>(i), row.in[i]);
    out.points.emplace_back(static_cast<double>(i), row.out[i]);
  }
  return {.title = "Convolution",
          .x = {"position (samples)", -0.5, static_cast<double>(row.in.size()) - 0.5},
          .y = {"value"},
          .curves = {in, out}};
}

}  // namespace

void convolve_row(const ConvolutionOptions& args, Delivery& out) {
  const ConvolvedRow row = convolved_row(args);
  std::string text =
      fmt::format("values {}\nkernel {}\nresult {}\n", joined(row.in), joined(row.taps), joined(row.out));
  if (row.apart) text += fmt::format("greatest difference between space and frequency {:.3g}\n", *row.apart);
  Json::Array result;
  for (const double v : row.out) result.emplace_back(static_cast<float>(v));
  Json::Object json{{"values", Json::Array(row.in.begin(), row.in.end())},
                    {"kernel", Json::Array(row.taps.begin(), row.taps.end())},
                    {"border", name_of(args.border)},
                    {"result", std::move(result)}};
  if (row.apart) json.emplace_back("difference", *row.apart);
  if (!args.output.empty()) out.save_plots(args.output, std::vector{row_plot(args, row)}, 1, {});
  print_result(args, text, json, out);
}

}  // namespace zoneplate
