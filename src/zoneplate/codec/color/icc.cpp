// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/color/icc.h"

#include <fmt/format.h>
#include <lcms2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <type_traits>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/os/library.h"
#include "zoneplate/os/limited_child.h"

namespace zoneplate {
namespace {

using ByteSpan = std::span<const std::uint8_t>;

[[noreturn]] void fail(const std::string& cause) { throw Error(ErrorKind::Input, cause); }

struct IccLibrary {
  SharedLibrary library;
  decltype(&cmsCreateContext) create_context = library.find("cmsCreateContext");
  decltype(&cmsDeleteContext) delete_context = library.find("cmsDeleteContext");
  decltype(&cmsSetLogErrorHandlerTHR) set_error_handler = library.find("cmsSetLogErrorHandlerTHR");
  decltype(&cmsOpenProfileFromMemTHR) open_profile = library.find("cmsOpenProfileFromMemTHR");
  decltype(&cmsCloseProfile) close_profile = library.find("cmsCloseProfile");
  decltype(&cmsGetProfileInfoASCII) text = library.find("cmsGetProfileInfoASCII");
  decltype(&cmsIsCLUT) has_table = library.find("cmsIsCLUT");
  decltype(&cmsReadTag) read_tag = library.find("cmsReadTag");
  decltype(&cmsEvalToneCurveFloat) value_on = library.find("cmsEvalToneCurveFloat");
  decltype(&cmsBuildGamma) build_gamma = library.find("cmsBuildGamma");
  decltype(&cmsFreeToneCurve) free_curve = library.find("cmsFreeToneCurve");
  decltype(&cmsCreateRGBProfileTHR) create_profile = library.find("cmsCreateRGBProfileTHR");
  decltype(&cmsCreateTransformTHR) create_transform = library.find("cmsCreateTransformTHR");
  decltype(&cmsDeleteTransform) delete_transform = library.find("cmsDeleteTransform");
  decltype(&cmsDoTransform) transform = library.find("cmsDoTransform");

  explicit IccLibrary(const std::string& name) : library(Library::Lcms, name + ": an ICC profile") {}
};

/// What the library finds, in memory of a fixed layout.
struct Findings {
  std::array<char, 128> name{};
  Matrix3 rec709_from_rgb = identity3;
  std::uint32_t curves = 0;
  bool has_grid = false;
};

constexpr std::size_t grid_values = std::size_t{3} * RgbSpace::grid_side * RgbSpace::grid_side * RgbSpace::grid_side;

/// sRGB's curve, beyond [0, 1] too.
float encode_extended(float light) {
  const float v = std::abs(light);
  const float code = v <= 1 ? encode_srgb(v) : 1.055f * pow(v, 1 / 2.4f) - 0.055f;
  return light < 0 ? -code : code;
}

template <class T>
using Owned = std::unique_ptr<std::remove_pointer_t<T>, void (*)(T)>;

/// A profile of the library.
class IccReader {
 public:
  IccReader(const IccLibrary& library, ByteSpan bytes) : library_(library) {
    context_ = library.create_context(nullptr, nullptr);
    if (context_ == nullptr) throw std::bad_alloc();
    library.set_error_handler(context_, [](cmsContext, cmsUInt32Number, const char*) {});
    profile_ = library.open_profile(context_, bytes.data(), static_cast<cmsUInt32Number>(bytes.size()));
  }
  ~IccReader() {
    if (profile_ != nullptr) library_.close_profile(profile_);
    library_.delete_context(context_);
  }
  IccReader(const IccReader&) = delete;
  IccReader& operator=(const IccReader&) = delete;

  RgbSpace read(bool has_one_curve) {
    if (profile_ == nullptr) fail("is corrupt");
    RgbSpace space{.profile = {}, .name = {}, .curves = {}, .grid = {}};
    std::array<char, 128> name{};
    library_.text(profile_, cmsInfoDescription, "en", "US", name.data(), name.size() - 1);
    space.name = printable(name.data());
    if (has_one_curve) {
      space.curves = {sampled(curve_of(cmsSigGrayTRCTag, "grey"), "grey")};
    } else if (library_.has_table(profile_, INTENT_PERCEPTUAL, LCMS_USED_AS_INPUT) != 0) {
      read_table(space);
    } else {
      const cmsToneCurve *const red = curve_of(cmsSigRedTRCTag, "red"),
                                *const green = curve_of(cmsSigGreenTRCTag, "green"),
                                *const blue = curve_of(cmsSigBlueTRCTag, "blue");
      space.curves = {sampled(red, "red")};
      // Tags with the same data have the same curve in memory.
      if (green != red || blue != red) space.curves.push_back(sampled(green, "green"));
      if (green != red || blue != red) space.curves.push_back(sampled(blue, "blue"));
      read_colorants(space);
    }
    return space;
  }

 private:
  const cmsToneCurve* curve_of(cmsTagSignature tag, const char* what) const {
    const auto* const curve = static_cast<const cmsToneCurve*>(library_.read_tag(profile_, tag));
    if (curve == nullptr) fail(fmt::format("has no sound curve of {}", what));
    return curve;
  }

  std::vector<float> sampled(const cmsToneCurve* curve, const char* what) const {
    std::vector<float> out = make_curve([&](float value) { return library_.value_on(curve, value); });
    if (!std::ranges::all_of(out, [](float light) { return std::isfinite(light); }))
      fail(fmt::format("has a curve of {} that is not finite", what));
    return out;
  }

