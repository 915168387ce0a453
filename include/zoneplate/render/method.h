#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "zoneplate/base/api.h"
#include "zoneplate/base/spec.h"
#include "zoneplate/raster/types/sampling.h"
#include "zoneplate/render/frame.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate {
struct CustomDraw;  // render/custom_draw.h
}  // namespace zoneplate

namespace ZONEPLATE_API zoneplate {

/// How often a surface is shaded.
enum class Rate {
  Surface,  ///< once per pixel and triangle (multisampling)
  Sample,   ///< once per sample (supersampling)
};

/// What is evaluated at the samples of a frame.
enum class Content {
  Colour,         ///< light: materials and lamps are evaluated, which is called shading
  Geometry,       ///< without shading: Frame::sample_geometry
  EdgeDistances,  ///< without shading: Frame::edge_distance, of requests with one sample
  Data,           ///< the planes of `planes` without any colour: materials are evaluated for normal, albedo and uv only
  Visibility,     ///< which triangle owns each sample, alone: `planes.sample_triangles`, or with its depth: `samples`
};

/// What a method wants of the renderer for one frame.
///
/// The tile resolves colour while it is in cache: the mean of the samples with `weights`. A method that needs more than
/// the pixel asks for planes, and only then are they stored.
struct Request {
  SamplePattern samples = {SamplePosition{}};  ///< positions in every pixel; by default one, in the centre
  Content content = Content::Colour;   ///< without colour, Frame::color and the data passes of a pixel stay empty
  Rate rate = Rate::Surface;           ///< how often surfaces are shaded
  std::vector<float> weights;          ///< one a sample; empty: all equal
  AlphaTest alpha = AlphaTest::Pixel;  ///< of masked surfaces at rate *surface*
  Centroid centroid = Centroid::Mean;  ///< where surfaces are shaded at rate *surface*
  Planes planes;                       ///< the data that `resolve` and `post_process` read
  Plane<std::uint8_t> pixel_mask;      ///< the frame's size: only pixels that are not 0 here are drawn; empty: all
  float footprint = 0;                 ///< of a sample at rate *sample*, in pixels; 0: 1 / √(number of samples)
  bool resolves_per_pixel = false;  ///< the mean is the method's last word: `resolve` and `post_process` change nothing
  bool is_display_referred = false;  ///< on the picture after tone mapping: what is written as light would not have it
  int halo =
      0;  ///< pixels beyond a picture's sides that `post_process` would read, so that a crop has the whole's bits

  /// Draws the colour in the method's own way, in place of the tiles' mean; `samples` then serve the data passes alone.
  /// It holds what it needs: the method itself may be gone when it is called.
  std::function<void(const CustomDraw&)> draw;
  bool estimates_error = false;  ///< `draw` fills Frame::error

  /// The tiles map the colour to 8-bit display codes: Frame::shown takes the place of Frame::color. Set by Renderer,
  /// where `resolves_per_pixel`.
  bool is_presented = false;
  /// The next frame's FrameContext::previous has the data planes of this frame.
  bool keeps_planes = false;
};

/// Which frame of a sequence a method is to make, and what is left of the one before it.
struct FrameContext {
  int index = 0;         ///< in its sequence; frames are counted as they are rendered
  bool is_first = true;  ///< of its sequence: the method drops all history
  /// A sample position for methods that spread their samples over frames; others ignore it. The first 8 elements of
  /// the Halton sequence of bases 2 and 3, over and over, rounded to 1/256 pixel.
  /// Source    Karis, High Quality Temporal Supersampling, SIGGRAPH 2014 course.
  SamplePosition jitter;
  /// The data planes of the frame before, where its request had `keeps_planes`; else, and of the first frame, null.
  /// They stay until the method has resolved and post-processed this frame.
  const Frame* previous = nullptr;
};

/// An antialiasing method at work on sequences of frames. Override what the method changes.
///
/// For each frame it gets one call of `request` or more, each with the same context; then `refine`, `resolve` and
/// `post_process` in this order. A method with a history keeps it in its members, and drops it when `is_first`.
class Resolver {
 public:
  virtual ~Resolver() = default;
  /// What to render for a frame; one shaded sample at each pixel's centre by default.
  virtual Request request(const FrameContext& /*context*/) { return {}; }
  /// What to render more after a look at this frame, from which the method takes what it keeps; nothing when it has
  /// seen enough. `resolve` gets the last frame.
  virtual std::optional<Request> refine(Frame& /*frame*/) { return std::nullopt; }
  /// Makes the scene-linear image from the last frame, before tone mapping. By default it is Frame::color.
  virtual LinearImage resolve(Frame& frame) { return std::move(frame.color); }
  /// Filters the display-referred image, after tone mapping. By default it stays as it is.
  virtual DisplayImage post_process(DisplayImage image, const Frame& /*frame*/) { return image; }
};

/// A row of the catalogue; each method's file makes its own.
struct Method {
  std::string_view name;               ///< in lower case: "msaa" of `msaa:n=4`
  std::string_view summary;            ///< one line for listings
  std::string_view source;             ///< the publication or implementation that defines the method
  std::span<const Param> params = {};  ///< what may follow the name: n of `msaa:n=4`
  std::function<std::unique_ptr<Resolver>(const Settings&)> make;  ///< makes a resolver from the values of `params`
  std::span<const std::string_view> variants = {};  ///< parameters worth comparing beside the defaults: "n=8"
  bool is_reference = false;                        ///< what others are measured against: not one of `compare --aa all`
  bool is_specification_only = false;  ///< held to its text alone: there was no other implementation to compare with
};

/// Makes the resolver of a text such as `msaa:n=4` from a catalogue.
///
/// Errors    ErrorKind::Usage naming an unknown method (and the closest one), parameter or value.
std::unique_ptr<Resolver> make_resolver(std::span<const Method> catalogue, std::string_view text);

}  // namespace zoneplate
