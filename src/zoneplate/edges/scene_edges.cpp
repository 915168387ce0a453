// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/edges/scene_edges.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/double3.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/ray/trace.h"
#include "zoneplate/shade/cast/casters.h"

namespace zoneplate {
namespace {

constexpr double pieces_per_pixel = 2;
constexpr int rows_of_band = 16;
constexpr std::size_t edges_of_range = 4096;

/// Rays end before the point that they lead to, by more than the rounding of triangles that have it as a corner.
constexpr double ray_end = 1 - 0x1p-14;

const Mesh& mesh_of(const Scene& scene, const Instance& instance) {
  return scene.meshes[static_cast<std::size_t>(instance.mesh)];
}

/// A visible part of an edge on the screen, in pixels from the image's top-left corner.
struct Line {
  double x = 0, y = 0;    ///< its begin
  double dx = 0, dy = 0;  ///< the way to its end
  std::size_t first = 0;  ///< its first piece
  int pieces = 0;         ///< along it, of equal length on the screen
};

/// Lines and which of their pieces are seen.
struct Lines {
  std::vector<Line> line;
  std::vector<std::uint8_t> is_seen;
};

/// The extent of lines in pixels and their greatest coverage.
struct Stroke {
  double radius = 0;  ///< distance at which the coverage is 0
  float opacity = 1;  ///< less than 1 for lines thinner than a pixel
  explicit Stroke(float width) : radius(std::max(width, 1.0f) / 2.0 + 0.5), opacity(std::min(width, 1.0f)) {}
};

/// The camera as far as edges need it.
class Viewpoint {
 public:
  Viewpoint(const EdgeView& view)
      : clip_from_world_(view.camera.clip_from_camera(view.aspect) * inverse(view.camera.world_from_camera)),
        eye_(widened(xyz(view.camera.world_from_camera.column[3]))),
        forward_(widened(-xyz(view.camera.world_from_camera.column[2]))),
        near_(view.camera.near),
        is_orthographic_(view.camera.is_orthographic) {}

  struct Clip {
    double x = 0, y = 0, z = 0, w = 0;
  };
  Clip clip(double3 p) const {
    const auto& c = clip_from_world_.column;
    const auto row = [&](float a, float b, float e, float d) { return ((a * p.x + b * p.y) + e * p.z) + d; };
    return {row(c[0].x, c[1].x, c[2].x, c[3].x), row(c[0].y, c[1].y, c[2].y, c[3].y),
            row(c[0].z, c[1].z, c[2].z, c[3].z), row(c[0].w, c[1].w, c[2].w, c[3].w)};
  }

  /// Towards the eye from a point; of any length.
  double3 towards(double3 p) const { return is_orthographic_ ? forward_ * -1 : eye_ - p; }

  /// The line of sight to a point, from the near plane on; nothing for a point on that plane.
  std::optional<Ray> sight(double3 p) const {
    const double distance = dot(p - eye_, forward_);
    if (!(distance > near_ * (1 + 1e-6))) return std::nullopt;
    const double3 from = is_orthographic_ ? p - forward_ * (distance - near_) : mix(eye_, p, near_ / distance);
    const float3 origin = narrowed(from), direction = narrowed(p - from);
    if (direction == float3{}) return std::nullopt;
    return Ray{{origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}, static_cast<float>(ray_end)};
  }

 private:
  float4x4 clip_from_world_;
  double3 eye_, forward_;
  double near_;
  bool is_orthographic_;
};

/// The triangles of one instance in world space.
class PlacedMesh {
 public:
  PlacedMesh(const Scene& scene, std::size_t instance, const EdgeView& view)
      : mesh_(mesh_of(scene, scene.instances[instance])),
        world_from_object_(scene.instances[instance].world_from_object),
        is_mirrored_(determinant3(world_from_object_) < 0),
        culls_(view.culls_back_faces && !scene.materials[static_cast<std::size_t>(mesh_.material)].double_sided) {}

