#include "zoneplate/raster/points.h"

#include <algorithm>
#include <numeric>

namespace zoneplate {

PointBatcher::PointBatcher(const ProjectedDraws& projected, const PointShader& shader, Isa isa, const Target& target)
    : projected_(projected), shader_(shader), interpolate_(interpolate_kernels(isa)), target_(target) {}

void PointBatcher::order_by_material(std::span<const Point> points) {
  material_.resize(points.size());
  order_.resize(points.size());
  std::iota(order_.begin(), order_.end(), 0u);
  std::int32_t begin = 0, end = 0;  // the triangles of the draw found last
  std::uint32_t material = 0;
  bool is_mixed = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].id < begin || points[i].id >= end) {
      const std::size_t d = projected_.draw_of(points[i].id);
      begin = projected_.first_triangle[d], end = projected_.first_triangle[d + 1];
      material = static_cast<std::uint32_t>(projected_.draws[d].material);
    }
    material_[i] = material;
    is_mixed = is_mixed || material != material_[0];
  }
  if (is_mixed)
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t p, std::uint32_t q) { return material_[p] < material_[q]; });
}

void PointBatcher::fill(std::span<const Point> points, std::span<const std::uint32_t> numbers) {
  batch_.count = static_cast<int>(numbers.size());
  batch_.material = static_cast<int>(material_[numbers[0]]);
  std::size_t draw = 0;
  std::int32_t begin = 0, end = 0, id = -1;
  TriangleFacing facing;
  std::uint32_t vertex[3] = {}, primitive = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(batch_.padded()); ++i) {
    const Point& point = points[numbers[std::min(i, numbers.size() - 1)]];
    if (point.id != id) {
      id = point.id;
      if (id < begin || id >= end) {
        draw = projected_.draw_of(id);
        begin = projected_.first_triangle[draw], end = projected_.first_triangle[draw + 1];
      }
      const Draw& d = projected_.draws[draw];
      const auto local = static_cast<std::uint32_t>(id - begin);
      facing = face_of(projected_, draw, id, target_.viewport);
      primitive = local / static_cast<std::uint32_t>(d.triangles_per_primitive);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = d.index[3 * static_cast<std::size_t>(local) + k];
        vertex[k] = d.source.empty() ? v : d.source[v];
      }
    }
    const Draw& d = projected_.draws[draw];
    batch_.triangle[i] = static_cast<std::uint32_t>(id);
    batch_.instance[i] = d.instance;
    batch_.primitive[i] = primitive;
    batch_.x[i] = point.x;
    batch_.y[i] = point.y;
    batch_.is_front[i] = facing.is_clockwise == d.is_mirrored ? 1 : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      batch_.vertex[k][i] = vertex[k];
      planes_.x[k][i] = facing.planes.x[k];
      planes_.y[k][i] = facing.planes.y[k];
      planes_.one[k][i] = facing.planes.one[k];
    }
  }
  interpolate_.interpolate(planes_, target_.viewport, target_.spacing, batch_);
}

template <class Use>
void PointBatcher::for_batches(std::span<const Point> points, Use use) {
  order_by_material(points);
  shaded_ += points.size();
  for (std::size_t first = 0; first < points.size();) {
    std::size_t last = first + 1;
    while (last < points.size() && last - first < Batch::capacity &&
           material_[order_[last]] == material_[order_[first]])
      ++last;
    const auto numbers = std::span<const std::uint32_t>(order_).subspan(first, last - first);
    fill(points, numbers);
    use(numbers);
    first = last;
  }
}

void PointBatcher::shade(std::span<const Point> points, std::vector<Linear>& colors, PointData* data) {
  colors.resize(points.size());
  const PointShader::Wanted wanted{
      .normal = data && target_.normal, .uv = data && target_.uv, .albedo = data && target_.albedo};
  if (wanted.normal) data->normal.resize(points.size());
  if (wanted.uv) data->uv.resize(points.size());
  if (wanted.albedo) data->albedo.resize(points.size());
  for_batches(points, [&](std::span<const std::uint32_t> numbers) {
    shader_.shade(batch_, wanted, shaded_batch_);
    const Shaded& s = shaded_batch_;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const std::uint32_t at = numbers[i];
      colors[at] = {s.r[i], s.g[i], s.b[i], s.a[i]};
      if (wanted.normal) data->normal[at] = {s.normal[0][i], s.normal[1][i], s.normal[2][i]};
      if (wanted.uv) data->uv[at] = {s.uv[0][i], s.uv[1][i]};
      if (wanted.albedo) data->albedo[at] = {s.albedo[0][i], s.albedo[1][i], s.albedo[2][i]};
    }
  });
}

void PointBatcher::test_alpha(std::span<const Point> points, std::vector<std::uint8_t>& is_there) {
  is_there.resize(points.size());
  for_batches(points, [&](std::span<const std::uint32_t> numbers) {
    alignas(64) float alpha[Batch::capacity];
    const float cutoff = shader_.alpha(batch_, alpha);
    for (std::size_t i = 0; i < numbers.size(); ++i) is_there[numbers[i]] = alpha[i] >= cutoff;
  });
}

}  // namespace zoneplate
