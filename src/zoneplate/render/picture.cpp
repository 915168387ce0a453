#include "zoneplate/render/picture.h"

#include <optional>

#include "zoneplate/base/clock.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/shade/surface/material_plan.h"

namespace zoneplate {
namespace {

void add(RenderCounts& sum, const RenderCounts& c) {
  sum.prepare_ms += c.prepare_ms, sum.geometry_ms += c.geometry_ms, sum.tiles_ms += c.tiles_ms;
  sum.triangles = c.triangles, sum.triangles_set_up = c.triangles_set_up;
  sum.shaded += c.shaded, sum.geometric += c.geometric;
}

}  // namespace

Frame render_rounds(const Scene& scene, const Camera& camera, Resolver& resolver, const Request& request,
                    RenderOptions options, const DisplayOptions& display, RenderCounts* counts) {
  options.display = &display;
  RenderCounts sum;
  const Stopwatch preparing;
  std::optional<TextureSet> textures;
  std::optional<InterleavedVertices> records;
  RasterMemory memory;
  if (!options.textures) options.textures = &textures.emplace(scene, options.raw_colors);
  if (!options.records) options.records = &records.emplace(scene);
  if (!options.memory) options.memory = &memory;
  sum.prepare_ms = preparing.ms();
  const auto round = [&](const Request& wanted) {
    RenderCounts own;
    Frame frame = render(scene, camera, wanted, options, &own);
    frame.display = display;
    add(sum, own);
    return frame;
  };
  Frame frame = round(request);
  while (const std::optional<Request> more = resolver.refine(frame)) frame = round(*more);
  if (counts) *counts = sum;
  return frame;
}

Rgba8Image show(Resolver& resolver, Frame& frame, RenderCounts* counts) {
  if (!frame.shown.empty()) return std::move(frame.shown);
  Stopwatch watch;
  LinearImage linear = resolver.resolve(frame);
  const double resolve_ms = watch.lap_ms();
  DisplayImage display = make_display(std::move(linear), frame.display);
  const double display_ms = watch.lap_ms();
  display = resolver.post_process(std::move(display), frame);
  const double filter_ms = watch.lap_ms();
  Rgba8Image codes = quantize8(display);
  if (counts) {
    counts->resolve_ms = resolve_ms, counts->filter_ms = filter_ms;
    counts->display_ms = display_ms + watch.ms();
  }
  return codes;
}

Rgba8Image render_picture(const Scene& scene, const Camera& camera, Resolver& resolver, RenderOptions options,
                          const DisplayOptions& display, RenderCounts* counts) {
  const Request request = resolver.request(0);
  if (request.resolves_per_pixel) options.shown = &display;
  Frame frame = render_rounds(scene, camera, resolver, request, options, display, counts);
  return show(resolver, frame, counts);
}

}  // namespace zoneplate