  double3 place(std::uint32_t vertex) const {
    return widened(transform_point(world_from_object_, mesh_.position[vertex]));
  }
  /// Of a triangle, on its front; its length is twice the area.
  double3 normal(std::uint32_t face) const {
    const std::uint32_t* const v = &mesh_.index[std::size_t{3} * face];
    const double3 a = place(v[0]), n = cross(place(v[1]) - a, place(v[2]) - a);
    return is_mirrored_ ? n * -1 : n;
  }
  bool faces(std::uint32_t face, const Viewpoint& viewpoint) const {
    return dot(normal(face), viewpoint.towards(place(mesh_.index[std::size_t{3} * face]))) > 0;
  }
  bool is_drawn(std::uint32_t face, const Viewpoint& viewpoint) const { return !culls_ || faces(face, viewpoint); }
  bool culls() const { return culls_; }

 private:
  const Mesh& mesh_;
  float4x4 world_from_object_;
  bool is_mirrored_, culls_;
};

/// Decides which edges are drawn.
class EdgeChoice {
 public:
  EdgeChoice(const EdgeOptions& options, const Viewpoint& viewpoint)
      : options_(options), viewpoint_(viewpoint), cosine_(cos(options.crease_angle)) {}

  bool takes(const MeshEdge& edge, const PlacedMesh& mesh) const {
    const bool is_boundary = edge.face[1] == MeshEdge::no_face;
    if (options_.hides && !mesh.is_drawn(edge.face[0], viewpoint_) &&
        (is_boundary || !mesh.is_drawn(edge.face[1], viewpoint_)))
      return false;
    if (options_.kind == EdgeKind::Mesh || is_boundary) return true;
    const double3 a = mesh.normal(edge.face[0]), b = mesh.normal(edge.face[1]);
    const double size = std::sqrt(dot(a, a) * dot(b, b));
    const double along = edge.is_turned ? -dot(a, b) : dot(a, b);
    if (!edge.is_manifold) return std::abs(along) < cosine_ * size;
    if (along < cosine_ * size) return true;
    return mesh.faces(edge.face[0], viewpoint_) != (mesh.faces(edge.face[1], viewpoint_) != edge.is_turned);
  }

 private:
  const EdgeOptions& options_;
  const Viewpoint& viewpoint_;
  double cosine_;
};

/// What hides an edge: the context of its rays.
struct Hiders {
  const std::vector<PlacedMesh>& meshes;
  const Viewpoint& viewpoint;
  OpacityOfHits opacity;
  std::size_t instance = 0;
  const MeshEdge* edge = nullptr;

  float at(const RayHit& hit) const {
    if (hit.instance == instance && (hit.primitive == edge->face[0] || hit.primitive == edge->face[1])) return 0;
    const PlacedMesh& mesh = meshes[hit.instance];
    if (mesh.culls() && !mesh.faces(hit.primitive, viewpoint)) return 0;
    return opacity.opacity(opacity.context, hit) > 0.5f ? 1.0f : 0.0f;
  }
};

/// Makes the lines of edges.
class LineMaker {
 public:
  LineMaker(const EdgeView& view, const Viewpoint& viewpoint, const Stroke& stroke, const Bvh* bvh)
      : view_(view), viewpoint_(viewpoint), margin_(stroke.radius + 1), bvh_(bvh) {}

