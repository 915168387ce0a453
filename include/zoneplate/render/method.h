// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "zoneplate/base/spec.h"
#include "zoneplate/raster/types/sampling.h"
#include "zoneplate/render/frame.h"
#include "zoneplate/scene/camera.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate {
struct CustomDraw;  // render/custom_draw.h
}  // namespace zoneplate

#pragma GCC visibility push(default)
namespace zoneplate {

/// How often a surface is shaded.
enum class Rate {
  Surface,  ///< once per pixel and triangle (multisampling)
  Sample,   ///< once per sample (supersampling)
};

/// The quantity that is evaluated at the samples of a frame.
enum class Content {
  Colour,         ///< radiance: materials and lights are evaluated, which is called shading
  Geometry,       ///< without shading: Frame::sample_geometry
  EdgeDistances,  ///< without shading: Frame::edge_distance, of requests with one sample
  Data,           ///< the planes of `planes` without any colour: materials are evaluated for normal, albedo and uv only
  Visibility,     ///< only the triangle of each sample: `planes.sample_triangles`, or with its depth: `samples`
};

/// A rectangle of the image.
struct Crop {
  int x = 0, y = 0, width = 0, height = 0;  ///< pixels; (x, y) is the top-left one of the crop
};

/// The size of a whole image, and the part of it that is made.
struct ImageExtent {
  int width = 0, height = 0;   ///< pixels of the whole image
  std::optional<Crop> crop{};  ///< none: all of it
};

/// The size of the frame that an upscaler renders for an image: each side divided by the scale, rounded down, at
/// least 1. A quotient that is whole but for the rounding of the division is whole: 1100 / 1.1 is 1000.
ImageExtent frame_size(const ImageExtent& image, double scale);

/// What a method requires of the renderer for one frame.
///
/// Tiles resolve the colour while it is in the cache: a mean of the samples, weighted by `weights`. Planes of samples
/// are stored only if the method requests them.
struct Request {
  SamplePattern samples = {SamplePosition{}};  ///< positions in every pixel; by default one, in the centre
  Content content = Content::Colour;           ///< other contents leave Frame::color and the data passes by pixel empty
  Rate rate = Rate::Surface;                   ///< how often surfaces are shaded
  std::vector<float> weights{};                ///< by sample; empty: all equal
  AlphaTest alpha = AlphaTest::Pixel;          ///< of alpha-tested surfaces at rate *surface*
  Centroid centroid = Centroid::Mean;          ///< where surfaces are shaded at rate *surface*
  Planes planes{};                             ///< the data that `resolve` and `post_process` read
  Plane<std::uint8_t> pixel_mask{};  ///< of the frame's size: only pixels that are not 0 here are drawn; empty: all
  /// The texture footprint of a fragment, in pixels of the frame: level of detail changes by its logarithm to base 2.
  /// 0: 1 / √(number of samples) at rate *sample*, 1 at rate *surface*.
  float footprint = 0;
  bool resolves_per_pixel = false;   ///< the mean is the result: `resolve` and `post_process` change nothing
  bool ends_in_light = false;        ///< what `resolve` returns is the image: `post_process` changes nothing
  bool is_display_referred = false;  ///< the method works after tone mapping: linear output does not contain it
  int halo = 0;  ///< pixels around a crop that `post_process` reads: a crop then has the bits of the whole image

  /// The frame's size and part if they are not those of the image: an upscaler renders fewer pixels than the image has.
  /// The camera sees the same view, and point and line widths are those of the image. `resolve` or `post_process` then
  /// returns an image of FrameContext::image; data passes of the settings are rendered separately, at the image's size.
  std::optional<ImageExtent> frame{};

  /// Draws the colour instead of the tiles; `samples` then apply to the data passes only. The function owns all data
  /// that it needs, since it may be called after the method is destroyed. Only methods of the library can use it:
  /// CustomDraw is not public.
  std::function<void(const CustomDraw&)> draw{};
  bool estimates_error = false;  ///< `draw` fills Frame::error

  /// The tiles map the colour to 8-bit display codes: Frame::display8 takes the place of Frame::color. Set by Renderer,
  /// where `resolves_per_pixel`.
  bool writes_display8 = false;
  /// The next frame's FrameContext::previous has the data planes of this frame.
  bool keeps_planes = false;
  /// How many frames of a still scene the method needs until its image has settled (Renderer::render_still). More than
  /// 1 only for methods with history (Resolver::has_history).
  int settling_frames = 1;

