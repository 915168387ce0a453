// SPDX-License-Identifier: Apache-2.0
// SMAA: detects edges by contrast, follows each to its ends, and blends its pixels by the area under the line through
// the ends.
//
// It preserves corners, detects diagonals, and smooths long edges better than FXAA. Weaknesses: details thinner than a
// pixel: thin wires stay broken, and an edge longer than the search is split in two. S2x improves wires and steep
// edges; long isolated edges have a greater error than with one sample, because the original's areas for off-centre
// samples are the mean of each step's line and of two halves, and ignore the offset along the edge (see
// smaa_exact.cpp).
//
// Source: Jimenez, Echevarria, Sousa, Gutierrez, SMAA: Enhanced Subpixel Morphological Antialiasing, Eurographics 2012;
// code v2.8: 1x, S2x, T2x, 4x and predicated thresholds. Edges are detected on encoded values, colours blended in
// linear light.
//
// Predication doubles the thresholds except where a second buffer changes, so that textures are unchanged and faint
// outlines are still detected. The original accepts any buffer, and notes that the depth buffer itself is suitable for
// short depth ranges only. Here the buffer is the logarithm of the distance along the view axis, so that 0.01 is one
// percent everywhere, or object ids. Weakness: borders across which neither changes: creases and coplanar borders.
#include "zoneplate/antialias/post/smaa/smaa.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

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
constexpr std::string_view modes[] = {"1x", "s2x", "t2x", "4x"};
constexpr std::string_view mixings[] = {"light", "codes"};
constexpr std::string_view predications[] = {"none", "depth", "objects"};
constexpr Param params[] = {
    {.name = "preset",
     .meaning = "edge threshold and search length, as in the original",
     .value = 2,
     .names = preset_names},
    {.name = "edges", .meaning = "values in which edges are detected", .value = 0, .names = edges_names},
    {.name = "mode",
     .meaning = "s2x: two samples per pixel, each filtered as an image of its own; t2x: two frames; 4x: both",
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

SmaaOptions options_of(const Settings& s, SmaaAreas areas) {
  SmaaOptions o;
  if (areas == SmaaAreas::Exact) o.exact_offset = float2{0, 0};
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
    Request request = display_referred_request(smaa_radius(options_));
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

/// A sample of a frame, and the areas under lines for its position (SmaaOptions::slots).
struct Subsample {
  SamplePosition position;
  std::array<int, 4> slots;
};

/// The samples of the frames of a mode, which repeat: by frame, then by sample; `samples` of them in each frame.
///
/// Source    SMAA.hlsl, table of @SUBSAMPLE_INDICES, whose y axis points upwards. The demo moves the geometry by its
///           jitter: its samples are at the opposite offset.
struct Subsamples {
  std::span<const Subsample> all;
  int samples;

  int frames() const { return static_cast<int>(all.size()) / samples; }
  std::span<const Subsample> of_frame(int index) const {
    return all.subspan(static_cast<std::size_t>(index % frames() * samples), static_cast<std::size_t>(samples));
  }
};
constexpr Subsample two[] = {{{192, 192}, {1, 1, 1, 0}}, {{64, 64}, {2, 2, 2, 0}}};
constexpr Subsample four[] = {
    {{224, 160}, {5, 3, 1, 3}}, {{96, 32}, {4, 6, 2, 3}}, {{160, 224}, {3, 5, 1, 4}}, {{32, 96}, {6, 4, 2, 4}}};

/// S2x, T2x and 4x: each sample gives a display-referred image, which is filtered separately, with the areas for the
/// sample's position. The images of a frame are averaged; where there are two frames, also with the last one.
///
/// The last frame enters as it was filtered, before it was itself averaged: a ghost lasts for one frame. Its weight
/// decreases with the difference of both frames' speeds at the pixel. Unlike in the original, the speed is that of the
/// pixel's own sample and is not blended along edges.
class SmaaSubsamples : public Resolver {
 public:
  SmaaSubsamples(const SmaaOptions& options, Subsamples subsamples) : options_(options), subsamples_(subsamples) {}
  bool has_history() const override { return subsamples_.frames() > 1; }
  Request request(const FrameContext& context) override {
    context_ = context;
    Request request = display_referred_request(smaa_radius(options_));
    request.samples.clear();
    for (const Subsample& s : subsamples_.of_frame(context.index)) request.samples.push_back(s.position);
    request.planes.samples = true;
    request.settling_frames = subsamples_.frames();
    if (!has_history()) return request;
    request.halo = Request::whole_image;
    request.planes.motion = true;
    return request;
  }
  DisplayImage post_process(DisplayImage, const Frame& frame) override {
    DisplayImage current = filtered(frame, 0);
    for (int s = 1; s < subsamples_.samples; ++s) {
      const DisplayImage other = filtered(frame, static_cast<std::size_t>(s));
      for_rows(current.height(), [&](int y) {
        for (int x = 0; x < current.width(); ++x)
          current(x, y) = mixed(current(x, y), other(x, y), 0.5f, mixing_of(options_));
      });
    }
    if (subsamples_.frames() == 1) return current;
    Plane<float> speed = packed_speed(frame.motion);
    if (lacks_speed_) last_speed_ = speed_before(frame.motion, speed);
    lacks_speed_ = context_.is_first;
    DisplayImage out = context_.is_first ? current : with_last(current, frame.motion, speed);
    last_ = std::move(current), last_speed_ = std::move(speed);
    return out;
  }

 private:
  DisplayImage filtered(const Frame& frame, std::size_t s) const {
    SmaaOptions options = options_;
    const Subsample& subsample = subsamples_.of_frame(context_.index)[s];
    options.slots = subsample.slots;
    if (options.exact_offset) options.exact_offset = offset_from_centre(subsample.position);
    return filter_encoded(make_display(frame.sample_color[s], frame.display), mixing_of(options),
                          [&](const Rgba8Image& i) { return apply_smaa(i, &frame.sample_depth[s], options); });
  }

  /// The square root of five times the speed in image sizes per frame, in 8 bits, as the original packs it.
  static Plane<float> packed_speed(const Plane<float2>& motion) {
    const auto width = static_cast<float>(motion.width()), height = static_cast<float>(motion.height());
    return changed(motion, [=](float2 m) {
      const float x = m.x / width, y = m.y / height;
      return std::floor(std::min(std::sqrt(5 * std::sqrt(x * x + y * y)), 1.0f) * 255 + 0.5f) / 255;
    });
  }

  /// The pixel, along one axis, from which a surface has moved.
  static int source(int at, float moved, int size) {
    const float place = std::floor(static_cast<float>(at) - moved + 0.5f);
    return static_cast<int>(std::clamp(place, 0.0f, static_cast<float>(size - 1)));
  }

  /// The speeds of a first frame, in which nothing has moved yet: those that its surfaces have in the next frame, also
  /// around them, where filtered outlines and the samples of another frame lie.
  static Plane<float> speed_before(const Plane<float2>& motion, const Plane<float>& speed) {
    const int width = speed.width(), height = speed.height();
    Plane<float> out(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const int from_x = source(x, motion(x, y).x, width), from_y = source(y, motion(x, y).y, height);
        for (int j = std::max(from_y - 1, 0); j <= std::min(from_y + 1, height - 1); ++j)
          for (int i = std::max(from_x - 1, 0); i <= std::min(from_x + 1, width - 1); ++i)
            out(i, j) = std::max(out(i, j), speed(x, y));
      }
    return out;
  }

  DisplayImage with_last(const DisplayImage& current, const Plane<float2>& motion, const Plane<float>& speed) const {
    constexpr float scale = 30;  // SMAA_REPROJECTION_WEIGHT_SCALE
    DisplayImage out(current.width(), current.height());
    for_rows(out.height(), [&](int y) {
      for (int x = 0; x < out.width(); ++x) {
        const int from_x = source(x, motion(x, y).x, out.width()), from_y = source(y, motion(x, y).y, out.height());
        const float now = speed(x, y), before = last_speed_(from_x, from_y);
        const float delta = std::abs(now * now - before * before) / 5;
        const float weight = 0.5f * std::clamp(1 - std::sqrt(delta) * scale, 0.0f, 1.0f);
        out(x, y) = mixed(current(x, y), last_(from_x, from_y), weight, mixing_of(options_));
      }
    });
    return out;
  }

  SmaaOptions options_;
  Subsamples subsamples_;
  FrameContext context_;
  DisplayImage last_;  ///< filtered, not averaged with the frame before it
  Plane<float> last_speed_;
  bool lacks_speed_ = false;  ///< the last frame was a first one
};

constexpr std::string_view variants[] = {"edges=color", "mode=s2x", "mode=t2x", "mode=4x", "predication=depth"};

}  // namespace

std::unique_ptr<Resolver> make_smaa(const Settings& s, SmaaAreas areas, const std::string& method) {
  const SmaaOptions options = options_of(s, areas);
  const auto predication = static_cast<Predication>(s.integer("predication"));
  if (options.is_predicated && (options.edges == SmaaOptions::Edges::Depth || s.chosen("mode") != "1x"))
    throw Error(ErrorKind::Usage, method + ": predication is for luma and color edges of mode=1x");
  if (!options.is_predicated && (s.is_given("pthreshold") || s.is_given("pscale") || s.is_given("pstrength")))
    throw Error(ErrorKind::Usage,
                method + ": pthreshold, pscale and pstrength are predication's: give predication=depth");
  if (s.chosen("mode") == "s2x") return std::make_unique<SmaaSubsamples>(options, Subsamples{two, 2});
  if (s.chosen("mode") == "t2x") return std::make_unique<SmaaSubsamples>(options, Subsamples{two, 1});
  if (s.chosen("mode") == "4x") return std::make_unique<SmaaSubsamples>(options, Subsamples{four, 2});
  return std::make_unique<Smaa>(options, predication);
}

Method smaa() {
  return {.name = "smaa",
          .summary = "edges followed to their ends, pixels blended by the area under the line through them",
          .source = "Jimenez 2012, SMAA 2.8",
          .params = params,
          .make = [](const Settings& s) { return make_smaa(s, SmaaAreas::Tables, "smaa"); },
          .variants = variants};
}

}  // namespace zoneplate::antialias
