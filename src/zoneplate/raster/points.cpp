#include "zoneplate/raster/points.h"

#include <algorithm>
#include <bit>
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
  known_.number = projected_.draw_of(id);
  known_.draw = &projected_.draws[known_.number];
  known_.screen = projected_.screen[known_.number].data();
  known_.begin = projected_.first_triangle[known_.number], known_.end = projected_.first_triangle[known_.number + 1];
}

/// Asks for the indices of a triangle that is about to be known.
void PointBatcher::fetch_ahead(std::int32_t id) const {
  if (id < known_.begin || id >= known_.end) return;
  __builtin_prefetch(&known_.draw->index[3 * static_cast<std::size_t>(id - known_.begin)]);
}

/// What is said of a triangle, told at point i. Its vertices, which lie anywhere in memory, are only asked for.
void PointBatcher::put_triangle(std::size_t i, std::int32_t id) {
  find_draw(id);
  const Draw& draw = *known_.draw;
  const auto local = static_cast<std::size_t>(id - known_.begin);
  const std::uint32_t* v = &draw.index[3 * local];
  batch_.triangle[i] = static_cast<std::uint32_t>(id);
  batch_.instance[i] = draw.instance;
  corners_.is_mirrored[i] = draw.is_mirrored ? 1 : 0;
  for (std::size_t k = 0; k < 3; ++k) {
    corners_.vertex[k][i] = &known_.screen[v[k]];
    __builtin_prefetch(corners_.vertex[k][i]);
    batch_.vertex[k][i] = draw.ends.empty() ? v[k] : draw.ends[local / 2 * 2 + std::min<std::size_t>(k, 1)];
  }
}

void PointBatcher::copy_triangle(std::size_t from, std::size_t to) {
  batch_.triangle[to] = batch_.triangle[from];
  batch_.instance[to] = batch_.instance[from];
  corners_.is_mirrored[to] = corners_.is_mirrored[from];
  for (std::size_t k = 0; k < 3; ++k) {
    corners_.vertex[k][to] = corners_.vertex[k][from];
    batch_.vertex[k][to] = batch_.vertex[k][from];
  }
}

void PointBatcher::fill(std::span<const Point> points, std::span<const std::uint32_t> numbers) {
  constexpr std::size_t ahead = 16;
  batch_.count = static_cast<int>(numbers.size());
  batch_.material = static_cast<int>(material_[numbers[0]]);
  batch_.one_instance = false;
  corners_.screen = nullptr;
  std::fill(std::begin(batch_.one_triangle), std::end(batch_.one_triangle), false);
  for (std::size_t i = 0; i < static_cast<std::size_t>(batch_.padded()); ++i) {
    if (i + ahead < numbers.size()) fetch_ahead(points[numbers[i + ahead]].id);
    const Point& point = points[numbers[std::min(i, numbers.size() - 1)]];
    put_triangle(i, point.id);
    batch_.x[i] = point.x, batch_.y[i] = point.y;
  }
  interpolate();
}

void PointBatcher::fill(std::span<const PointRow> rows, std::span<const std::uint32_t> numbers) {
  batch_.count = static_cast<int>(numbers.size()) * Batch::group;
  batch_.material = static_cast<int>(material_[numbers[0]]);
  batch_.one_instance = false;
  corners_.screen = nullptr;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const PointRow& row = rows[numbers[i]];
    batch_.one_triangle[i] = true;
    if (i > 0 && row.id == rows[numbers[i - 1]].id) {
      copy_triangle((i - 1) * Batch::group, i * Batch::group);
    } else {
      put_triangle(i * Batch::group, row.id);
    }
    std::int32_t* const x = batch_.x + i * Batch::group;
    std::int32_t* const y = batch_.y + i * Batch::group;
    for (int k = 0; k < Batch::group; ++k) x[k] = row.x + k * 256, y[k] = row.y;
  }
  interpolate();
}

/// True if all points of the list are of one draw of triangles; that is then known.
bool PointBatcher::are_of_one_draw(const PointList& list) {
  if (list.count == 0) return true;
  find_draw(list.id[0]);
  if (!known_.draw->ends.empty()) return false;
  if (projected_.draws.size() == 1) return true;
  const auto begin = static_cast<std::uint32_t>(known_.begin), size = static_cast<std::uint32_t>(known_.end) - begin;
  std::uint32_t others = 0;
  for (int i = 0; i < list.count; ++i) others += static_cast<std::uint32_t>(list.id[i]) - begin >= size ? 1 : 0;
  return others == 0;
}

