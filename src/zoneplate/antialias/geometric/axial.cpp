// SPDX-License-Identifier: Apache-2.0
// Axial coverage: 64 visibility samples along the pixel's row and column measure the extent of its triangle; the pixel
// is blended with its neighbour by the length beyond the triangle's edge.
//
// One-dimensional coverage as in geometry buffer antialiasing (`gbaa`), but of visible surfaces: hidden edges and
// intersections are handled correctly, at the cost of 64 visibility samples per pixel. Exact to 1/32 pixel for
// horizontal and vertical edges, within an eighth of a pixel for oblique ones, for any contrast, with one shaded sample
// per pixel. Weaknesses: corners; no effect on aliasing of shading. With `edges=triangles` the edges of all triangles
// count: where triangles are smaller than a pixel, the nearest edge is inside the surface and hides the outline beyond
// it, so that outlines of fine meshes are mottled. With `edges=surfaces` only edges count at which a surface ends or
// bends.
//
// Source: after Persson, Geometry Buffer Anti-Aliasing, SIGGRAPH 2011 course.
#include <algorithm>
#include <cmath>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace axial_method {
namespace {

constexpr int places = 32;  // sample positions along each axis, those along the row first
constexpr int half = places / 2;

/// The samples from the centre to one side of the pixel: `half` positions, the first of them at `begin`.
struct Way {
  int begin, step;
  int dx, dy;  ///< offset of the neighbour beyond that side
};
constexpr Way ways[] = {
    {half - 1, -1, -1, 0}, {half, 1, 1, 0}, {places + half - 1, -1, 0, -1}, {places + half, 1, 0, 1}};

/// The visible triangles along the axes of the pixels.
class Places {
 public:
  explicit Places(const Frame& frame) : frame_(frame) {}

  /// The number of consecutive samples from the first one that have its triangle: `half` if there is no edge.
  int run(const Way& way, int x, int y) const {
    const std::uint32_t own = triangle(way, 0, x, y);
    int length = 1;
    while (length < half && triangle(way, length, x, y) == own) ++length;
    return length;
  }

  /// The number of consecutive samples that belong to the surface of the first one; `is_alike` states whether the
  /// neighbour has the same surface.
  int run_of_surface(const Way& way, int x, int y, bool is_alike) const {
    int bend = half;
    float greatest = -1;
    for (int i = 1; i < half; ++i) {
      const std::uint32_t before = triangle(way, i - 1, x, y), after = triangle(way, i, x, y);
      if (before == after) continue;
      if (before == Frame::no_id || after == Frame::no_id || is_torn(way, i, x, y)) return i;
      if (const float turn = std::abs(slope(way, i, 1, x, y) - slope(way, i - 1, -1, x, y)); turn > greatest)
        greatest = turn, bend = i;
    }
    return is_alike ? half : bend;
  }

 private:
  std::size_t sample(const Way& way, int i) const { return static_cast<std::size_t>(way.begin + way.step * i); }
  std::uint32_t triangle(const Way& way, int i, int x, int y) const {
    return frame_.sample_triangle[sample(way, i)](x, y);
  }
  float depth(const Way& way, int i, int x, int y) const { return frame_.sample_depth[sample(way, i)](x, y); }

  /// The difference of depth between sample i and the next one towards `side`; 0 for empty samples.
  float slope(const Way& way, int i, int side, int x, int y) const {
    const int axis = way.begin / places * places, other = way.begin + way.step * (i + side) - axis;
    if (other < 0 || other >= places || triangle(way, i + side, x, y) == Frame::no_id) return 0;
    return (depth(way, i + side, x, y) - depth(way, i, x, y)) * static_cast<float>(side);
  }

  /// True if depth is discontinuous between samples i - 1 and i: its difference is greater than those on both sides. At
  /// the silhouette of a curved surface, depth differences grow by a factor of up to 1 / (√2 - 1) per step.
  bool is_torn(const Way& way, int i, int x, int y) const {
    constexpr float most = 3, rounding = 0x1p-20f;
    const float z = depth(way, i - 1, x, y), next = depth(way, i, x, y);
    const float steepest = std::max(std::abs(slope(way, i - 1, -1, x, y)), std::abs(slope(way, i, 1, x, y)));
    return std::abs(next - z) > most * steepest + rounding * std::max(z, next);
  }

