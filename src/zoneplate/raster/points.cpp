#include "zoneplate/raster/points.h"

#include <algorithm>
#include <numeric>

namespace zoneplate {

PointBatcher::PointBatcher(const ProjectedDraws& projected, const PointShader& shader, Isa isa, const Target& target)
    : projected_(projected),
      shader_(shader),
      interpolate_(interpolate_kernels(isa)),
      target_(target),
      has_ends_(
          std::any_of(projected.draws.begin(), projected.draws.end(), [](const Draw& d) { return !d.ends.empty(); })) {}

/// order_: the list's numbers, those of one material together; material_: by number.
template <class T>
void PointBatcher::order_by_material(std::span<const T> list) {
  material_.resize(list.size());
  order_.resize(list.size());
  std::iota(order_.begin(), order_.end(), 0u);
  std::int32_t begin = 0, end = 0;  // the triangles of the draw found last
  std::uint32_t material = 0;
  bool is_mixed = false;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].id < begin || list[i].id >= end) {
      const std::size_t d = projected_.draw_of(list[i].id);
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

template void PointBatcher::order_by_material(std::span<const PointRow> list);

/// How many of the list's numbers from `first` on share a material, `most` at most.
template <class T>
std::size_t PointBatcher::same_material(std::span<const T> list, std::size_t first, std::size_t most) const {
  const std::size_t limit = std::min(list.size(), first + most);
  std::size_t last = first + 1;
  while (last < limit && material_[order_[last]] == material_[order_[first]]) ++last;
  return last - first;
}

template std::size_t PointBatcher::same_material(std::span<const PointRow> list, std::size_t first,
                                                 std::size_t most) const;

void PointBatcher::find_draw(std::int32_t id) {
  if (id >= known_.begin && id < known_.end) return;
  known_.draw = projected_.draw_of(id);
  known_.begin = projected_.first_triangle[known_.draw], known_.end = projected_.first_triangle[known_.draw + 1];
}

/// Asks for the corners of triangles that are about to be known: their vertices lie anywhere in memory.
void PointBatcher::fetch_ahead(std::span<const Point> points, std::span<const std::uint32_t> numbers) {
  std::int32_t last = -1;
  for (const std::uint32_t n : numbers) {
    const std::int32_t id = points[n].id;
    if (id == last) continue;
    last = id;
    find_draw(id);
    const Draw& draw = projected_.draws[known_.draw];
    const std::uint32_t* v = &draw.index[3 * static_cast<std::size_t>(id - known_.begin)];
    for (std::size_t k = 0; k < 3; ++k) {
      __builtin_prefetch(&projected_.screen[known_.draw][v[k]]);
      if (v[k] < draw.position.size()) __builtin_prefetch(&draw.position[v[k]]);
    }
  }
}

const PointBatcher::Known& PointBatcher::know(std::int32_t id) {
  if (id == known_.id) return known_;
  known_.id = id;
  find_draw(id);
  const Draw& draw = projected_.draws[known_.draw];
  const auto local = static_cast<std::uint32_t>(id - known_.begin);
  const TriangleFacing facing = face_of(projected_, known_.draw, id, target_.viewport);
  known_.instance = draw.instance;
  known_.primitive = draw.primitive_of(local);
  for (std::size_t k = 0; k < 3; ++k)
    known_.vertex[k] = draw.ends.empty()
                           ? draw.index[3 * static_cast<std::size_t>(local) + k]
                           : draw.ends[2 * static_cast<std::size_t>(known_.primitive) + std::min<std::size_t>(k, 1)];
  known_.is_front = facing.is_clockwise == draw.is_mirrored ? 1 : 0;
  known_.planes = facing.planes;
  return known_;
}

void PointBatcher::put(std::size_t i, const Known& known, std::int32_t x, std::int32_t y) {
  batch_.triangle[i] = static_cast<std::uint32_t>(known.id);
  batch_.instance[i] = known.instance;
  batch_.primitive[i] = known.primitive;
  for (std::size_t k = 0; k < 3; ++k) batch_.vertex[k][i] = known.vertex[k];
  batch_.is_front[i] = known.is_front;
  batch_.x[i] = x;
  batch_.y[i] = y;
}

void PointBatcher::fill(std::span<const Point> points, std::span<const std::uint32_t> numbers) {
  batch_.count = static_cast<int>(numbers.size());
  batch_.material = static_cast<int>(material_[numbers[0]]);
  std::fill(std::begin(planes_.is_shared), std::end(planes_.is_shared), false);
  known_.id = -1;
  fetch_ahead(points, numbers);
  for (std::size_t i = 0; i < static_cast<std::size_t>(batch_.padded()); ++i) {
    const Point& point = points[numbers[std::min(i, numbers.size() - 1)]];
    const Known& known = know(point.id);
    put(i, known, point.x, point.y);
    for (std::size_t k = 0; k < 3; ++k) {
      planes_.x[k][i] = known.planes.x[k];
      planes_.y[k][i] = known.planes.y[k];
      planes_.one[k][i] = known.planes.one[k];
    }
  }
  interpolate();
}

void PointBatcher::fill(std::span<const PointRow> rows, std::span<const std::uint32_t> numbers) {
  batch_.count = static_cast<int>(numbers.size()) * Batch::group;
  batch_.material = static_cast<int>(material_[numbers[0]]);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const PointRow& row = rows[numbers[i]];
    const Known& known = know(row.id);
    planes_.is_shared[i] = true;
    planes_.shared[i] = known.planes;
    for (std::size_t k = 0; k < Batch::group; ++k)
      put(i * Batch::group + k, known, row.x + static_cast<std::int32_t>(k) * 256, row.y);
  }
  interpolate();
}

void PointBatcher::interpolate() {
  interpolate_.interpolate(planes_, target_.viewport, target_.spacing, batch_);
  if (!has_ends_) return;

  // Of a line the weights of the quad's corners become those of its two ends.
  for (int i = 0; i < batch_.padded(); ++i) {
    const Known& known = know(static_cast<std::int32_t>(batch_.triangle[i]));
    const Draw& d = projected_.draws[known.draw];
    if (d.ends.empty()) continue;
    const std::size_t first = 3 * static_cast<std::size_t>(known.id - known.begin);
    const auto weigh = [&](float(&b)[3][Batch::capacity]) {
      float far = 0, sum = 0;
      for (std::size_t k = 0; k < 3; ++k) far += b[k][i] * d.share[d.index[first + k]], sum += b[k][i];
      b[0][i] = sum - far, b[1][i] = far, b[2][i] = 0;
    };
    weigh(batch_.b), weigh(batch_.dbdx), weigh(batch_.dbdy);
  }
}

template <class Use>
void PointBatcher::for_batches(std::span<const Point> points, Use use) {
  order_by_material(points);
  shaded_ += points.size();
  for (std::size_t first = 0; first < points.size();) {
    const std::size_t count = same_material(points, first, Batch::capacity);
    const auto numbers = std::span<const std::uint32_t>(order_).subspan(first, count);
    fill(points, numbers);
    use(numbers);
    first += count;
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
