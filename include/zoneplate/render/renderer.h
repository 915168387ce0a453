#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "zoneplate/base/api.h"
#include "zoneplate/render/backend.h"
#include "zoneplate/render/method.h"
#include "zoneplate/render/prepared_scene.h"

namespace ZONEPLATE_API zoneplate {

/// The form of a finished picture.
enum class ImageForm {
  Display8,          ///< RenderedImage::display
  Display8Dithered,  ///< the same, rounded by a pattern of thresholds (image/dither.h)
  Display16,         ///< RenderedImage::display16
  Linear,            ///< RenderedImage::linear
};

/// What is rendered of each frame.
struct RenderSettings {
  RenderOptions options;                 ///< size, crop, display transform and the rules of rasterization
  Planes planes;                         ///< data passes; not `samples` or `sample_colors`
  ImageForm form = ImageForm::Display8;  ///< which image of RenderedImage is made
};

/// A finished picture with its data passes, all of the size of the crop, or else of the picture.
struct RenderedImage {
  Rgba8Image display;     ///< display-referred codes, straight alpha
  Rgba16Image display16;  ///< the same with 16 bits
  LinearImage linear;     ///< before exposure, tone mapping and background: premultiplied, in scene units
  Frame data;             ///< the planes of the settings; its colours are empty
  RenderCounts counts;    ///< of all the rounds of the method together
};

/// A scene and the camera that sees it, at one moment.
struct SceneView {
  PreparedScene scene;  ///< with its lights
  Camera camera;        ///< its pose at the same moment
};

/// Renders frames of a scene by an antialiasing method: all of the method's rounds, data passes, motion, and as much
/// around a crop as the method reads.
///
/// It owns what frames share: the backend with its memory, the index of the frame in its sequence, and what the method
/// and the renderer keep of the last frame.
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
  /// The scene of the last frame, or of the next one where it was set since.
  const PreparedScene& scene() const { return scene_; }

  /// Begins a new sequence with the next frame, after a cut: the frame counter is 0 and there is no last frame. A frame
  /// of another size or crop than the last one begins a new sequence too.
  void begin_sequence() { index_ = 0; }

  /// Renders the next frame of the sequence.
  ///
  /// Motion is counted from the last frame of the sequence, unless `settings.options.last` is given.
  /// Exact     the same bits for any number of threads and any instruction set; a crop has the bits of the whole picture.
  /// Errors    ErrorKind::Usage for a size, crop, or data pass that cannot be rendered.
  RenderedImage render(const Camera& camera, const RenderSettings& settings);

  /// Renders the next frame as the mean in linear light of `count` moments, as an open shutter sees what moves.
  /// `moment(i)` is called once for each, in order. There are no data passes: `settings.planes` is empty.
  ///
  /// Exact     the sum is made in order and divided once.
  RenderedImage render_mean(int count, const std::function<SceneView(int)>& moment, const RenderSettings& settings);

  /// Gives a picture back for the next frame of its size, which is written into its memory.
  void recycle(Rgba8Image image);

 private:
  void begin_frame(const RenderSettings& settings);
  Request request_for(const RenderSettings& settings);
  /// The frame of the method's last round; `data`: the data planes of the first round.
  struct Rounds {
    Frame frame;
    std::optional<Frame> data;  ///< none: the first round was the last, and its data planes are in `frame`
    Frame take_data();
  };
  Rounds render_rounds(const Camera& camera, const Request& request, const RenderOptions& options,
                       RenderCounts& counts);
  void finish(LinearImage picture, const Frame& frame, ImageForm form, RenderedImage& out);
  void end_frame(const Camera& camera, const Request& request, bool are_planes_wanted, Frame& data);

  PreparedScene scene_;
  std::unique_ptr<Resolver> method_;
  std::unique_ptr<Backend> backend_;
  SamplePattern jitter_;
  int index_ = 0;
  FrameContext context_;  ///< of the frame that is being rendered

  // Of the last frame.
  int width_ = 0, height_ = 0;
  std::optional<Crop> crop_;
  std::optional<Moment> moment_;
  std::optional<Frame> previous_;
};

/// The rectangle that is rendered for a crop: with `halo` pixels more on each side, within the picture.
std::optional<Crop> padded_crop(const RenderOptions& options, int halo);

}  // namespace zoneplate
