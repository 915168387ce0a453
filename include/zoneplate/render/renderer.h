// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "zoneplate/render/backend.h"
#include "zoneplate/render/method.h"
#include "zoneplate/render/prepared_scene.h"

namespace zoneplate {
class SceneEdges;
}  // namespace zoneplate

#pragma GCC visibility push(default)
namespace zoneplate {

/// The format of a finished image.
enum class ImageForm {
  Display8,          ///< RenderedImage::display
  Display8Dithered,  ///< the same with ordered dithering (image/dither.h)
  Display16,         ///< RenderedImage::display16
  Linear,            ///< RenderedImage::linear
};

/// The settings of a frame: options, data passes and output format.
struct RenderSettings {
  RenderOptions options{};               ///< size, crop, display transform and the rules of rasterization
  Planes planes{};                       ///< data passes; not `samples` or `sample_colors`
  ImageForm form = ImageForm::Display8;  ///< which image of RenderedImage is made
};

/// A finished image with its data passes, all of the size of the crop or, without one, of the image.
struct RenderedImage {
  Rgba8Image display{};     ///< display-referred, straight alpha
  Rgba16Image display16{};  ///< the same with 16 bits
  LinearImage linear{};     ///< before exposure, tone mapping and background: premultiplied, in scene units
  Frame data{};             ///< the planes of the settings; its colours are empty
  RenderCounts counts{};    ///< the sums over all rounds of the method
};

/// A prepared scene and its camera at one moment.
struct SceneView {
  PreparedScene scene;  ///< with its lights
  Camera camera{};      ///< its pose at the same moment
};

/// Renders frames of a scene by an antialiasing method: all rounds of the method, data passes, motion, and the apron
/// around a crop that the method reads.
///
/// The renderer owns the state that frames share: the backend with its memory, the index of the frame in its sequence,
/// the method's history and the planes of the last frame.
class Renderer {
 public:
  /// A renderer of one scene by one method, at the beginning of a sequence.
  Renderer(PreparedScene scene, std::unique_ptr<Resolver> method,
           std::unique_ptr<Backend> backend = make_cpu_backend());
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// The same scene at another moment, for the frames that follow.
  void set_scene(PreparedScene scene);
  /// The scene that was set last, by the constructor or set_scene.
  const PreparedScene& scene() const { return scene_; }

  /// Begins a new sequence with the next frame, after a cut: the frame counter is 0 and there is no last frame. A frame
  /// of another size or crop than the last one begins a new sequence too.
  void begin_sequence() { index_ = 0; }

  /// Renders the next frame of the sequence.
  ///
  /// Motion is measured from the last frame of the sequence, unless `settings.options.last` is set.
  /// Exact     the same bits for any number of threads and any instruction set; a crop has the bits of the whole image.
  /// Errors    ErrorKind::Usage for a size, crop, or data pass that cannot be rendered.
  RenderedImage render(const Camera& camera, const RenderSettings& settings);

  /// Renders a still image: as many frames of the same scene and camera as the method needs to settle
  /// (Request::settling_frames), as a sequence of its own. Returns the last of them, with the sum of all counts.
  RenderedImage render_still(const Camera& camera, const RenderSettings& settings);
  /// The number of frames of the last still image: more than 1 by a method with history.
  int still_frames() const { return settling_frames_; }

  /// Renders the next frame with motion blur: the mean of `count` moments in linear light. `moment(i)` is called once
  /// for each, in order. Requires: no data passes in `settings.planes`.
  ///
  /// Exact     the sum is made in order and divided once.
  /// Errors    ErrorKind::Usage for a method with history (Resolver::has_history).
  RenderedImage render_mean(int count, const std::function<SceneView(int)>& moment, const RenderSettings& settings);

  /// Returns an image to the renderer, which reuses its memory for the next frame of the same size.
  void recycle(Rgba8Image image);

 private:
  /// Renders the frame that a lens with distortion sees by `frame`, and warps the image and its data.
  RenderedImage through_lens(const Lens& lens, const RenderSettings& settings,
                             const std::function<RenderedImage(const Lens&, const RenderSettings&)>& frame);
  Camera seeing_ground(const Camera& camera, const RenderOptions& options) const;
  void begin_frame(const Camera& camera, const RenderSettings& settings);
  Request request_for(const RenderSettings& settings);
  RenderOptions frame_options(const RenderSettings& settings, const Request& request) const;
  /// The frame of the method's last round, and the data planes of the first round.
  struct Rounds {
    Frame frame;
    std::optional<Frame> data;  ///< none: there was one round, and its data planes are in `frame`
    Frame take_data();
  };
  Rounds render_rounds(const Camera& camera, const Request& request, const RenderOptions& options,
                       RenderCounts& counts);
  /// What lines along edges cover of the image that the method makes of the request; empty without lines.
  Plane<float> edge_coverage(const Camera& camera, const RenderSettings& settings, const Request& request);
  void finish(LinearImage picture, const Frame& frame, const Request& request, const RenderSettings& settings,
              const Plane<float>& edges, RenderedImage& out);
  void draw_behind(const Camera& camera, const RenderOptions& options, LinearImage& color) const;
  Frame render_data(const Camera& camera, const Request& request, const RenderSettings& settings, RenderCounts& counts);
  void render_light(const Camera& camera, const RenderSettings& settings, RenderCounts& counts, Frame& data);
  void end_frame(const Camera& camera, bool keeps_moment, const Request& request, bool are_planes_requested,
                 Frame& data);

  PreparedScene scene_;
  std::unique_ptr<Resolver> method_;
  std::unique_ptr<Backend> backend_;
  std::unique_ptr<SceneEdges> edges_;
  SamplePattern jitter_;
  int index_ = 0;
  FrameContext context_;  ///< of the frame that is being rendered

  // Of the last frame.
  int width_ = 0, height_ = 0;
  std::optional<Crop> crop_;
  std::optional<Moment> moment_;
  Camera camera_;
  int settling_frames_ = 1;
  std::optional<Frame> previous_;
  LinearImage memory_;  ///< the resolved image of a method with history, for the next frame's
};

/// The rectangle that is rendered for a crop: `halo` pixels larger on each side, within the image.
std::optional<Crop> padded_crop(const RenderOptions& options, int halo);

}  // namespace zoneplate
#pragma GCC visibility pop
