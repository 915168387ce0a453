// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/job/job.h"
#include "zoneplate/job/summary.h"
#include "zoneplate/render/renderer.h"

namespace zoneplate {

/// A data pass as a separate file: its index in Job::aovs, and its bytes.
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

/// The name of a file of the item. `frame` is its number, if the output has one; `layer` is the index of a data pass in
/// `job.aovs`, or -1 for the image.
std::string output_path(const Job& job, int frame, int layer);

/// What the method requires of the renderer for the first frame of the item.
Request request_of(const Job& job, Resolver& method);

/// Errors    ErrorKind::Failed if frame and image need more than the memory limit; ErrorKind::Usage if the method has
///           no effect on a file of linear values.
void check_request(const Job& job, const Request& request);

/// Errors    ErrorKind::Usage if the method does not support one of the data passes.
void check_passes(const Job& job, const Request& request);

/// Cuts a loaded scene at the sections of the job, and converts its materials to the shading model of the job.
void convert_materials(const Job& job, Scene& scene);

/// Changes the materials and the lighting of a loaded scene as the job says. The tone curve that goes with the light.
ToneMapping set_look(const Job& job, Scene& scene);

/// The settings of each frame of a resolved job. The extension of `output` determines the image format.
RenderSettings settings_of(const Job& job, const std::string& output);

/// Converts a rendered image of `scene` by `camera` to the formats of the output's extension, with its data passes. Its
/// counts, times and size are stored in `summary`. `frame` is its number in a sequence.
Rendered finish_picture(const Job& job, RenderedImage image, const Scene& scene, const Camera& camera,
                        const std::string& output, Summary& summary, std::optional<int> frame = {});

/// Encodes the image in the format of its name: PNG, JPEG, WebP, PFM, EXR or raw RGBA.
std::vector<std::uint8_t> encode_picture(const Rendered& picture, const std::string& output,
                                         const FileOptions& options = {});

/// True for the names of images of linear light: .exr and .pfm.
bool is_linear(const std::string& output);

/// The warning about an image of which a quarter of the surfaces or more is white and its light well above white; empty
/// for others, as for surfaces that are just white. `metered` returns metered_exposure of the image, and is called only
/// if so much of it is white.
std::string clipping(const Job& job, const Rgba8Image& image, const std::function<float()>& metered);

/// The warning about an image without visible surfaces, and why there are none; empty if there are any, and if a crop
/// may lie beside them.
std::string emptiness(const Job& job, const RenderCounts& counts, const Rendered& picture);

}  // namespace zoneplate
