#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "zoneplate/image/animation.h"

namespace zoneplate::cli {

/// The bytes of a film in the format of its name: APNG and WebP by writers of our own, GIF, MP4 and WebM by the program
/// ffmpeg.
///
/// Errors    Trouble::Failed with ffmpeg's complaint, or where it is not installed.
std::vector<std::uint8_t> encode_film(const Animation& film, const std::string& output);

}  // namespace zoneplate::cli
