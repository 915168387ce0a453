// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/formats/load.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/process/delivery.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate {

/// The files of a data set: those of Arm's neural-graphics-model-gym; or arrays of NumPy; or the same planes as EXR
/// images, which zoneplate filter reads.
enum class DatasetLayout { Nss, Npy, Exr };

/// Further planes of each frame, and of the ground truth's pixels.
struct DatasetPasses {
  bool ids = false;      ///< numbers of objects
  bool visible = false;  ///< whether the last frame's camera saw the surface
  bool count = false;    ///< the frames, this one included, in which the surface has been visible without a break
  bool any() const { return ids || visible || count; }
};

/// A sequence of training data: frames of fewer pixels with their depth and motion for each ratio, and the image that a
/// temporal upscaler is to make of them.
struct DatasetSequence {
  std::string folder;  ///< of the data set
  DatasetLayout layout = DatasetLayout::Nss;
  int number = 0;               ///< names its files: 0000.json
  std::string scene;            ///< a file or a built-in scene
  std::string reference;        ///< the method of the ground truth
  int2 size{1920, 1080};        ///< of the ground truth, pixels
  std::vector<double> ratios;   ///< with one decimal
  int frames = 60, rate = 30;   ///< frames per second
  int positions = 32;           ///< of the jitter: the Halton sequence (2, 3), rounded to 1/256 pixel
  double bias = 0;              ///< mip levels by which textures are blurrier than the ground truth's pixels require
  std::optional<double> start;  ///< seconds of the scene's animation; none: by the seed
  bool keeps_camera = false;    ///< the scene's own; otherwise a path by the seed, about its view
  DatasetPasses passes;         ///< none in the layout Nss
  std::uint32_t seed = 1;
  LoadOptions load = {};  ///< of the scene
  /// The studio of the default light; null: prepared where a scene needs it.
  decltype(LightingOptions::studio) studio = {};

  /// Width / height of all views: a frame of fewer pixels shows that of the ground truth.
  float aspect() const { return static_cast<float>(size.x) / static_cast<float>(size.y); }
  /// Where the pixels of a frame are sampled, and the offset of that from their centres, in pixels.
  SamplePosition sample(int frame) const {
    return halton_sequence(positions)[static_cast<std::size_t>(frame % positions)];
  }
  float2 jitter(int frame) const {
    const auto offset = [](std::uint8_t position) { return static_cast<float>(position) / 256 - 0.5f; };
    return {offset(sample(frame).x), offset(sample(frame).y)};
  }
};

/// The name of a ratio's folder: x2, x1_5.
std::string folder_of_ratio(double ratio);

/// All files of the sequence.
std::vector<std::string> dataset_paths(const DatasetSequence& sequence);

/// The sequence's JSON file, which is written after all other files: a sequence without it is incomplete.
std::string dataset_json_path(const DatasetSequence& sequence);

/// Renders a sequence and delivers its files. A complete sequence of the same settings is left as it is.
///
/// Exact     the same bytes for any number of threads, any instruction set and any order of the sequences.
/// Errors    ErrorKind::Output where a sequence with other settings has the number; those of the scene.
void make_dataset_sequence(const DatasetSequence& sequence, const std::function<void(int frame)>& progress,
                           Delivery& out);

}  // namespace zoneplate
