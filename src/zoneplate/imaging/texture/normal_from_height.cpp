// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/texture/normal_from_height.h"

#include <fmt/format.h>
#include <algorithm>

#include "zoneplate/base/utf8.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/imaging/signal/load.h"
#include "zoneplate/imaging/signal/show.h"

namespace zoneplate {

void make_normal_map(const std::string& input, const NormalMapOptions& args, Delivery& out) {
  const Plane<float3> normals = normals_of(luminance(load_texture(input, args.layer, out)), args.heights);
  LinearImage encoded(normals.width(), normals.height());
  float steepest = 1;
  for (std::size_t i = 0; i < normals.values().size(); ++i) {
    const float3 n = normals.values()[i];
    encoded.values()[i] = {0.5f + 0.5f * n.x, 0.5f + 0.5f * n.y, 0.5f + 0.5f * n.z, 1};
    steepest = std::min(steepest, n.z);
  }
  if (args.output.ends_with(".pfm") || args.output.ends_with(".exr")) {
    save_result(
        args.output, encoded, [] { return Rgba8Image(); }, out);
  } else if (!args.output.empty()) {
    out.save(args.output, encode_png(shown(encoded, true), {.has_alpha = false, .is_srgb = false}));
  }
  print_result(args,
               fmt::format("{}, {} × {}: least z of a normal {:.3f}\n", printable(input), normals.width(),
                           normals.height(), steepest),
               {{"input", input},
                {"output", args.output},
                {"width", normals.width()},
                {"height", normals.height()},
                {"least_z", steepest}},
               out);
}

}  // namespace zoneplate