  /// Adds the part of an edge in the image, if any of it may be seen in the wanted part.
  void add(double3 from, double3 to, const Hiders& hiders, Lines& out) {
    const Viewpoint::Clip a = viewpoint_.clip(from), b = viewpoint_.clip(to);
    double begin = 0, end = 1;
    if (!clip(a, b, begin, end)) return;
    const auto at = [&](double t) {
      return Viewpoint::Clip{a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, 0, a.w + (b.w - a.w) * t};
    };
    const Viewpoint::Clip first = at(begin), last = at(end);
    if (!(first.w > 0) || !(last.w > 0)) return;
    const auto x = [&](const Viewpoint::Clip& c) { return (c.x / c.w + 1) * view_.width / 2; };
    const auto y = [&](const Viewpoint::Clip& c) { return (1 - c.y / c.w) * view_.height / 2; };
    Line line{x(first), y(first), x(last) - x(first), y(last) - y(first), out.is_seen.size(), 1};
    if (!touches(line)) return;
    line.pieces =
        std::max(1, static_cast<int>(std::ceil(pieces_per_pixel * std::sqrt(line.dx * line.dx + line.dy * line.dy))));
    out.is_seen.resize(line.first + static_cast<std::size_t>(line.pieces), bvh_ == nullptr ? 1 : 0);
    bool is_seen = bvh_ == nullptr;
    if (bvh_ != nullptr) {
      rays_.clear(), pieces_.clear();
      for (int i = 0; i < line.pieces; ++i) {
        const double s = (i + 0.5) / line.pieces;
        if (!is_in_part(line.x + line.dx * s, line.y + line.dy * s)) continue;
        const double u = s * first.w / ((1 - s) * last.w + s * first.w);  // interpolation in space
        const std::optional<Ray> ray = viewpoint_.sight(mix(from, to, begin + (end - begin) * u));
        if (ray)
          rays_.push_back(*ray), pieces_.push_back(i);
        else
          out.is_seen[line.first + static_cast<std::size_t>(i)] = 1, is_seen = true;
      }
      visibility_.resize(rays_.size());
      const OpacityOfHits opacity{
          [](const void* self, const RayHit& hit) { return static_cast<const Hiders*>(self)->at(hit); }, &hiders};
      RayKernels::of().visibility(view_of(*bvh_), rays_.data(), rays_.size(), opacity, visibility_.data());
      for (std::size_t i = 0; i < rays_.size(); ++i) {
        const bool sees = visibility_[i] > 0;
        out.is_seen[line.first + static_cast<std::size_t>(pieces_[i])] = sees;
        is_seen |= sees;
      }
    }
    if (is_seen)
      out.line.push_back(line);
    else
      out.is_seen.resize(line.first);
  }

 private:
  /// Clips against the near and far planes and the image's sides with a margin, which do not depend on the wanted part.
  bool clip(const Viewpoint::Clip& a, const Viewpoint::Clip& b, double& begin, double& end) const {
    const double side = 1 + 2 * margin_ / view_.width, top = 1 + 2 * margin_ / view_.height;
    const auto cut = [&](double at_a, double at_b) {
      if (at_a < 0 && at_b < 0) return false;
      if (at_a < 0) begin = std::max(begin, at_a / (at_a - at_b));
      if (at_b < 0) end = std::min(end, at_a / (at_a - at_b));
      return begin <= end;
    };
    return cut(a.w - a.z, b.w - b.z) && cut(a.z, b.z) && cut(a.w * side + a.x, b.w * side + b.x) &&
           cut(a.w * side - a.x, b.w * side - b.x) && cut(a.w * top + a.y, b.w * top + b.y) &&
           cut(a.w * top - a.y, b.w * top - b.y);
  }
  bool touches(const Line& line) const {
    const double left = std::min(line.x, line.x + line.dx), right = std::max(line.x, line.x + line.dx);
    const double upper = std::min(line.y, line.y + line.dy), lower = std::max(line.y, line.y + line.dy);
    return right >= view_.x - margin_ && left <= view_.x + view_.part_width + margin_ && lower >= view_.y - margin_ &&
           upper <= view_.y + view_.part_height + margin_;
  }
  bool is_in_part(double x, double y) const {
    return x >= view_.x - margin_ && x <= view_.x + view_.part_width + margin_ && y >= view_.y - margin_ &&
           y <= view_.y + view_.part_height + margin_;
  }

