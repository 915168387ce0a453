// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/process/delivery.h"

namespace zoneplate {

/// A view of a model in the light of an image.
struct Scenario {
  std::string name, model, environment;
  float theta = 0, phi = 90, radius = 1;  ///< of the camera about the target, in degrees; phi from the up axis
  float3 target{0, 0, 0};
  float view_angle = 45;
  bool has_background = false;
  int2 size{0, 0};  ///< of the peers' images
};

/// Reads the list of scenarios of a file, a JSON array or the member "scenarios" of an object, in a confined process.
/// The result of the work is that list, packed.
///
/// Errors    ErrorKind::Input naming the file and the scenario.
void read_scenarios(const std::string& file, Delivery& out);
std::vector<Scenario> unpack_scenarios(std::span<const std::uint8_t> bytes);

/// Finds the size of an image as it is shown, from the header if it states that; unpack_size has the result.
void read_shown_size(const std::string& image, Delivery& out);
int2 unpack_size(std::span<const std::uint8_t> bytes);

/// How a rendered image compares with those of the peers, and they with each other.
struct FidelityVerdict {
  std::string nearest;
  double decibels = 0, median = 0, bound = 0, overlap = 0;
  bool is_good() const { return decibels <= bound && overlap >= min_overlap; }
  static constexpr double min_overlap = 0.995, always_good = -24, margin = 2;
};

/// Compares the image `output` with those of the peers, by their names; unpack_verdict has the result.
void judge_fidelity(const std::string& output, const std::map<std::string, std::string>& peers, Delivery& out);
FidelityVerdict unpack_verdict(std::span<const std::uint8_t> bytes);

}  // namespace zoneplate
