// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/option/lens_args.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/formats/json/json.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

constexpr double greatest = 1e9;

std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> out;
  for (const std::string& number : split_list(text)) out.push_back(parse_number(number, -greatest, greatest));
  return out;
}

/// OpenCV's order of coefficients.
constexpr double Lens::*coefficients[] = {&Lens::k1, &Lens::k2, &Lens::p1, &Lens::p2,
                                          &Lens::k3, &Lens::k4, &Lens::k5, &Lens::k6};

bool is_count(std::size_t n) { return n == 4 || n == 5 || n == 8; }

void set_distortion(const std::vector<double>& values, Lens& lens) {
  for (std::size_t i = 0; i < values.size(); ++i) lens.*coefficients[i] = values[i];
}

}  // namespace

std::vector<double> parse_intrinsics(const std::string& text) {
  std::vector<double> out = numbers_of(text);
  if (out.size() != 4 || !(out[0] > 0) || !(out[1] > 0))
    throw Error(ErrorKind::Usage, fmt::format("'{}' is not fx,fy,cx,cy with focal lengths above 0", text));
  return out;
}

std::vector<double> parse_distortion(const std::string& text) {
  std::vector<double> out = numbers_of(text);
  if (!is_count(out.size()))
    throw Error(ErrorKind::Usage,
                fmt::format("'{}' has {} coefficients; expected k1,k2,p1,p2[,k3[,k4,k5,k6]]", text, out.size()));
  return out;
}

Lens read_calibration(const std::string& path) {
  constexpr std::uint64_t max_bytes = 1 << 20;
  const FileBytes file(path, max_bytes);
  LoadLimits limits;
  ImportBudget budget(path, limits);
  const JsonValue value = parse_json(file.bytes(), budget);
  const JsonView root(value, path);
  const auto require = [&](const char* key) {
    if (!root.has(key)) root.fail(fmt::format("has no {}", key));
  };
  for (const char* const key : {"image_width", "image_height", "camera_matrix"}) require(key);
  Lens lens;
  lens.width = static_cast<int>(root.whole("image_width", std::nullopt, 1 << 20));
  lens.height = static_cast<int>(root.whole("image_height", std::nullopt, 1 << 20));
  const JsonView camera = root.object("camera_matrix");
  const std::vector<double> matrix = camera.doubles("data", 9);
  if (matrix.empty()) camera.fail("has no data");
  if (matrix[1] != 0 || matrix[3] != 0 || matrix[6] != 0 || matrix[7] != 0 || matrix[8] != 1)
    camera.fail("has a skew or a last row that is not 0, 0, 1");
  lens.fx = matrix[0], lens.cx = matrix[2], lens.fy = matrix[4], lens.cy = matrix[5];
  if (!(lens.fx > 0) || !(lens.fy > 0)) camera.fail("has focal lengths that are not above 0");
  if (lens.width < 1 || lens.height < 1) root.fail("has an image without pixels");
  if (root.has("distortion_coefficients")) {
    const JsonView view = root.object("distortion_coefficients");
    std::vector<double> values = view.doubles("data", 0);
    while (values.size() > 8 && values.back() == 0) values.pop_back();
    if (values.size() > 5 && values.size() < 8) values.resize(8, 0.0);
    if (!values.empty() && !is_count(values.size()))
      view.fail(fmt::format("has {} coefficients; 4, 5 and 8 are supported", values.size()));
    set_distortion(values, lens);
  }
  return lens;
}

std::optional<Lens> LensArgs::lens(int width, int height) const {
  if (calibrated) {
    if (!intrinsics.empty() || !distortion.empty())
      throw Error(ErrorKind::Usage,
                  "--camera-calibration has the intrinsics and the distortion: it goes with neither option");
    // A smaller or larger image of the same view, up to the rounding of its size.
    const double error = std::abs(1.0 * width * calibrated->height - 1.0 * height * calibrated->width);
    if (error > std::max(calibrated->width, calibrated->height))
      throw Error(ErrorKind::Usage, fmt::format("--camera-calibration is for an image of {}x{}, and not of {}x{}",
                                                calibrated->width, calibrated->height, width, height));
    return calibrated;
  }
  if (intrinsics.empty()) {
    if (!distortion.empty()) throw Error(ErrorKind::Usage, "--camera-distortion requires --camera-intrinsics");
    return std::nullopt;
  }
  Lens lens{.width = width,
            .height = height,
            .fx = intrinsics[0],
            .fy = intrinsics[1],
            .cx = intrinsics[2],
            .cy = intrinsics[3]};
  set_distortion(distortion, lens);
  return lens;
}

}  // namespace zoneplate
