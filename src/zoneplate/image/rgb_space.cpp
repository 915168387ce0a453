// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/rgb_space.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/elementary.h"

namespace zoneplate {
namespace {

using Column = std::array<double, 3>;

[[noreturn]] void fail(const std::string& cause) { throw Error(ErrorKind::Input, cause); }

Column applied(const Matrix3& m, const Column& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

/// XYZ of luminance 1.
Column xyz_of(double x, double y) { return {x / y, 1, (1 - x - y) / y}; }

constexpr std::array<double, 8> rec709 = {0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329};
constexpr Column d50 = {0.9642, 1, 0.8249};  // the illuminant of the profile connection space, ICC.1:2022

/// XYZ of red, green and blue as columns, whose sum is white of luminance 1.
Matrix3 xyz_from(const std::array<double, 8>& c) {
  const Column r = {c[0], c[1], 1 - c[0] - c[1]}, g = {c[2], c[3], 1 - c[2] - c[3]}, b = {c[4], c[5], 1 - c[4] - c[5]};
  const Matrix3 directions = {r[0], g[0], b[0], r[1], g[1], b[1], r[2], g[2], b[2]};
  const std::optional<Matrix3> inverted = inverse(directions);
  if (!inverted || !(c[7] > 0)) fail("has primaries or a white of no colour");
  const Column scale = applied(*inverted, xyz_of(c[6], c[7]));
  for (const double s : scale)
    if (!(s > 0) || !(s < 1e6)) fail("has a white outside its primaries");
  Matrix3 out = directions;
  for (std::size_t i = 0; i < 9; ++i) out[i] *= scale[i % 3];
  return out;
}

/// Bradford's adaptation of a white to another.
Matrix3 adaptation(const Column& from, const Column& to) {
  constexpr Matrix3 cones = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
  const Column a = applied(cones, from), b = applied(cones, to);
  Matrix3 scaled = cones;
  for (std::size_t i = 0; i < 9; ++i) scaled[i] *= b[i / 3] / a[i / 3];
  return *inverse(cones) * scaled;
}

Matrix3 invertible(const Matrix3& m) {
  if (!inverse(m)) fail("has primaries that span no triangle");
  return m;
}

// Curves of ITU-T H.273, table 3, by their code points: light of 1 for the reference white.

float linear_below(float value, float slope, float limit, float offset, float exponent) {
  return value < limit ? value / slope : pow((value + offset) / (1 + offset), exponent);
}

float light_of_pq(float value) {
  constexpr float m1 = 2610.0f / 16384, m2 = 2523.0f / 4096 * 128;
  constexpr float c1 = 3424.0f / 4096, c2 = 2413.0f / 4096 * 32, c3 = 2392.0f / 4096 * 32;
  constexpr float peak = 10000.0f / 203;  // cd/m² of the code 1, and of the reference white
  const float p = pow(value, 1 / m2);
  return peak * pow(std::max(p - c1, 0.0f) / (c2 - c3 * p), 1 / m1);
}

float light_of_hlg(float value) {
  constexpr float a = 0.17883277f, b = 0.28466892f, c = 0.55991073f;
  const auto scene = [&](float v) { return v <= 0.5f ? v * v / 3 : (exp((v - c) / a) + b) / 12; };
  return scene(value) / scene(0.75f);
}

float light_of_cicp(std::uint8_t curve, float value) {
  switch (curve) {
    case 1:
    case 6:
    case 14:
    case 15:
      return linear_below(value, 4.5f, 0.0812428583f, 0.0992968268f, 1 / 0.45f);
    case 4:
      return pow(value, 2.2f);
    case 5:
      return pow(value, 2.8f);
    case 7:
      return linear_below(value, 4, 0.0912f, 0.1115f, 1 / 0.45f);
    case 8:
      return value;
    case 13:
      return decode_srgb(value);
    case 16:
      return light_of_pq(value);
    case 17:
      return pow(value, 2.6f) * (52.37f / 48);
    case 18:
      return light_of_hlg(value);
    default:
      fail("has transfer function " + std::to_string(curve) + ", which is not read");
  }
}

/// The chromaticities of a code point of H.273, table 2.
std::array<double, 8> primaries_of_cicp(std::uint8_t primaries) {
  switch (primaries) {
    case 1:
      return rec709;
    case 4:
      return {0.67, 0.33, 0.21, 0.71, 0.14, 0.08, 0.31, 0.316};
    case 5:
      return {0.64, 0.33, 0.29, 0.6, 0.15, 0.06, 0.3127, 0.329};
    case 6:
    case 7:
      return {0.63, 0.34, 0.31, 0.595, 0.155, 0.07, 0.3127, 0.329};
    case 8:
      return {0.681, 0.319, 0.243, 0.692, 0.145, 0.049, 0.31, 0.316};
    case 9:
      return {0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329};
    case 10:
      return {1, 0, 0, 1, 0, 0, 1.0 / 3, 1.0 / 3};
    case 11:
      return {0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.314, 0.351};
    case 12:
      return {0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.3127, 0.329};
    case 22:
      return {0.63, 0.34, 0.295, 0.605, 0.155, 0.077, 0.3127, 0.329};
    default:
      fail("has primaries " + std::to_string(primaries) + ", which are not read");
  }
}

void read_cicp(const std::array<std::uint8_t, 4>& c, RgbSpace& space) {
  if (c[2] != 0) fail("has matrix " + std::to_string(c[2]) + ", expected 0 (RGB)");
  if (c[3] > 1) fail("has range " + std::to_string(c[3]) + ", expected 0 or 1");
  space.rec709_from_rgb = rec709_from(primaries_of_cicp(c[0]));
  const bool is_narrow = c[3] == 0;
  if (c[1] == 8 && !is_narrow) return;
  space.curves.push_back(make_curve([&](float value) {
    // Codes of the narrow range: black is 16 and white 235 of 255.
    if (is_narrow) value = std::clamp((value * 255 - 16) / 219, 0.0f, 1.0f);
    return light_of_cicp(c[1], value);
  }));
}

/// In units of 1/100000: a gamma near 1 / 2.2, which programs write for sRGB.
bool is_gamma_of_srgb(std::uint32_t gamma) { return gamma >= 45445 && gamma <= 45465; }

void read_gamma(const ColorProfile& profile, RgbSpace& space) {
  constexpr std::uint32_t one = 100000, least = 1000, most = 10'000'000;
  if (profile.primaries) {
    std::array<double, 8> c{};  // white comes first in PNG
    for (std::size_t i = 0; i < 8; ++i) c[(i + 6) % 8] = (*profile.primaries)[i] / static_cast<double>(one);
    space.rec709_from_rgb = rec709_from(c);
  }
  if (!profile.gamma) {
    space.curves.push_back(make_curve([](float value) { return decode_srgb(value); }));
    return;
  }
  if (*profile.gamma < least || *profile.gamma > most)
    fail("has the value " + std::to_string(*profile.gamma) + ", expected 1000 to 10000000");
  const float exponent = static_cast<float>(one / static_cast<double>(*profile.gamma));
  if (*profile.gamma != one) space.curves.push_back(make_curve([&](float value) { return pow(value, exponent); }));
}

float extended(float value, float (*positive)(float)) { return value < 0 ? -positive(-value) : positive(value); }
float decode_extended(float code) {
  return extended(code, [](float v) { return v <= 1 ? decode_srgb(v) : pow((v + 0.055f) / 1.055f, 2.4f); });
}

using Rgb = std::array<float, 3>;

float light_on(const std::vector<float>& curve, float value) {
  const float place = std::clamp(value, 0.0f, 1.0f) * (curve_size - 1);
  const auto i = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(curve_size - 2));
  const float t = place - static_cast<float>(i);
  return curve[i] + (curve[i + 1] - curve[i]) * t;
}

float code_on(const std::vector<float>& curve, float light) {
  if (!(light > curve.front())) return 0;
  const auto above = std::upper_bound(curve.begin(), curve.end(), light);
  if (above == curve.end()) return 1;
  const float low = above[-1], t = (light - low) / (*above - low);
  return (static_cast<float>(above - curve.begin() - 1) + t) / (curve_size - 1);
}

/// Interpolates the grid along all three axes.
Rgb light_in_grid(const std::vector<float>& grid, Rgb v) {
  constexpr int side = RgbSpace::grid_side;
  std::array<std::size_t, 3> node{};
  Rgb t{};
  for (std::size_t c = 0; c < 3; ++c) {
    const float place = std::clamp(v[c], 0.0f, 1.0f) * (side - 1);
    node[c] = std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(side - 2));
    t[c] = place - static_cast<float>(node[c]);
  }
  Rgb sum{};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    float weight = 1;
    std::size_t index = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t step = corner >> c & 1;
      weight *= step == 1 ? t[c] : 1 - t[c];
      index = index * side + node[c] + step;
    }
    for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * grid[3 * index + c];
  }
  for (float& code : sum) code = decode_extended(code);
  return sum;
}

