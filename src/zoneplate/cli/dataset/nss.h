// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "zoneplate/cli/process/confined.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/report/json.h"

namespace zoneplate::cli {

/// A sequence of training data in the layout of Arm's neural-graphics-model-gym: frames of fewer pixels with their
/// depth and motion for each ratio, and the image that a temporal upscaler is to make of them.
///
/// Source    docs/nss/nss_dataset_specification.md there, version 1.0.1.
struct NssSequence {
  std::string folder;          ///< of the data set
  int number = 0;              ///< names its files: 0000.json
  std::string scene;           ///< a file or a built-in scene
  std::string reference;       ///< the method of the ground truth
  int2 size{1920, 1080};       ///< of the ground truth, pixels
  std::vector<double> ratios;  ///< with one decimal
  int frames = 60, rate = 30;  ///< frames per second
  int positions = 32;          ///< of the jitter: the Halton sequence (2, 3), rounded to 1/256 pixel
  std::uint32_t seed = 1;
  LoadOptions load = {};  ///< of the scene
};

/// The name of a ratio's folder: x2, x1_5.
std::string nss_folder_of(double ratio);

/// All files of the sequence.
std::vector<std::string> nss_paths(const NssSequence& sequence);

/// The sequence's JSON file, which is written after all of its images: a sequence without it is incomplete.
std::string nss_json_path(const NssSequence& sequence);

/// Renders a sequence and delivers its files. A complete sequence of the same settings is left as it is.
///
/// Exact     the same bytes for any number of threads, any instruction set and any order of the sequences.
/// Errors    ErrorKind::Output where a sequence with other settings has the number; those of the scene.
void make_nss_sequence(const NssSequence& sequence, const std::function<void(int frame)>& progress, Delivery& out);

}  // namespace zoneplate::cli
