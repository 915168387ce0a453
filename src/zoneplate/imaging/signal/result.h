// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/imaging/signal/load.h"
#include "zoneplate/process/delivery.h"
#include "zoneplate/report/json.h"

namespace zoneplate {

/// What the operations of `zoneplate signal`, `texture` and `sdf` have in common.
struct SignalOptions {
  std::string report = "zoneplate-signal";  ///< "format" of the JSON
  std::string output;                       ///< a file, "-" for stdout, or empty: numbers only
  std::string layer;                        ///< of an image that is an EXR
  bool prints_json = false;
  bool uses_codes = false;  ///< operates on display codes instead of linear light
  int threads = 0;
  ReadingLimits limits;
};

/// How the image of an operation with these options is loaded. A result of the same size as the image has the overscan
/// of an EXR too, where it is written to one.
SignalChoice signal_choice(const SignalOptions& args, bool keeps_size = false);

void save_picture(const std::string& path, const Rgba8Image& picture, Delivery& out, const ColorProfile& profile = {});

/// Writes a result: to .pfm and .exr the values as premultiplied floats, neither clamped nor shifted; to any other name
/// the display image `picture()`.
void save_result(const std::string& path, const LinearImage& values, const std::function<Rgba8Image()>& picture,
                 Delivery& out);

/// Writes a result with the profile of its input, as far as the format of the output states it: to .png codes of its
/// space, to .exr light of its chromaticities, else sRGB codes or light of Rec.709 primaries, with a warning; codes as
/// they are.
/// What is made of an EXR keeps in an EXR what else that file has (save_light), with a warning of what it lacks.
/// `picture`: the image of a .png, in sRGB, if it does not show the colours themselves.
void save_signal(const std::string& path, const Signal& values, Delivery& out,
                 const std::function<Rgba8Image()>& picture = {});

/// Prints the results to stdout, as text or as one line of JSON with "format" and "version" before the members of
/// `json`. Where the image is written to stdout, JSON goes to stderr instead and text is omitted.
void print_result(const SignalOptions& args, const std::string& text, const Json::Object& json, Delivery& out);

}  // namespace zoneplate
