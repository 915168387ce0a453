// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/stream/streamed_backend.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/geometry/clip.h"
#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/render/draw_list.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/shade/surface/layered_plan.h"

namespace zoneplate {
namespace {

constexpr std::size_t max_samples = 64;  ///< that are rasterized together
constexpr double share_of_search = 0.8;  ///< of the time of a frame
constexpr int rows_of_strip = 8;

using Triangles = std::vector<std::uint32_t>;  ///< in ascending order

/// Shades nothing: only the visibility of opaque triangles is stored.
class NoShader : public FragmentShader {
 public:
  void shade(const FragmentBatch&, OutputMask, FragmentOutputs&) const override {}
  float alpha(const FragmentBatch&, float*) const override { return 1; }
};

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorKind::Usage, what + " the whole scene in memory");
}

void sort_unique(Triangles& triangles) {
  std::ranges::sort(triangles);
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
}

/// The opaque triangles that samples of a part of the image own.
struct Owners {
  std::vector<Plane<std::uint32_t>> ids;  ///< by sample
  std::vector<Plane<float>> depths;       ///< likewise
};

/// Step 1.
Owners find_owners(const TriangleStream& stream, std::size_t part, const SceneDraws& whole, const Request& request,
                   const RenderOptions& options, const Crop& crop) {
  Owners out;
  out.ids.assign(request.samples.size(), Plane<std::uint32_t>(crop.width, crop.height, Target::no_id));
  out.depths.assign(request.samples.size(), Plane<float>(crop.width, crop.height, 0.0f));
  Target target;
  target.viewport = {options.width, options.height};
  target.x = crop.x, target.y = crop.y, target.width = crop.width, target.height = crop.height;
  target.samples = request.samples;
  target.sample_triangle = &out.ids, target.sample_depth = &out.depths;
  target.keeps_nearer = true;
  const RasterRules rules{
      .edge_rule = options.edge_rule, .visibility = options.visibility, .capacity = options.capacity};

  const std::vector<StreamInstance> instances = stream.instances();
  std::vector<Draw> draws;
  part = std::min(part, stream.count());
  std::vector<float3> corners(3 * part);
  std::vector<std::uint32_t> index(3 * part);
  std::iota(index.begin(), index.end(), 0u);
  RasterMemory memory;
  constexpr std::size_t grain = 1 << 12;
  for (std::size_t first = 0; first < stream.count(); first += part) {
    const std::size_t count = std::min(part, stream.count() - first);
    parallel_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
      stream.read(first + begin, end - begin, &corners[3 * begin]);
    });
    stream.forget();
    stream.read_ahead(first + count, std::min(part, stream.count() - first - count));
    // The triangles before a part have ids, but are not drawn again.
    draws.assign(1, Draw{});
    draws.front().elsewhere = static_cast<std::uint32_t>(first);
    for_each_instance(instances, first, first + count, [&](std::size_t i, std::size_t begin, std::size_t end) {
      Draw& draw = draws.emplace_back(whole.draws[i]);
      if (draw.alpha_mode != AlphaMode::Opaque) {
        draw = Draw{};
        draw.elsewhere = static_cast<std::uint32_t>(end - begin);
        return;
      }
      draw.position = std::span(corners).subspan(3 * (begin - first), 3 * (end - begin));
      draw.index = std::span(index).first(3 * (end - begin));
    });
    rasterize(draws, NoShader(), rules, target, &memory);
    if (options.progress)
      options.progress(share_of_search * static_cast<double>(first + count) / static_cast<double>(stream.count()));
  }
  return out;
}

/// Of blocks of pixels, the depth of the farthest opaque sample; 0 where a sample has none.
class FarthestDepths {
 public:
  static constexpr int side = rows_of_strip;

  FarthestDepths(const std::vector<Plane<float>>& depths, int width, int height)
      : blocks_((width + side - 1) / side, (height + side - 1) / side) {
    parallel_for(static_cast<std::size_t>(blocks_.height()), [&](std::size_t row) {
      const int top = static_cast<int>(row) * side;
      for (int b = 0; b < blocks_.width(); ++b) {
        float farthest = depths.front()(b * side, top);
        for (const Plane<float>& plane : depths)
          for (int y = top; y < std::min(top + side, height); ++y)
            for (int x = b * side; x < std::min((b + 1) * side, width); ++x) farthest = std::min(farthest, plane(x, y));
        blocks_(b, static_cast<int>(row)) = farthest;
      }
    });
  }
  /// Whether a sample of a row of blocks, in the pixels [left, right], may be behind `depth`.
  bool has_behind(int row, int left, int right, float depth) const {
    const auto of_row = blocks_.row(row).subspan(static_cast<std::size_t>(left / side),
                                                 static_cast<std::size_t>(right / side - left / side + 1));
    return std::ranges::any_of(of_row, [&](float farthest) { return farthest <= depth; });
  }

