// SPDX-License-Identifier: Apache-2.0
// SMAA: detects edges by contrast, follows each to its ends, and blends its pixels by the area under the line through
// the ends.
//
// It preserves corners, detects diagonals, and smooths long edges better than FXAA. Weaknesses: details thinner than a
// pixel: thin wires stay broken, and an edge longer than the search is split in two. S2x improves wires and steep
// edges; long isolated edges have a greater error than with one sample, because the original's areas for off-centre
// samples are the mean of each step's line and of two halves.
//
// Source: Jimenez, Echevarria, Sousa, Gutierrez, SMAA: Enhanced Subpixel Morphological Antialiasing, Eurographics 2012;
// code v2.8: 1x, S2x and predicated thresholds. Edges are detected on encoded values, colours blended in linear light.
//
// Predication doubles the thresholds except where a second buffer changes, so that textures are unchanged and faint
// outlines are still detected. The original accepts any buffer, and notes that the depth buffer itself is suitable for
// short depth ranges only. Here the buffer is the logarithm of the distance along the view axis, so that 0.01 is one
// percent everywhere, or object ids. Weakness: borders across which neither changes: creases and coplanar borders.
#include "zoneplate/antialias/post/smaa/smaa.h"

#include <algorithm>
#include <limits>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/post_process.h"
#include "zoneplate/base/error.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/elementary.h"

namespace zoneplate::antialias {
Rgba8Image apply_smaa(const Rgba8Image& image, const Plane<float>* depth, const SmaaOptions& options,
                      Rgba8Image memory) {
  if (image.empty()) return image;
  const EdgePlane edges = smaa_edge_detection(image, depth, options);
  const SmaaBlendingWeights weights(edges, options);
  return smaa_neighborhood_blending(image, weights, options, std::move(memory));
}

namespace {

struct Preset {
  std::string_view name;
  double threshold;
  int steps, diagonal_steps, corner_rounding;
};
constexpr Preset presets[] = {
    {"low", 0.15, 4, 0, 100}, {"medium", 0.1, 8, 0, 100}, {"high", 0.1, 16, 8, 25}, {"ultra", 0.05, 32, 16, 25}};
constexpr std::string_view preset_names[] = {"low", "medium", "high", "ultra"};
constexpr std::string_view edges_names[] = {"luma", "color", "depth"};
constexpr std::string_view modes[] = {"1x", "s2x"};
constexpr std::string_view mixings[] = {"light", "codes"};
constexpr std::string_view predications[] = {"none", "depth", "objects"};
constexpr Param params[] = {
    {.name = "preset",
     .meaning = "edge threshold and search length, as in the original",
     .value = 2,
     .names = preset_names},
    {.name = "edges", .meaning = "values in which edges are detected", .value = 0, .names = edges_names},
    {.name = "mode",
     .meaning = "s2x: two samples per pixel, each filtered as an image of its own",
     .value = 0,
     .names = modes},
    {.name = "predication", .meaning = "buffer whose changes lower the threshold", .value = 0, .names = predications},
    {.name = "pthreshold",
     .meaning = "minimum change of the logarithm of depth, or of object ids",
     .value = 0.01,
     .low = 0,
     .high = 1,
     .decimals = 3},
    {.name = "pscale",
     .meaning = "factor of the threshold where the predication buffer does not change",
     .value = 2,
     .low = 1,
     .high = 5,
     .decimals = 1},
    {.name = "pstrength",
     .meaning = "fraction by which the threshold is lowered where it changes",
     .value = 0.4,
     .low = 0,
     .high = 1,
     .decimals = 2},
    {.name = "mix",
     .meaning = "blending in linear light or in sRGB-encoded values (codes)",
     .value = 0,
     .names = mixings},
};

/// The contents of the predication buffer.
enum class Predication { None, Depth, Objects };

SmaaOptions options_of(const Settings& s) {
  SmaaOptions o;
  for (const Preset& p : presets)
    if (p.name == s.chosen("preset"))
      o.threshold = p.threshold, o.steps = p.steps, o.diagonal_steps = p.diagonal_steps,
      o.corner_rounding = p.corner_rounding;
  o.edges = static_cast<SmaaOptions::Edges>(s.integer("edges"));
  o.is_predicated = s.chosen("predication") != "none";
  o.predication_threshold = s.number("pthreshold");
  o.predication_scale = s.number("pscale");
  o.predication_strength = s.number("pstrength");
  o.mixes_light = s.chosen("mix") == "light";
  return o;
}

Mixing mixing_of(const SmaaOptions& options) { return options.mixes_light ? Mixing::Linear : Mixing::Encoded; }

/// A plane with the values of another plane, each transformed by `change`.
template <class T, class Change>
Plane<float> changed(const Plane<T>& from, Change change) {
  Plane<float> out(from.width(), from.height());
  for_rows(out.height(), [&](int y) { std::ranges::transform(from.row(y), out.row(y).begin(), change); });
  return out;
}

class Smaa : public Resolver {
 public:
  Smaa(const SmaaOptions& options, Predication predication) : options_(options), predication_(predication) {}
  Request request(const FrameContext&) override {
    Request request = display_referred_request(smaa_reach(options_));
    request.planes.depth = options_.edges == SmaaOptions::Edges::Depth || predication_ == Predication::Depth;
    request.planes.object_id = predication_ == Predication::Objects;
    return request;
  }
  DisplayImage post_process(DisplayImage image, const Frame& frame) override {
    const Plane<float> predicate = predication_buffer(frame);
    const Plane<float>& depth = options_.is_predicated ? predicate : frame.reversed_depth;
    return filter_encoded(std::move(image), mixing_of(options_),
                          [&](const Rgba8Image& i) { return apply_smaa(i, &depth, options_); });
  }