/// Points of the draw that is known. Indices and vertices, which lie anywhere in memory, are asked for before they are
/// needed.
void PointBatcher::fill(const PointList& list, std::size_t first, std::size_t count) {
  constexpr std::size_t ahead = 32;
  const Draw& draw = *known_.draw;
  batch_.count = static_cast<int>(count);
  batch_.material = draw.material;
  batch_.one_instance = true;
  corners_.screen = known_.screen;
  const auto padded = static_cast<std::size_t>(batch_.padded());
  std::fill_n(batch_.one_triangle, padded / Batch::group, false);
  std::fill_n(batch_.instance, padded, draw.instance);
  std::fill_n(corners_.is_mirrored, padded, draw.is_mirrored ? 1 : 0);
  std::copy_n(list.x + first, count, batch_.x);
  std::copy_n(list.y + first, count, batch_.y);
  std::copy_n(list.id + first, count, reinterpret_cast<std::int32_t*>(batch_.triangle));
  for (std::size_t i = count; i < padded; ++i) {
    batch_.x[i] = batch_.x[count - 1], batch_.y[i] = batch_.y[count - 1];
    batch_.triangle[i] = batch_.triangle[count - 1];
  }
  const std::uint32_t* const index = draw.index.data() - 3 * static_cast<std::size_t>(known_.begin);
  const auto total = static_cast<std::size_t>(list.count);
  if (first == 0)
    for (std::size_t i = 0; i < std::min(ahead, total); ++i) __builtin_prefetch(index + 3 * std::ptrdiff_t{list.id[i]});
  for (std::size_t i = 0; i < padded; ++i) {
    // Neighbours mostly lie near each other; to ask for every second one's indices is enough.
    if (i % 2 == 0 && first + i + ahead < total)
      __builtin_prefetch(index + 3 * std::ptrdiff_t{list.id[first + i + ahead]});
    const std::uint32_t* const v = index + 3 * std::size_t{batch_.triangle[i]};
    for (std::size_t k = 0; k < 3; ++k) {
      batch_.vertex[k][i] = v[k];
      __builtin_prefetch(&known_.screen[v[k]]);
    }
  }
  interpolate();
}

template <class Use>
void PointBatcher::for_batches(std::span<const Point> points, Use use) {
  order_by_material(points);
  for (std::size_t first = 0; first < points.size();) {
    const std::size_t count = same_material(points, first, Batch::capacity);
    const auto numbers = std::span<const std::uint32_t>(order_).subspan(first, count);
    fill(points, numbers);
    use(numbers);
    first += count;
  }
}

/// Points of several draws, through batches by material: fills unmixed_.
void PointBatcher::shade_mixed(const PointList& list) {
  const auto total = static_cast<std::size_t>(list.count);
  mixed_.clear();
  for (std::size_t i = 0; i < total; ++i) mixed_.push_back({list.x[i], list.y[i], list.id[i], 0, 0});
  unmixed_.resize((total + Batch::capacity - 1) / Batch::capacity);
  for_batches(mixed_, [&](std::span<const std::uint32_t> numbers) {
    shader_.shade(batch_, {}, shaded_batch_);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      Shaded& to = unmixed_[numbers[i] / Batch::capacity];
      const std::size_t at = numbers[i] % Batch::capacity;
      to.r[at] = shaded_batch_.r[i], to.g[at] = shaded_batch_.g[i];
      to.b[at] = shaded_batch_.b[i], to.a[at] = shaded_batch_.a[i];
    }
  });
}

void PointBatcher::interpolate() {
  const float spacing = shader_.wants_slopes(batch_.material) ? target_.spacing : 0.0f;
  std::uint32_t clipped = interpolate_.interpolate(corners_, target_.viewport, spacing, batch_);
  for (; clipped; clipped &= clipped - 1)
    interpolate_clipped(static_cast<std::size_t>(std::countr_zero(clipped)), spacing);
  if (has_ends_) weigh_ends();
}