 private:
  Plane<float> blocks_;
};

/// The pixels and the nearest depth of a triangle on the screen.
struct Reach {
  std::int32_t low_x = std::numeric_limits<std::int32_t>::max(), high_x = std::numeric_limits<std::int32_t>::min();
  std::int32_t low_y = low_x, high_y = high_x;
  float depth = 0;

  void add(const ScreenVertex& v) {
    low_x = std::min(low_x, v.x), high_x = std::max(high_x, v.x);
    low_y = std::min(low_y, v.y), high_y = std::max(high_y, v.y);
    depth = std::max(depth, v.z);
  }
};

Reach reach_of(const Draw& draw, const float3* corners, Viewport viewport) {
  Reach out;
  float4 clip[3];
  ScreenVertex screen[3];
  for (int k = 0; k < 3; ++k) {
    clip[k] = draw.clip_from_object * float4{corners[k].x, corners[k].y, corners[k].z, 1};
    screen[k] = project(clip[k], viewport);
  }
  if (std::ranges::any_of(screen, &ScreenVertex::needs_clipping)) {
    const ClippedPolygon polygon = clip_triangle(clip[0], clip[1], clip[2], viewport);
    for (int k = 0; k < polygon.count; ++k) out.add(polygon.vertex[static_cast<std::size_t>(k)]);
  } else {
    for (const ScreenVertex& v : screen) out.add(v);
  }
  // More than the rounding of depths that are interpolated.
  out.depth = out.depth * 1.0001f + 1e-6f;
  return out;
}

/// Step 2, by strip: the alpha-tested and blended triangles that may be before an opaque sample. Some are not.
std::vector<Triangles> find_others(const TriangleStream& stream, const SceneDraws& whole, const Owners& owners,
                                   const RenderOptions& options, const Crop& crop) {
  const auto strips = static_cast<std::size_t>((crop.height + rows_of_strip - 1) / rows_of_strip);
  if (std::ranges::all_of(whole.draws, [](const Draw& draw) { return draw.alpha_mode == AlphaMode::Opaque; }))
    return std::vector<Triangles>(strips);
  const FarthestDepths depths(owners.depths, crop.width, crop.height);
  const std::vector<StreamInstance> instances = stream.instances();
  const Viewport viewport{options.width, options.height};
  PerThread<std::vector<Triangles>> found;
  PerThread<std::vector<float3>> corners;
  constexpr std::size_t grain = 1 << 12, step = 64 * grain;  // after which the system may reclaim what was read
  std::size_t begin = 0;
  for (std::size_t i = 0; i < instances.size(); begin = instances[i++].end) {
    const Draw& draw = whole.draws[i];
    if (draw.alpha_mode == AlphaMode::Opaque) continue;
    for (std::size_t first = begin; first < instances[i].end; first += step) {
      parallel_ranges(std::min(step, instances[i].end - first), grain, [&](std::size_t from, std::size_t to) {
        std::vector<float3>& own = corners.local();
        own.resize(3 * (to - from));
        stream.read(first + from, to - from, own.data());
        std::vector<Triangles>& of_strips = found.local(strips);
        for (std::size_t t = from; t < to; ++t) {
          const Reach reach = reach_of(draw, &own[3 * (t - from)], viewport);
          if (reach.low_x > reach.high_x) continue;  // it is clipped away
          // In pixels of the crop, and a pixel wider on each side, since samples may lie on the border of a pixel.
          const auto pixel = [](std::int32_t at, int size, int before) { return ((at + 128 * size) >> 8) - before; };
          const int left = std::max(pixel(reach.low_x, viewport.width, crop.x) - 1, 0),
                    right = std::min(pixel(reach.high_x, viewport.width, crop.x) + 1, crop.width - 1),
                    top = std::max(pixel(reach.low_y, viewport.height, crop.y) - 1, 0),
                    bottom = std::min(pixel(reach.high_y, viewport.height, crop.y) + 1, crop.height - 1);
          if (left > right) continue;
          for (int row = top / rows_of_strip; row <= bottom / rows_of_strip && top <= bottom; ++row)
            if (depths.has_behind(row, left, right, reach.depth))
              of_strips[static_cast<std::size_t>(row)].push_back(static_cast<std::uint32_t>(first + t));
        }
      });
      stream.forget();
    }
  }
  std::vector<Triangles> out(strips);
  found.for_each([&](std::vector<Triangles>& of_strips) {
    for (std::size_t i = 0; i < strips; ++i) {
      out[i].insert(out[i].end(), of_strips[i].begin(), of_strips[i].end());
      of_strips[i] = {};
    }
  });
  return out;
}