Rgb light_of(const RgbSpace& space, Rgb v) {
  if (!space.grid.empty()) return light_in_grid(space.grid, v);
  if (space.curves.empty()) return v;
  for (std::size_t c = 0; c < 3; ++c) v[c] = light_on(space.curves[space.curves.size() == 1 ? 0 : c], v[c]);
  return v;
}

Rgb code_of(const RgbSpace& space, Rgb light) {
  for (std::size_t c = 0; c < 3; ++c)
    light[c] = space.curves.empty() ? std::clamp(light[c], 0.0f, 1.0f)
                                    : code_on(space.curves[space.curves.size() == 1 ? 0 : c], light[c]);
  return light;
}

Rgb product(const Matrix3& m, const Rgb& v) {
  const Column out = applied(m, {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])});
  return {static_cast<float>(out[0]), static_cast<float>(out[1]), static_cast<float>(out[2])};
}

template <class From, class To, class Convert>
void convert_rows(const Plane<From>& from, Plane<To>& to, const Convert& convert) {
  parallel_for(static_cast<std::size_t>(from.height()), [&](std::size_t y) {
    std::ranges::transform(from.row(static_cast<int>(y)), to.row(static_cast<int>(y)).begin(), convert);
  });
}

}  // namespace

Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
  Matrix3 out{};
  for (std::size_t i = 0; i < 9; ++i) {
    const std::size_t row = i / 3 * 3, column = i % 3;
    out[i] = a[row] * b[column] + a[row + 1] * b[column + 3] + a[row + 2] * b[column + 6];
  }
  return out;
}

