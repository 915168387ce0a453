// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/option/tone_args.h"

#include "zoneplate/job/option/values.h"
#include "zoneplate/math/elementary.h"

namespace zoneplate {

Option tone_mapping_option(std::optional<ToneMapping>& mapping, const std::string& otherwise,
                           const std::string& group) {
  return choice_option(
      "--tone-mapping", "CURVE",
      "Tone-mapping curve of images that are not linear: none, aces, neutral, agx or filmic; " + otherwise, group,
      false, {"none", "aces", "neutral", "agx", "filmic"}, [&mapping](std::size_t i) {
        constexpr ToneMapping curves[] = {ToneMapping::None, ToneMapping::Aces, ToneMapping::Neutral, ToneMapping::Agx,
                                          ToneMapping::Filmic};
        mapping = curves[i];
      });
}

std::optional<float> parse_exposure(const std::string& text) {
  if (text == "auto") return std::nullopt;
  return exp2(static_cast<float>(parse_number(text, -32, 32)));
}

}  // namespace zoneplate