 private:
  /// Depths are stored as logarithms, whose differences are relative: independent of the scene's size and projection.
  Plane<float> predication_buffer(const Frame& frame) const {
    if (predication_ == Predication::Depth)
      return changed(frame.depth, [](float d) { return d < std::numeric_limits<float>::infinity() ? log(d) : d; });
    if (predication_ == Predication::Objects)
      return changed(frame.object_id, [](std::uint32_t id) { return static_cast<float>(id); });
    return {};
  }

  SmaaOptions options_;
  Predication predication_;
};

/// The mean of two display-referred pixels, premultiplied.
Display mean_of(const Display& a, const Display& b, Mixing mixing) {
  if (a == b) return a;
  const float alpha = (a.a + b.a) / 2;
  if (!(alpha > 0)) return {0, 0, 0, 0};
  const auto mean = [&](float p, float q) {
    if (mixing == Mixing::Encoded) return (p * a.a + q * b.a) / (2 * alpha);
    return encode_srgb((decode_srgb(p) * a.a + decode_srgb(q) * b.a) / (2 * alpha));
  };
  return {mean(a.r, b.r), mean(a.g, b.g), mean(a.b, b.b), alpha};
}

/// S2x: each sample of the standard pattern of two gives a display-referred image, which is filtered separately, with
/// the areas for the sample's position.
class SmaaS2x : public Resolver {
 public:
  explicit SmaaS2x(const SmaaOptions& options) : options_(options) {}
  Request request(const FrameContext&) override {
    Request request = display_referred_request(smaa_reach(options_));
    request.samples = standard_pattern(2);
    request.planes.samples = true;
    return request;
  }
  DisplayImage post_process(DisplayImage image, const Frame& frame) override {
    constexpr std::array<int, 4> slots[2] = {{1, 1, 1, 0}, {2, 2, 2, 0}};
    DisplayImage treated[2];
    for (std::size_t s = 0; s < 2; ++s) {
      SmaaOptions options = options_;
      options.slots = slots[s];
      treated[s] = filter_encoded(make_display(frame.sample_color[s], frame.display), mixing_of(options),
                                  [&](const Rgba8Image& i) { return apply_smaa(i, &frame.sample_depth[s], options); });
    }
    for_rows(image.height(), [&](int y) {
      for (int x = 0; x < image.width(); ++x)
        image(x, y) = mean_of(treated[0](x, y), treated[1](x, y), mixing_of(options_));
    });
    return image;
  }

 private:
  SmaaOptions options_;
};

std::unique_ptr<Resolver> make(const Settings& s) {
  const SmaaOptions options = options_of(s);
  const auto predication = static_cast<Predication>(s.integer("predication"));
  if (options.is_predicated && (options.edges == SmaaOptions::Edges::Depth || s.chosen("mode") == "s2x"))
    throw Error(ErrorKind::Usage, "smaa: predication is for luma and color edges of mode=1x");
  if (!options.is_predicated && (s.is_given("pthreshold") || s.is_given("pscale") || s.is_given("pstrength")))
    throw Error(ErrorKind::Usage, "smaa: pthreshold, pscale and pstrength are predication's: give predication=depth");
  if (s.chosen("mode") == "s2x") return std::make_unique<SmaaS2x>(options);
  return std::make_unique<Smaa>(options, predication);
}

constexpr std::string_view variants[] = {"edges=color", "mode=s2x", "predication=depth"};

}  // namespace

Method smaa() {
  return {.name = "smaa",
          .summary = "edges followed to their ends, pixels blended by the area under the line through them",
          .source = "Jimenez 2012, SMAA 2.8",
          .params = params,
          .make = make,
          .variants = variants};
}

}  // namespace zoneplate::antialias
