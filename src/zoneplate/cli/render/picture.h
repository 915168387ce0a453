// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/cli/render/args.h"
#include "zoneplate/cli/render/summary.h"
#include "zoneplate/render/renderer.h"

namespace zoneplate::cli {

/// A data pass as a file of its own: its index in RenderArgs::aovs, and its bytes.
struct LayerFile {
  int aov = 0;
  std::vector<std::uint8_t> bytes;
};

/// An image, with the requested data passes.
struct Rendered {
  Rgba8Image image;
  Rgba16Image image16;  ///< instead of `image` for 16 bits
  LinearImage linear;   ///< where the output is a PFM or EXR: linear light over the background, before tone mapping
  std::vector<std::uint8_t> exr;  ///< the whole file, where the output is an EXR with data passes in it
  bool has_alpha = false;
  std::vector<LayerFile> layers;
};

/// The file of a data pass: "chair.png" and "depth" give "chair.depth.png", also for other image formats. For a PFM it
/// is a PFM, and for an EXR the image's own file.
std::string aov_path(const std::string& output, std::string_view name);

/// Fails at once, not after a long render, where one of the item's files can never be written.
///
/// Errors    ErrorKind::Output; ErrorKind::Usage for a terminal.
void check_outputs(const RenderArgs& args);

/// The name of a file of the item. `frame`: its number in a sequence, or -1; `layer`: the place of a data pass among
/// `args.aovs`, or -1 for the image.
std::string output_path(const RenderArgs& args, int frame, int layer);

/// Errors    ErrorKind::Failed where frame and image need more than the limit on memory; ErrorKind::Usage where the
///           method would leave no trace in a file of linear values.
void check_request(const RenderArgs& args, const Request& request);

/// Errors    ErrorKind::Usage where the method does not make one of the data passes.
void check_passes(const RenderArgs& args, const Request& request);

/// Gives the materials of a loaded scene the shading model of the arguments.
void convert_materials(const RenderArgs& args, Scene& scene);

/// Changes the materials and the lighting of a loaded scene according to the arguments.
void set_look(const RenderArgs& args, Scene& scene);

/// The settings of each frame from the arguments. The extension of `output` determines the image format.
RenderSettings settings_of(const RenderArgs& args, const std::string& output);

/// A rendered image of `scene` in the formats that the ending of `output` decides, with its data passes. Its counts,
/// times and size go into `summary`.
Rendered finish_picture(const RenderArgs& args, RenderedImage image, const Scene& scene, const std::string& output,
                        Summary& summary);

/// The image's bytes in the format of its name: PNG, JPEG, WebP, PFM, EXR or raw RGBA.
std::vector<std::uint8_t> encode_picture(const Rendered& picture, const std::string& output);

/// Warns about an image without anything visible.
std::string emptiness(const RenderArgs& args, const RenderCounts& counts);

}  // namespace zoneplate::cli