  void read_colorants(RgbSpace& space) {
    constexpr std::array<cmsTagSignature, 3> tags = {cmsSigRedColorantTag, cmsSigGreenColorantTag,
                                                     cmsSigBlueColorantTag};
    std::array<double, 9> xyz{};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto* const color = static_cast<const cmsCIEXYZ*>(library_.read_tag(profile_, tags[c]));
      if (color == nullptr) fail("has no sound primaries");
      xyz[c] = color->X, xyz[3 + c] = color->Y, xyz[6 + c] = color->Z;
    }
    space.rec709_from_rgb = rec709_from_d50(xyz);
  }

  void read_table(RgbSpace& space) {
    const cmsCIExyY white = {0.3127, 0.329, 1};
    const cmsCIExyYTRIPLE primaries = {{0.64, 0.33, 1}, {0.3, 0.6, 1}, {0.15, 0.06, 1}};
    const Owned<cmsToneCurve*> line(library_.build_gamma(context_, 1), library_.free_curve);
    cmsToneCurve* curves[3] = {line.get(), line.get(), line.get()};
    cmsHPROFILE rec709 = library_.create_profile(context_, &white, &primaries, curves);
    if (rec709 == nullptr) throw std::bad_alloc();
    const Owned<cmsHTRANSFORM> transform(
        library_.create_transform(context_, profile_, TYPE_RGB_FLT, rec709, TYPE_RGB_FLT, INTENT_PERCEPTUAL,
                                  cmsFLAGS_NOOPTIMIZE | cmsFLAGS_NOCACHE),
        library_.delete_transform);
    library_.close_profile(rec709);
    if (!transform) fail("has corrupt tables");

    constexpr int side = RgbSpace::grid_side;
    std::vector<float> nodes;
    nodes.reserve(grid_values);
    for (int i = 0; i < side * side * side; ++i)
      for (const int step : {i / side / side, i / side % side, i % side})
        nodes.push_back(static_cast<float>(step) / (side - 1));
    space.grid.resize(grid_values);
    library_.transform(transform.get(), nodes.data(), space.grid.data(), side * side * side);
    for (float& value : space.grid) {
      if (!std::isfinite(value)) fail("has tables that are not finite");
      value = encode_extended(value);
    }
  }

  const IccLibrary& library_;
  cmsContext context_ = nullptr;
  cmsHPROFILE profile_ = nullptr;
};

/// A four-letter code of the header.
std::string code_at(ByteSpan profile, std::size_t at) {
  const std::string code(reinterpret_cast<const char*>(profile.data()) + at, 4);
  return printable(code.substr(0, code.find_last_not_of(' ') + 1));
}

void check_header(ByteSpan profile, bool is_grey) {
  if (icc_pixels(profile).empty()) fail("has no header");
  if (profile.size() > max_icc_bytes)
    fail(fmt::format("has {} bytes, at most {} are read", profile.size(), max_icc_bytes));
  const std::size_t stated =
      std::size_t{profile[0]} << 24 | std::size_t{profile[1]} << 16 | std::size_t{profile[2]} << 8 | profile[3];
  if (stated > profile.size()) fail(fmt::format("is cut off: it states {} bytes and has {}", stated, profile.size()));
  const std::string kind = code_at(profile, 12), pixels = icc_pixels(profile);
  for (const char* of_no_image : {"link", "abst", "nmcl"})
    if (kind == of_no_image) fail(fmt::format("is of class {}, which describes no image", kind));
  if (pixels != "RGB " && !(is_grey && pixels == "GRAY"))
    fail(fmt::format("is of {} pixels, expected {}", code_at(profile, 16), is_grey ? "GRAY or RGB" : "RGB"));
  if (pixels == "GRAY" && code_at(profile, 20) != "XYZ") fail("is of GRAY pixels in Lab, which is not read");
}

}  // namespace

std::string icc_pixels(ByteSpan profile) {
  constexpr std::size_t header = 128;
  if (profile.size() < header || std::memcmp(profile.data() + 36, "acsp", 4) != 0) return {};
  return {reinterpret_cast<const char*>(profile.data()) + 16, 4};
}

void open_icc_library(const std::string& name) { static_cast<void>(IccLibrary(name)); }

RgbSpace read_icc_space(ByteSpan profile, bool is_grey) {
  check_header(profile, is_grey);
  const bool has_one_curve = icc_pixels(profile) == "GRAY";
  const IccLibrary library("the image");
  if (is_limited_child()) return IccReader(library, profile).read(has_one_curve);

  LimitedChild child("ICC profile",
                     {.memory = std::uint64_t{256} << 20, .seconds = 10, .options = {}, .check_time = {}},
                     [&](ChildAnswer& answer) {
                       const RgbSpace space = IccReader(library, profile).read(has_one_curve);
                       Findings found{.rec709_from_rgb = space.rec709_from_rgb,
                                      .curves = static_cast<std::uint32_t>(space.curves.size()),
                                      .has_grid = !space.grid.empty()};
                       std::strncpy(found.name.data(), space.name.c_str(), found.name.size() - 1);
                       answer.write(&found, sizeof found);
                       for (const std::vector<float>& curve : space.curves)
                         answer.write(curve.data(), curve.size() * sizeof(float));
                       answer.write(space.grid.data(), space.grid.size() * sizeof(float));
                     });
  Findings found;
  child.read(&found, sizeof found);
  found.name.back() = '\0';
  if (!inverse(found.rec709_from_rgb)) fail("has primaries that span no triangle");
  RgbSpace space{.profile = {},
                 .name = printable(found.name.data()),
                 .curves = {std::min<std::size_t>(found.curves, 3), std::vector<float>(curve_size)},
                 .rec709_from_rgb = found.rec709_from_rgb,
                 .grid = std::vector<float>(found.has_grid ? grid_values : 0)};
  for (std::vector<float>& curve : space.curves) child.read(curve.data(), curve.size() * sizeof(float));
  child.read(space.grid.data(), space.grid.size() * sizeof(float));
  return space;
}

}  // namespace zoneplate