  /// A `halo` that contains the whole image, for methods with history: motion may bring any pixel into a crop.
  static constexpr int whole_image = 1 << 20;
};

/// A frame that another program has rendered, in place of the one that a method would request.
struct GivenFrame {
  int width = 0, height = 0;               ///< pixels
  std::optional<SamplePosition> sample{};  ///< where in its pixels it was sampled; none: where the method would sample
};

/// The position of a frame in its sequence, and the data of the frame before it.
struct FrameContext {
  ImageExtent image{};   ///< the image that the frame becomes, without the apron of Request::halo
  float aspect = 0;      ///< width / height of the camera's view, whatever the size of the frame; 0: that of `image`
  int index = 0;         ///< in its sequence, in the order of rendering
  bool is_first = true;  ///< the first frame of its sequence: the method drops all history
  /// The sub-pixel jitter for methods that distribute their samples over frames; others ignore it. It cycles through
  /// the "halton" pattern of 8 positions, whose mean is the pixel's centre.
  SamplePosition jitter{};
  /// The data planes of the previous frame if its request had `keeps_planes`; otherwise, and for the first frame, null.
  /// They are valid until the method has resolved and post-processed this frame.
  const Frame* previous = nullptr;
  Camera camera{};       ///< of this frame, without jitter
  Camera last_camera{};  ///< of the previous frame; for the first frame, `camera`
  /// The frame exists already: methods with history and temporal upscalers use its size and sample.
  std::optional<GivenFrame> given{};
};

/// Width / height of the camera's view of a frame.
inline float aspect_of(const FrameContext& c) {
  return c.aspect > 0 ? c.aspect : static_cast<float>(c.image.width) / static_cast<float>(c.image.height);
}

/// The state of an antialiasing method over sequences of frames. A method overrides the steps that it changes.
///
/// For each frame `request` is called at least once, always with the same context; then `refine`, `resolve` and
/// `post_process` in this order. A temporal method stores its history in its members, and drops it when `is_first`.
class Resolver {
 public:
  virtual ~Resolver() = default;
  /// True if an image depends on earlier frames of its sequence, whatever the frame: all frames since the last cut have
  /// to be rendered in order.
  virtual bool has_history() const { return false; }
  /// What to render for a frame; one shaded sample at each pixel's centre by default.
  virtual Request request(const FrameContext& /*context*/) { return {}; }
  /// Another pass to be rendered, chosen from the result of this one; the method may move data out of `frame`. Nothing
  /// if no pass is needed. `resolve` gets the frame of the last pass.
  virtual std::optional<Request> refine(Frame& /*frame*/) { return std::nullopt; }
  /// Makes the scene-linear image from the last frame, before tone mapping. By default it is Frame::color.
  virtual LinearImage resolve(Frame& frame) { return std::move(frame.color); }
  /// Filters the display-referred image, after tone mapping. By default it stays as it is.
  virtual DisplayImage post_process(DisplayImage image, const Frame& /*frame*/) { return image; }
};

/// An entry of a catalogue of methods: an array of Method, of the library (antialias::methods) or of a program.
///
/// Requires  the arrays and texts that the members refer to outlive every use of the entry.
struct Method {
  std::string_view name{};             ///< in lower case: "msaa" of `msaa:n=4`
  std::string_view summary{};          ///< one line for listings
  std::string_view source{};           ///< the publication or implementation that defines the method
  std::span<const Param> params = {};  ///< what may follow the name: n of `msaa:n=4`
  std::function<std::unique_ptr<Resolver>(const Settings&)> make{};  ///< makes a resolver from the values of `params`
  std::span<const std::string_view> variants = {};  ///< parameters that are compared in addition to the defaults: "n=8"
  bool is_reference = false;           ///< other methods are measured against it; not part of `compare --aa all`
  bool is_specification_only = false;  ///< tested against its publication only, for lack of another implementation
};

/// Makes the resolver of a text such as `msaa:n=4` from a catalogue.
///
/// Errors    ErrorKind::Usage naming an unknown method (and the closest one), parameter or value.
std::unique_ptr<Resolver> make_resolver(std::span<const Method> catalogue, std::string_view text);

}  // namespace zoneplate
#pragma GCC visibility pop