  const Frame& frame_;
};

class Axial : public Resolver {
 public:
  explicit Axial(bool of_surfaces) : of_surfaces_(of_surfaces) {
    for (int i = 0; i < places; ++i) pattern_.push_back({at(i), 128});
    for (int i = 0; i < places; ++i) pattern_.push_back({128, at(i)});
  }
  Request request(const FrameContext&) override {
    color_ = {};
    Request request;
    request.planes.normal = request.planes.object_id = request.planes.material_id = of_surfaces_;
    request.halo = 1;
    request.ends_in_light = true;
    return request;
  }
  /// Requests the colours first, then the triangles.
  std::optional<Request> refine(Frame& frame) override {
    if (!color_.empty()) return std::nullopt;
    color_ = std::move(frame.color);
    normal_ = std::move(frame.normal), object_ = std::move(frame.object_id), material_ = std::move(frame.material_id);
    Request request;
    request.samples = pattern_;
    request.content = Content::Visibility;
    (of_surfaces_ ? request.planes.samples : request.planes.sample_triangles) = true;
    return request;
  }
  LinearImage resolve(Frame& frame) override {
    if (color_.empty()) return std::move(frame.color);
    const Places seen(frame);
    LinearImage out(color_.width(), color_.height());
    for_rows(out.height(), [&](int y) {
      for (int x = 0; x < out.width(); ++x) out(x, y) = pixel(seen, x, y);
    });
    return out;
  }

 private:
  static std::uint8_t at(int place) { return static_cast<std::uint8_t>((2 * place + 1) * 256 / (2 * places)); }

  /// An edge towards a neighbour.
  struct Nearest {
    int length = half;  ///< half: no edge
    int x = 0, y = 0;
    void take(int other_length, int other_x, int other_y) {
      if (other_length < length) length = other_length, x = other_x, y = other_y;
    }
  };

  /// Selects the nearest edge in the four directions; of equally near ones the first of left, right, up, down. With
  /// edges of surfaces, edges towards pixels with another surface take precedence.
  Linear pixel(const Places& seen, int x, int y) const {
    Nearest nearest, among_alike;
    for (const Way& way : ways) {
      const int i = x + way.dx, j = y + way.dy;
      if (i < 0 || j < 0 || i >= color_.width() || j >= color_.height()) continue;
      const int length = seen.run(way, x, y);
      if (length == half) continue;
      if (!of_surfaces_) {
        nearest.take(length, i, j);
      } else if (are_alike(x, y, i, j)) {
        among_alike.take(seen.run_of_surface(way, x, y, true), i, j);
      } else {
        nearest.take(seen.run_of_surface(way, x, y, false), i, j);
      }
    }
    if (nearest.length == half) nearest = among_alike;
    if (nearest.length == half) return color_(x, y);
    const float share = static_cast<float>(half - nearest.length) / places;
    return color_(x, y) * (1 - share) + color_(nearest.x, nearest.y) * share;
  }

  /// True if two pixels have the same material of the same object, and normals less than 60 degrees apart.
  bool are_alike(int x, int y, int i, int j) const {
    constexpr float min_cosine = 0.5f;
    return object_(x, y) == object_(i, j) && material_(x, y) == material_(i, j) &&
           dot(normal_(x, y), normal_(i, j)) > min_cosine;
  }

  bool of_surfaces_;
  SamplePattern pattern_;
  LinearImage color_;
  Plane<float3> normal_;
  Plane<std::uint32_t> object_, material_;
};

constexpr std::string_view edges[] = {"triangles", "surfaces"};
constexpr Param params[] = {{.name = "edges",
                             .meaning = "edges that count: of every triangle, or only where surfaces end or bend",
                             .value = 1,
                             .names = edges}};
constexpr std::string_view variants[] = {"edges=triangles"};

}  // namespace
}  // namespace axial_method

Method axial() {
  return {.name = "axial",
          .summary = "one shaded sample per pixel; coverage from 64 visibility samples along its row and column",
          .source = "after Persson 2011",
          .params = axial_method::params,
          .make = [](const Settings& s) -> std::unique_ptr<Resolver> {
            return std::make_unique<axial_method::Axial>(s.chosen("edges") == "surfaces");
          },
          .variants = axial_method::variants,
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