/// Finds the planes of a triangle that needs clipping.
const TriangleFacing& PointBatcher::know_clipped(std::int32_t id) {
  if (id != known_clipped_.id) {
    find_draw(id);
    known_clipped_ = {id, face_of(projected_, known_.number, id, target_.viewport)};
  }
  return known_clipped_.facing;
}

void PointBatcher::put_planes(std::size_t i, const BarycentricPlanes& planes) {
  for (std::size_t k = 0; k < 3; ++k)
    clipped_.x[k][i] = planes.x[k], clipped_.y[k][i] = planes.y[k], clipped_.one[k][i] = planes.one[k];
}

/// Does those of the group's points again whose triangles need clipping.
void PointBatcher::interpolate_clipped(std::size_t group, float spacing) {
  const std::size_t first = group * Batch::group;
  bool is_clipped[Batch::group] = {};
  const auto is_front = [&](std::size_t told, const TriangleFacing& facing) {
    return facing.is_clockwise == (corners_.is_mirrored[told] != 0) ? 1 : 0;
  };
  if (batch_.one_triangle[group]) {
    // Rows of one triangle mostly follow each other; then its planes are there already.
    const auto id = static_cast<std::int32_t>(batch_.triangle[first]);
    const TriangleFacing& facing = know_clipped(id);
    if (clipped_row_ != id)
      for (std::size_t i = 0; i < Batch::group; ++i) put_planes(i, facing.planes);
    clipped_row_ = id;
    batch_.is_front[first] = is_front(first, facing);
    std::fill(std::begin(is_clipped), std::end(is_clipped), true);
  } else {
    clipped_row_ = -1;
    for (std::size_t i = 0; i < Batch::group; ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        is_clipped[i] = is_clipped[i] || corners_.of(k, first + i, batch_).needs_clipping();
      if (!is_clipped[i]) continue;
      const TriangleFacing& facing = know_clipped(static_cast<std::int32_t>(batch_.triangle[first + i]));
      put_planes(i, facing.planes);
      batch_.is_front[first + i] = is_front(first + i, facing);
    }
  }
  std::copy_n(batch_.x + first, Batch::group, clipped_.px);
  std::copy_n(batch_.y + first, Batch::group, clipped_.py);
  interpolate_.interpolate_clipped(target_.viewport, spacing, clipped_);
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t i = 0; i < Batch::group; ++i) {
      if (!is_clipped[i]) continue;
      batch_.b[k][first + i] = clipped_.b[k][i];
      batch_.dbdx[k][first + i] = clipped_.dbdx[k][i], batch_.dbdy[k][first + i] = clipped_.dbdy[k][i];
    }
}

/// Of a line the weights of the quad's corners become those of its two ends.
void PointBatcher::weigh_ends() {
  for (std::size_t i = 0; i < static_cast<std::size_t>(batch_.padded()); ++i) {
    const auto id = static_cast<std::int32_t>(batch_.triangle[batch_.told(i)]);
    find_draw(id);
    const Draw& d = *known_.draw;
    if (d.ends.empty()) continue;
    const std::uint32_t* v = &d.index[3 * static_cast<std::size_t>(id - known_.begin)];
    const float share[3] = {d.share[v[0]], d.share[v[1]], d.share[v[2]]};
    const auto weigh = [&](float(&b)[2][Batch::capacity], float whole) {
      const float first = whole - b[0][i] - b[1][i];
      b[0][i] = (first * share[0] + b[0][i] * share[1]) + b[1][i] * share[2];
      b[1][i] = 0;
    };
    weigh(batch_.b, 1), weigh(batch_.dbdx, 0), weigh(batch_.dbdy, 0);
  }
}

void PointBatcher::shade(std::span<const Point> points, std::vector<Linear>& colors, PointData* data) {
  shaded_ += points.size();
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
  shaded_ += points.size();
  is_there.resize(points.size());
  for_batches(points, [&](std::span<const std::uint32_t> numbers) {
    alignas(64) float alpha[Batch::capacity];
    const float cutoff = shader_.alpha(batch_, alpha);
    for (std::size_t i = 0; i < numbers.size(); ++i) is_there[numbers[i]] = alpha[i] >= cutoff;
  });
}

}  // namespace zoneplate