std::optional<Matrix3> inverse(const Matrix3& m) {
  const Matrix3 adjugate = {m[4] * m[8] - m[5] * m[7], m[2] * m[7] - m[1] * m[8], m[1] * m[5] - m[2] * m[4],
                            m[5] * m[6] - m[3] * m[8], m[0] * m[8] - m[2] * m[6], m[2] * m[3] - m[0] * m[5],
                            m[3] * m[7] - m[4] * m[6], m[1] * m[6] - m[0] * m[7], m[0] * m[4] - m[1] * m[3]};
  const double determinant = m[0] * adjugate[0] + m[1] * adjugate[3] + m[2] * adjugate[6];
  if (!(std::abs(determinant) > 1e-9) || !(std::abs(determinant) < 1e9)) return std::nullopt;
  Matrix3 out = adjugate;
  for (double& v : out) v /= determinant;
  return out;
}

Matrix3 rec709_from(const std::array<double, 8>& c) {
  const Matrix3 xyz = xyz_from(c);
  return invertible(*inverse(xyz_from(rec709)) * adaptation(xyz_of(c[6], c[7]), xyz_of(rec709[6], rec709[7])) * xyz);
}

Matrix3 rec709_from_d50(const std::array<double, 9>& xyz_of_rgb) {
  return invertible(*inverse(xyz_from(rec709)) * adaptation(d50, xyz_of(rec709[6], rec709[7])) * xyz_of_rgb);
}