/// The triangles of some rows.
Triangles triangles_in(const std::vector<Plane<std::uint32_t>>& ids, int top, int bottom) {
  Triangles out;
  for (const Plane<std::uint32_t>& plane : ids)
    for (int y = top; y < bottom; ++y)
      for (const std::uint32_t id : plane.row(y))
        if (id != Target::no_id && (out.empty() || out.back() != id)) out.push_back(id);
  sort_unique(out);
  return out;
}

struct Band {
  int top, bottom;
  Triangles triangles;
};

/// Bands with at most `most` triangles each, or one strip. `strips`: triangles of each strip besides the owners.
std::vector<Band> make_bands(const std::vector<Plane<std::uint32_t>>& ids, std::vector<Triangles> strips,
                             std::size_t most) {
  const int height = ids.front().height();
  parallel_for(strips.size(), [&](std::size_t i) {
    const int top = static_cast<int>(i) * rows_of_strip;
    const Triangles owners = triangles_in(ids, top, std::min(top + rows_of_strip, height));
    strips[i].insert(strips[i].end(), owners.begin(), owners.end());
  });
  std::vector<Band> bands;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    if (bands.empty() || bands.back().triangles.size() + strips[i].size() > most)
      bands.push_back({.top = static_cast<int>(i) * rows_of_strip, .bottom = 0, .triangles = {}});
    Band& band = bands.back();
    band.bottom = std::min(static_cast<int>(i + 1) * rows_of_strip, height);
    band.triangles.insert(band.triangles.end(), strips[i].begin(), strips[i].end());
    strips[i] = {};
  }
  for (Band& band : bands) sort_unique(band.triangles);
  return bands;
}

template <class T>
void paste(const Plane<T>& band, int top, int height, Plane<T>& whole) {
  if (band.empty()) return;
  if (whole.empty()) whole = Plane<T>(band.width(), height);
  for (int y = 0; y < band.height(); ++y) std::ranges::copy(band.row(y), whole.row(top + y).begin());
}

/// Copies the planes of a band to those of its frame.
void paste(Frame& band, int top, int height, Frame& whole) {
  const auto one = [&](auto& from, auto& to) { paste(from, top, height, to); };
  const auto all = [&](auto& from, auto& to) {
    to.resize(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) one(from[i], to[i]);
  };
  Frame::for_surface_planes(band, whole, one);
  one(band.color, whole.color), one(band.display8, whole.display8), one(band.coverage, whole.coverage);
  one(band.edge_distance, whole.edge_distance);
  all(band.sample_color, whole.sample_color), all(band.sample_depth, whole.sample_depth);
  all(band.sample_triangle, whole.sample_triangle), all(band.sample_geometry, whole.sample_geometry);
}

void add(const RenderCounts& own, RenderCounts& sum) {
  sum.prepare_ms += own.prepare_ms, sum.geometry_ms += own.geometry_ms, sum.tiles_ms += own.tiles_ms;
  sum.stages += own.stages;
  sum.triangles_set_up += own.triangles_set_up, sum.shaded += own.shaded, sum.geometric += own.geometric;
}

class StreamedBackend : public Backend {
 public:
  StreamedBackend(std::shared_ptr<const TriangleStream> stream, StreamCapacity capacity)
      : stream_(std::move(stream)), capacity_(capacity), cpu_(make_cpu_backend()) {}

  Frame render(const PreparedScene& head, const Camera& camera, const Request& request, const RenderOptions& options,
               RenderCounts* counts) override {
    check_streamed(request, options);
    if (std::ranges::any_of(head.scene().materials, is_transmissive)) refuse("surfaces that transmit light need");
    const Crop crop = options.crop.value_or(Crop{0, 0, options.width, options.height});
    RenderCounts sum;
    const Stopwatch search;
    const float4x4 clip_from_world = camera.clip_from_camera(aspect_of(options)) * inverse(camera.world_from_camera);
    const SceneDraws draws = make_draws(stream_->head(), clip_from_world, options);
    std::vector<Band> bands = growing("visible triangles", [&] {
      const Owners owners = find_owners(*stream_, capacity_.part, draws, request, options, crop);
      return make_bands(owners.ids, find_others(*stream_, draws, owners, options, crop), capacity_.visible);
    });
    sum.prepare_ms = search.ms();
    Frame frame;
    frame.x = crop.x, frame.y = crop.y;
    for (std::size_t i = 0; i < bands.size(); ++i) {
      RenderCounts own;
      Frame band = render_band(head, bands[i], camera, request, options, crop, own);
      add(own, sum);
      paste(band, bands[i].top, crop.height, frame);
      bands[i].triangles = {};
      if (options.progress)
        options.progress(share_of_search +
                         (1 - share_of_search) * static_cast<double>(i + 1) / static_cast<double>(bands.size()));
    }
    sum.triangles = stream_->count(), sum.vertices = 3 * stream_->count();
    if (counts) *counts = sum;
    return frame;
  }

