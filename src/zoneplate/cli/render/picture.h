// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/cli/render/args.h"
#include "zoneplate/cli/render/summary.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/render/renderer.h"

namespace zoneplate::cli {

/// A data pass as a separate file: its index in RenderArgs::aovs, and its bytes.
struct LayerFile {
  int aov = 0;
  std::vector<std::uint8_t> bytes;
};

/// An image, with the requested data passes.
struct Rendered {
  Rgba8Image image;
  Rgba16Image image16;            ///< used instead of `image` for 16 bits
  LinearImage linear;             ///< for PFM and EXR output: linear light over the background, before tone mapping
  std::vector<std::uint8_t> exr;  ///< for EXR output with data passes: the whole file
  ExrAttributes attributes;       ///< for EXR output without data passes
  bool has_alpha = false;
  std::vector<LayerFile> layers;
};

/// The file of a data pass: "chair.png" and "depth" give "chair.depth.png", also for other image formats. For a PFM it
/// is a PFM; for an EXR it is the image's own file.
std::string aov_path(const std::string& output, std::string_view name);

/// Fails early, and not after a long rendering, if one of the item's files cannot be written.
///
/// Errors    ErrorKind::Output; ErrorKind::Usage for a terminal.
void check_outputs(const RenderArgs& args);

/// The name of a file of the item. `frame` is its number, if the output has one; `layer` is the index of a data pass in
/// `args.aovs`, or -1 for the image.
std::string output_path(const RenderArgs& args, int frame, int layer);

/// What the method requires of the renderer for the first frame of the item.
Request request_of(const RenderArgs& args, Resolver& method);

/// Errors    ErrorKind::Failed if frame and image need more than the memory limit; ErrorKind::Usage if the method has
///           no effect on a file of linear values.
void check_request(const RenderArgs& args, const Request& request);

/// Errors    ErrorKind::Usage if the method does not support one of the data passes.
void check_passes(const RenderArgs& args, const Request& request);

/// Cuts a loaded scene at the sections of the arguments, and converts its materials to their shading model.
void convert_materials(const RenderArgs& args, Scene& scene);

/// Sets those of `args.options` that the user leaves to the scene: `point_size` and `anisotropy`.
void set_usual_options(RenderArgs& args, const Scene& scene);

/// Sets these options and the view's up axis, and chooses the camera of a picture: a built-in scene's own if it has
/// one.
Camera choose_own_camera(RenderArgs& args, const Scene& scene);

/// Changes the materials and the lighting of a loaded scene according to the arguments. The tone curve for it.
ToneMapping set_look(const RenderArgs& args, Scene& scene);

/// The settings of each frame from the arguments. The extension of `output` determines the image format.
RenderSettings settings_of(const RenderArgs& args, const std::string& output);

/// The exposure of --exposure auto: auto_exposure (image/auto_exposure.h) of an image of at most 256 pixels a side,
/// with one sample per pixel, of the whole view.
float metered_exposure(const PreparedScene& scene, const Camera& camera, const RenderArgs& args);

/// Sets `args.light_dimming`: where the lights of a file would clip a quarter of the surfaces or more to white, the
/// factor that brings them to the brightness of --exposure auto; 1 for others, where options choose the lights or the
/// brightness, and for linear images. Returns the warning about it; empty for a factor of 1.
std::string set_light_dimming(RenderArgs& args, const PreparedScene& scene, const std::string& output);

/// Converts a rendered image of `scene` by `camera` to the formats of the output's extension, with its data passes. Its
/// counts, times and size are stored in `summary`. `frame` is its number in a sequence.
Rendered finish_picture(const RenderArgs& args, RenderedImage image, const Scene& scene, const Camera& camera,
                        const std::string& output, Summary& summary, std::optional<int> frame = {});

/// Encodes the image in the format of its name: PNG, JPEG, WebP, PFM, EXR or raw RGBA.
std::vector<std::uint8_t> encode_picture(const Rendered& picture, const std::string& output,
                                         const FileOptions& options = {});

/// The warning about an image of which a quarter of the surfaces or more is white and its light well above white; empty
/// for others, as for surfaces that are just white. `metered` returns metered_exposure of the image, and is called only
/// if so much of it is white.
std::string clipping(const RenderArgs& args, const Rendered& picture, const std::function<float()>& metered);

/// The warning about an image without visible surfaces, and why there are none; empty if there are any, and if a crop
/// may lie beside them.
std::string emptiness(const RenderArgs& args, const RenderCounts& counts, const Rendered& picture);

}  // namespace zoneplate::cli