RgbSpacePtr make_rgb_space(const ColorProfile& profile) {
  RgbSpace space{.profile = profile, .name = {}, .curves = {}, .grid = {}};
  if (profile.cicp) {
    read_cicp(*profile.cicp, space);
  } else if (profile.gamma || profile.primaries) {
    read_gamma(profile, space);
  } else if (profile.chromaticities) {
    std::array<double, 8> c{};
    std::ranges::copy(*profile.chromaticities, c.begin());
    space.rec709_from_rgb = rec709_from(c);
  } else {
    return nullptr;
  }
  recognize_standard(space);
  return std::make_shared<const RgbSpace>(std::move(space));
}

void recognize_standard(RgbSpace& space) {
  constexpr double near = 1e-3;
  bool has_same_primaries = space.grid.empty();
  for (std::size_t i = 0; i < 9 && has_same_primaries; ++i)
    has_same_primaries = std::abs(space.rec709_from_rgb[i] - identity3[i]) < near;
  if (space.profile.chromaticities && space.curves.empty()) {
    space.is_standard = has_same_primaries;
    return;
  }
  const ColorProfile& profile = space.profile;
  if (!profile.cicp && profile.icc.empty() && profile.gamma && is_gamma_of_srgb(*profile.gamma)) {
    space.is_standard = has_same_primaries;
    return;
  }
  // sRGB IEC61966-2.1, the usual ICC profile, differs by 0.51 of a code: its white is that of other decimals.
  constexpr float most = 0.75f / 255;
  constexpr int steps = 15;  // 17 codes from one to the next
  space.is_standard = true;
  for (int i = 0; i < (steps + 1) * (steps + 1) * (steps + 1) && space.is_standard; ++i) {
    const auto code = [&](int n) { return static_cast<float>(n % (steps + 1)) / steps; };
    const Rgb v = {code(i / (steps + 1) / (steps + 1)), code(i / (steps + 1)), code(i)};
    const Rgb light = product(space.rec709_from_rgb, light_of(space, v));
    for (std::size_t c = 0; c < 3; ++c)
      if (!(std::abs(encode_srgb(light[c]) - v[c]) <= most)) space.is_standard = false;
  }
}

bool is_same(const RgbSpacePtr& a, const RgbSpacePtr& b) {
  const auto is_standard = [](const RgbSpacePtr& space) { return !space || space->is_standard; };
  if (is_standard(a) || is_standard(b)) return is_standard(a) && is_standard(b);
  return a->profile == b->profile;
}

bool can_encode(const RgbSpace& space) {
  return space.grid.empty() && std::ranges::all_of(space.curves, [](const std::vector<float>& curve) {
           return std::is_sorted(curve.begin(), curve.end()) && curve.front() < curve.back();
         });
}

LinearImage light_of(const DisplayImage& image, const RgbSpace& space) {
  LinearImage out(image.width(), image.height());
  convert_rows(image, out, [&](Display c) {
    const Rgb light = light_of(space, {c.r, c.g, c.b});
    return Linear{light[0] * c.a, light[1] * c.a, light[2] * c.a, c.a};
  });
  return out;
}

DisplayImage codes_of(const LinearImage& light, const RgbSpace& space) {
  DisplayImage out(light.width(), light.height());
  convert_rows(light, out, [&](const Linear& c) {
    if (!(c.a > 0)) return Display{0, 0, 0, 0};
    const Rgb code = code_of(space, {c.r / c.a, c.g / c.a, c.b / c.a});
    return Display{code[0], code[1], code[2], std::min(c.a, 1.0f)};
  });
  return out;
}

void convert_to_rec709(LinearImage& light, const RgbSpace& space) {
  if (!space.grid.empty() || space.rec709_from_rgb == identity3) return;
  convert_rows(light, light, [&](const Linear& c) {
    const Rgb out = product(space.rec709_from_rgb, {c.r, c.g, c.b});
    return Linear{out[0], out[1], out[2], c.a};
  });
}

Linear from_rec709(Linear light, const RgbSpace& space) {
  if (!space.grid.empty() || space.rec709_from_rgb == identity3) return light;
  const Rgb out = product(*inverse(space.rec709_from_rgb), {light.r, light.g, light.b});
  return {out[0], out[1], out[2], light.a};
}

}  // namespace zoneplate