 private:
  /// Step 3.
  Frame render_band(const PreparedScene& head, const Band& band, const Camera& camera, const Request& request,
                    RenderOptions options, const Crop& crop, RenderCounts& counts) {
    // Each instance is an object with a mesh of its own, whose primitives are some of the instance's.
    const std::vector<StreamInstance> instances = stream_->instances();
    Scene scene = head.scene();
    std::vector<std::size_t> first(instances.size());  // of the instance's triangles in the band
    scene.meshes = growing("visible triangles", [&] { return visible_meshes(head.scene(), band, instances, first); });
    for (std::size_t i = 0; i < instances.size(); ++i)
      scene.instances[i].mesh = scene.instances[i].object = static_cast<int>(i);
    options.crop = Crop{crop.x, crop.y + band.top, crop.width, band.bottom - band.top};
    options.progress = {};
    Request own = request;
    own.planes.object_id = request.planes.object_id || request.planes.primitive_id;
    if (!request.pixel_mask.empty()) {
      own.pixel_mask = Plane<std::uint8_t>(crop.width, options.crop->height);
      for (int y = band.top; y < band.bottom; ++y)
        std::ranges::copy(request.pixel_mask.row(y), own.pixel_mask.row(y - band.top).begin());
    }
    Frame frame =
        cpu_->render(PreparedScene(std::move(scene), head).lit(head.lighting()), camera, own, options, &counts);
    const std::span<std::uint32_t> object = frame.object_id.values(), primitive = frame.primitive_id.values();
    for (std::size_t p = 0; p < primitive.size(); ++p) {
      if (primitive[p] == Frame::no_id) continue;
      const std::size_t i = object[p], before = i == 0 ? 0 : instances[i - 1].end;
      primitive[p] = band.triangles[first[i] + primitive[p]] - static_cast<std::uint32_t>(before);
    }
    for (std::uint32_t& id : object)
      if (id != Frame::no_id) id = static_cast<std::uint32_t>(head.scene().instances[id].object);
    if (!request.planes.object_id) frame.object_id = {};
    for (Plane<std::uint32_t>& ids : frame.sample_triangle)
      for (std::uint32_t& id : ids.values())
        if (id != Frame::no_id) id = band.triangles[id];
    return frame;
  }

  /// For each instance its triangles of a band, and the number of the first one in the band.
  std::vector<Mesh> visible_meshes(const Scene& head, const Band& band, std::span<const StreamInstance> instances,
                                   std::span<std::size_t> first) const {
    std::vector<Mesh> meshes(instances.size());
    std::span<const std::uint32_t> rest = band.triangles;
    for (std::size_t i = 0; i < instances.size(); ++i) {
      const auto own_end = std::lower_bound(rest.begin(), rest.end(), instances[i].end);
      const auto count = static_cast<std::size_t>(own_end - rest.begin());
      if (count > 0) meshes[i] = stream_->mesh(rest.first(count));
      first[i] = band.triangles.size() - rest.size();
      const Mesh& own = head.meshes[static_cast<std::size_t>(head.instances[i].mesh)];
      meshes[i].name = own.name, meshes[i].material = own.material;
      rest = rest.subspan(count);
    }
    return meshes;
  }

  std::shared_ptr<const TriangleStream> stream_;
  StreamCapacity capacity_;
  std::unique_ptr<Backend> cpu_;
};

}  // namespace

void check_streamed(const Request& request, const RenderOptions& options) {
  if (has_visibility(options)) refuse("shadows and ambient occlusion need");
  if (options.edges.kind != EdgeKind::None) refuse("lines along edges need");
  if (options.visibility == Visibility::Painter) refuse("the painter's algorithm needs");
  if (request.draw || request.settling_frames > 1) refuse("the antialiasing method needs");
  if (request.planes.was_visible || options.last || options.next)
    refuse("the history of the antialiasing method needs");
  if (request.samples.size() > max_samples) refuse("more than 64 samples per pixel need");
}

std::unique_ptr<Backend> make_streamed_backend(std::shared_ptr<const TriangleStream> stream, StreamCapacity capacity) {
  return std::make_unique<StreamedBackend>(std::move(stream), capacity);
}

}  // namespace zoneplate