  const EdgeView& view_;
  const Viewpoint& viewpoint_;
  double margin_;
  const Bvh* bvh_;
  std::vector<Ray> rays_;
  std::vector<int> pieces_;
  std::vector<float> visibility_;
};

/// How much of a line is seen at a part of its length: between the middles of pieces, linear.
double seen_at(const Line& line, const std::vector<std::uint8_t>& is_seen, double part) {
  const double at = std::clamp(part * line.pieces - 0.5, 0.0, line.pieces - 1.0);
  const auto i = static_cast<std::size_t>(at);
  const double weight = at - static_cast<double>(i);
  const std::size_t next = std::min(i + 1, static_cast<std::size_t>(line.pieces) - 1);
  return is_seen[line.first + i] * (1 - weight) + is_seen[line.first + next] * weight;
}

/// Draws a line into rows [begin, end) of the wanted part.
void draw(const Line& line, const std::vector<std::uint8_t>& is_seen, const Stroke& stroke, const EdgeView& view,
          int begin, int end, Plane<float>& out) {
  const double square = line.dx * line.dx + line.dy * line.dy, length = std::sqrt(square), r = stroke.radius;
  const double left = std::min(line.x, line.x + line.dx) - r, right = std::max(line.x, line.x + line.dx) + r;
  const double upper = std::min(line.y, line.y + line.dy) - r, lower = std::max(line.y, line.y + line.dy) + r;
  begin = std::max(begin, static_cast<int>(std::floor(std::max(upper, -1e6))) - view.y);
  end = std::min(end, static_cast<int>(std::ceil(std::min(lower, 1e6))) + 1 - view.y);
  for (int row = begin; row < end; ++row) {
    const double py = view.y + row + 0.5 - line.y;
    double from = left, to = right;  // where the row may be within the radius
    if (std::abs(line.dy) > 1e-6 * length) {
      const double middle = line.x + py * line.dx / line.dy, half = r * length / std::abs(line.dy) + 1;
      from = std::max(from, middle - half), to = std::min(to, middle + half);
    }
    const int first = std::max(0, static_cast<int>(std::floor(std::max(from, -1e6))) - view.x);
    const int last = std::min(view.part_width, static_cast<int>(std::ceil(std::min(to, 1e6))) + 1 - view.x);
    for (int column = first; column < last; ++column) {
      const double px = view.x + column + 0.5 - line.x;
      const double part = square > 0 ? std::clamp((px * line.dx + py * line.dy) / square, 0.0, 1.0) : 0.0;
      const double ox = px - part * line.dx, oy = py - part * line.dy, distance = ox * ox + oy * oy;
      if (!(distance < r * r)) continue;
      const double covered = std::min(1.0, r - std::sqrt(distance)) * seen_at(line, is_seen, part);
      out(column, row) = std::max(out(column, row), stroke.opacity * static_cast<float>(covered));
    }
  }
}

/// Draws lines, band by band of rows.
Plane<float> drawn(const std::vector<Lines>& ranges, const Stroke& stroke, const EdgeView& view) {
  struct Entry {
    std::uint32_t range, line;
  };
  std::vector<std::vector<Entry>> bands(static_cast<std::size_t>((view.part_height + rows_of_band - 1) / rows_of_band));
  const auto band_of = [&](double y) {
    const double row = std::clamp(std::floor(y) - view.y, 0.0, view.part_height - 1.0);
    return static_cast<std::size_t>(row) / rows_of_band;
  };
  for (std::size_t r = 0; r < ranges.size(); ++r)
    for (std::size_t i = 0; i < ranges[r].line.size(); ++i) {
      const Line& line = ranges[r].line[i];
      const double upper = std::min(line.y, line.y + line.dy) - stroke.radius;
      const double lower = std::max(line.y, line.y + line.dy) + stroke.radius;
      for (std::size_t b = band_of(upper); b <= band_of(lower); ++b)
        bands[b].push_back({static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(i)});
    }
  Plane<float> out(view.part_width, view.part_height, 0.0f);
  parallel_for(bands.size(), [&](std::size_t b) {
    const int begin = static_cast<int>(b) * rows_of_band, end = std::min(begin + rows_of_band, view.part_height);
    for (const auto& [range, line] : bands[b])
      draw(ranges[range].line[line], ranges[range].is_seen, stroke, view, begin, end, out);
  });
  return out;
}

/// The colour of lines: straight, sRGB code.
float4 color_of(const EdgeOptions& options, const DisplayOptions& display) {
  if (options.color) return *options.color;
  const float4 b = display.background;
  const float luma = 0.2126f * b.x + 0.7152f * b.y + 0.0722f * b.z;
  return options.has_surfaces || display.is_transparent || luma > 0.5f ? float4{0, 0, 0, 1} : float4{1, 1, 1, 1};
}

}  // namespace

void SceneEdges::set_scene(const std::shared_ptr<const Scene>& scene) {
  if (scene_ == scene) return;
  scene_ = nullptr;
  bvh_.reset();
  edges_.assign(scene->meshes.size(), {});
  parallel_for(edges_.size(), [&](std::size_t i) {
    if (scene->meshes[i].topology == Topology::Triangles) edges_[i] = mesh_edges(scene->meshes[i]);
  });
  scene_ = scene;
}

Plane<float> SceneEdges::coverage(const std::shared_ptr<const Scene>& scene, const TextureSet& textures,
                                  const EdgeView& view, const EdgeOptions& options) {
  set_scene(scene);
  if (options.hides && !bvh_) {
    std::vector<ShadowCaster> casters = make_casters(*scene);
    for (ShadowCaster& caster : casters) caster.is_translucent = true;  // Hiders decides on each hit
    bvh_.emplace(casters);
  }
  const Viewpoint viewpoint(view);
  const Stroke stroke(options.width);
  const EdgeChoice choice(options, viewpoint);
  const CasterOpacity opacity(*scene, textures);
  std::vector<PlacedMesh> meshes;
  for (std::size_t i = 0; i < scene->instances.size(); ++i) meshes.emplace_back(*scene, i, view);

  // Ranges of the edges of each instance.
  struct Range {
    std::size_t instance, begin, end;
  };
  std::vector<Range> ranges;
  for (std::size_t i = 0; i < scene->instances.size(); ++i) {
    const std::size_t count = edges_[static_cast<std::size_t>(scene->instances[i].mesh)].size();
    for (std::size_t begin = 0; begin < count; begin += edges_of_range)
      ranges.push_back({i, begin, std::min(begin + edges_of_range, count)});
  }
  std::vector<Lines> lines(ranges.size());
  parallel_for(ranges.size(), [&](std::size_t r) {
    const auto [instance, begin, end] = ranges[r];
    const std::vector<MeshEdge>& edges = edges_[static_cast<std::size_t>(scene->instances[instance].mesh)];
    const PlacedMesh& mesh = meshes[instance];
    LineMaker maker(view, viewpoint, stroke, options.hides && !bvh_->nodes().empty() ? &*bvh_ : nullptr);
    Hiders hiders{meshes, viewpoint, opacity.of_hits(), instance};
    for (std::size_t i = begin; i < end; ++i) {
      if (!choice.takes(edges[i], mesh)) continue;
      hiders.edge = &edges[i];
      maker.add(mesh.place(edges[i].vertex[0]), mesh.place(edges[i].vertex[1]), hiders, lines[r]);
    }
  });
  return drawn(lines, stroke, view);
}

void draw_edges(const Plane<float>& coverage, const EdgeOptions& options, const DisplayOptions& display,
                DisplayImage& image) {
  const float4 color = color_of(options, display);
  const auto decoded = [&](float code) { return display.raw ? code : decode_srgb(code); };
  const auto encoded = [&](float linear) { return display.raw ? linear : encode_srgb(linear); };
  parallel_for(static_cast<std::size_t>(image.height()), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < image.width(); ++x) {
      const float part = coverage(x, y) * color.w;
      if (part == 0) continue;
      Display& p = image(x, y);
      const float alpha = part + p.a * (1 - part);
      const auto mixed = [&](float over, float under) {
        return encoded((decoded(over) * part + decoded(under) * (p.a * (1 - part))) / alpha);
      };
      p = {mixed(color.x, p.r), mixed(color.y, p.g), mixed(color.z, p.b), alpha};
    }
  });
}

void draw_edges(const Plane<float>& coverage, const EdgeOptions& options, const DisplayOptions& display,
                LinearImage& image) {
  const float4 color = color_of(options, display);
  const auto light = [&](float code) {
    const float linear = display.raw ? code : decode_srgb(code);
    return display.exposure > 0 ? linear / display.exposure : linear;
  };
  const Linear line{light(color.x), light(color.y), light(color.z), 1};
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const float part = coverage(x, y) * color.w;
      if (part > 0) image(x, y) = line * part + image(x, y) * (1 - part);
    }
}

}  // namespace zoneplate
