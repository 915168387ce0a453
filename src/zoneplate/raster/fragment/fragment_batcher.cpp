#include "zoneplate/raster/fragment/fragment_batcher.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace zoneplate {

FragmentBatcher::FragmentBatcher(const ProjectedDraws& projected, const FragmentShader& shader, const Target& target)
    : projected_(projected),
      shader_(shader),
      interpolate_(InterpolateKernels::of()),
      target_(target),
      has_ends_(std::any_of(projected.draws.begin(), projected.draws.end(),
                            [](const Draw& d) { return d.quads != nullptr; })),
      has_one_material_(std::all_of(projected.draws.begin(), projected.draws.end(),
                                    [&](const Draw& d) { return d.material == projected.draws[0].material; })) {}

/// The list's numbers, those of one material together.
template <class T>
std::span<const std::uint32_t> FragmentBatcher::order_by_material(std::span<const T> list) {
  order_.clear();
  material_.clear();
  number_up_to(list.size());
  const auto as_is = std::span<const std::uint32_t>(as_is_).first(list.size());
  if (list.empty()) return as_is;
  find_draw(list[0].id);
  one_material_ = known_.draw->material;
  if (has_one_material_) return as_is;
  std::size_t same = 1;
  while (same < list.size() && (list[same].id == list[same - 1].id || material_of(list[same].id) == one_material_))
    ++same;
  if (same == list.size()) return as_is;

  material_.resize(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) material_[i] = static_cast<std::uint32_t>(material_of(list[i].id));
  order_.assign(as_is.begin(), as_is.end());
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::uint32_t p, std::uint32_t q) { return material_[p] < material_[q]; });
  return order_;
}

template std::span<const std::uint32_t> FragmentBatcher::order_by_material(std::span<const FragmentSpan> list);

/// as_is_: so many numbers at least.
void FragmentBatcher::number_up_to(std::size_t count) {
  for (std::size_t i = as_is_.size(); i < count; ++i) as_is_.push_back(static_cast<std::uint32_t>(i));
}

/// How many numbers from `first` on share a material, `most` at most.
std::size_t FragmentBatcher::same_material(std::span<const std::uint32_t> order, std::size_t first,
                                           std::size_t most) const {
  const std::size_t limit = std::min(order.size(), first + most);
  if (material_.empty()) return limit - first;
  std::size_t last = first + 1;
  while (last < limit && material_[order[last]] == material_[order[first]]) ++last;
  return last - first;
}

void FragmentBatcher::find_draw(std::int32_t id) {
  if (id >= known_.begin && id < known_.end) return;
  known_.number = projected_.draw_of(id);
  known_.draw = &projected_.draws[known_.number];
  known_.screen = projected_.screen[known_.number].data();
  known_.begin = projected_.first_triangle[known_.number], known_.end = projected_.first_triangle[known_.number + 1];
}

int FragmentBatcher::material_of(std::int32_t id) {
  find_draw(id);
  return known_.draw->material;
}

/// Asks for the indices of a triangle that is about to be known.
void FragmentBatcher::fetch_ahead(std::int32_t id) const {
  if (id < known_.begin || id >= known_.end) return;
  __builtin_prefetch(&known_.draw->index[3 * static_cast<std::size_t>(id - known_.begin)]);
}

/// What is said of a triangle, told at point i. Its vertices, which lie anywhere in memory, are only asked for.
void FragmentBatcher::put_triangle(std::size_t i, std::int32_t id) {
  find_draw(id);
  const Draw& draw = *known_.draw;
  const auto local = static_cast<std::size_t>(id - known_.begin);
  const std::uint32_t* v = &draw.index[3 * local];
  batch_->triangle[i] = static_cast<std::uint32_t>(id);
  batch_->instance[i] = draw.instance;
  corners_.is_mirrored[i] = draw.is_mirrored ? 1 : 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (known_.screen) {
      corners_.vertex[k][i] = &known_.screen[v[k]];
      __builtin_prefetch(corners_.vertex[k][i]);
    } else {
      found_corners_[k][i] = projected_.vertex(known_.number, v[k]);
      corners_.vertex[k][i] = &found_corners_[k][i];
    }
    batch_->vertex[k][i] = draw.quads ? draw.quads->ends[local / 2 * 2 + std::min<std::size_t>(k, 1)] : v[k];
  }
}

void FragmentBatcher::fill(std::span<const Fragment> points, std::span<const std::uint32_t> numbers) {
  constexpr std::size_t ahead = 16;
  batch_->count = static_cast<int>(numbers.size());
  batch_->material = material_.empty() ? one_material_ : static_cast<int>(material_[numbers[0]]);
  batch_->one_instance = false;
  corners_.screen = nullptr;
  std::fill(std::begin(batch_->is_flat_run), std::end(batch_->is_flat_run), false);
  for (std::size_t i = 0; i < static_cast<std::size_t>(batch_->padded()); ++i) {
    if (i + ahead < numbers.size()) fetch_ahead(points[numbers[i + ahead]].id);
    const Fragment& point = points[numbers[std::min(i, numbers.size() - 1)]];
    put_triangle(i, point.id);
    batch_->x[i] = point.x, batch_->y[i] = point.y;
  }
  interpolate();
}

void FragmentBatcher::fill(std::span<const FragmentSpan> rows, std::span<const std::uint32_t> numbers) {
  batch_->count = static_cast<int>(numbers.size()) * FragmentBatch::group;
  batch_->material = material_.empty() ? one_material_ : static_cast<int>(material_[numbers[0]]);
  batch_->one_instance = false;
  corners_.screen = nullptr;
  std::fill_n(batch_->is_flat_run, numbers.size(), true);
  for (std::size_t first = 0, i = 0; first < numbers.size(); first = i) {
    const std::int32_t id = rows[numbers[first]].id;
    put_triangle(first * FragmentBatch::group, id);
    for (; i < numbers.size() && rows[numbers[i]].id == id; ++i) {
      const FragmentSpan& row = rows[numbers[i]];
      batch_->run_begin[i] = static_cast<std::uint8_t>(first);
      batch_->x[i * FragmentBatch::group] = row.x, batch_->y[i * FragmentBatch::group] = row.y;
    }
    batch_->run_end[first] = static_cast<std::uint8_t>(i);
  }
  interpolate();
}

/// True if all points of the list are of one draw of triangles, whose screen vertices are there; that is then known.
bool FragmentBatcher::are_of_one_draw(const FragmentList& list) {
  if (list.count == 0) return true;
  find_draw(list.id[0]);
  if (known_.draw->quads || !known_.screen) return false;
  if (projected_.draws.size() == 1) return true;
  const auto begin = static_cast<std::uint32_t>(known_.begin), size = static_cast<std::uint32_t>(known_.end) - begin;
  std::uint32_t others = 0;
  for (int i = 0; i < list.count; ++i) others += static_cast<std::uint32_t>(list.id[i]) - begin >= size ? 1 : 0;
  return others == 0;
}

/// Finds the vertices of the batch that begins at point `first` of the list, whose draw is known. They lie anywhere in
/// memory, as their indices do: both are asked for about a batch before they are needed.
void FragmentBatcher::find_vertices(const FragmentList& list, std::size_t first) {
  constexpr std::size_t ahead = 160;
  const Draw& draw = *known_.draw;
  if (first == 0) vertex_memory_ = shader_.vertex_memory(draw.instance, draw.material);
  const std::uint32_t* const index = draw.index.data() - 3 * static_cast<std::size_t>(known_.begin);
  const auto ask_for_index = [&](std::size_t i) { __builtin_prefetch(index + 3 * std::ptrdiff_t{list.id[i]}); };
  const ScreenVertex* const screen = known_.screen;
  const auto [memory, stride] = vertex_memory_;
  const auto total = static_cast<std::size_t>(list.count);
  if (first == 0)
    for (std::size_t i = 0; i < std::min(ahead, total); ++i) ask_for_index(i);
  const std::size_t count = std::min<std::size_t>(FragmentBatch::capacity, total - first);
  const std::int32_t* const id = list.id + first;
  std::uint32_t *const v0 = next_->vertex[0], *const v1 = next_->vertex[1], *const v2 = next_->vertex[2];
  for (std::size_t i = 0; i < count; ++i) {
    // Neighbours mostly lie near each other; to ask for every second one's indices is enough.
    if (i % 2 == 0 && first + i + ahead < total) ask_for_index(first + i + ahead);
    const std::uint32_t* const v = index + 3 * std::ptrdiff_t{id[i]};
    v0[i] = v[0], v1[i] = v[1], v2[i] = v[2];
    // The second vertex mostly lies beside one of the others.
    for (const std::uint32_t vertex : {v0[i], v2[i]}) {
      __builtin_prefetch(screen + vertex);
      __builtin_prefetch(memory + vertex * stride);
    }
  }
}

/// Points of the draw that is known, whose vertices are found. Finds those of the next batch.
void FragmentBatcher::fill(const FragmentList& list, std::size_t first, std::size_t count) {
  const Draw& draw = *known_.draw;
  std::swap(batch_, next_);
  batch_->count = static_cast<int>(count);
  batch_->material = draw.material;
  batch_->one_instance = true;
  corners_.screen = known_.screen;
  const auto padded = static_cast<std::size_t>(batch_->padded());
  std::fill_n(batch_->is_flat_run, padded / FragmentBatch::group, false);
  // As many as are known when this is compiled: that is done in vectors.
  std::fill_n(batch_->instance, FragmentBatch::capacity, draw.instance);
  std::fill_n(corners_.is_mirrored, FragmentBatch::capacity, draw.is_mirrored ? 1 : 0);
  const auto copy = [&](const auto* from, auto* to) {
    std::memcpy(to, from, count * sizeof(*to));
    std::fill(to + count, to + padded, to[count - 1]);
  };
  copy(list.x + first, batch_->x);
  copy(list.y + first, batch_->y);
  copy(list.id + first, batch_->triangle);
  for (std::uint32_t(&v)[FragmentBatch::padded_capacity] : batch_->vertex)
    std::fill(v + count, v + padded, v[count - 1]);
  if (first + count < static_cast<std::size_t>(list.count)) find_vertices(list, first + count);
  interpolate();
}

template <class Use>
void FragmentBatcher::for_batches(std::span<const Fragment> points, Use use) {
  const auto order = order_by_material(points);
  for (std::size_t first = 0; first < points.size();) {
    const std::size_t count = same_material(order, first, FragmentBatch::capacity);
    const auto numbers = order.subspan(first, count);
    fill(points, numbers);
    use(numbers);
    first += count;
  }
}

/// Points of several draws, through batches by material: fills unmixed_.
void FragmentBatcher::shade_mixed(const FragmentList& list) {
  const auto total = static_cast<std::size_t>(list.count);
  mixed_.clear();
  for (std::size_t i = 0; i < total; ++i) mixed_.push_back({list.x[i], list.y[i], list.id[i], 0, 0});
  unmixed_.resize((total + FragmentBatch::capacity - 1) / FragmentBatch::capacity);
  for_batches(mixed_, [&](std::span<const std::uint32_t> numbers) {
    shader_.shade(*batch_, {}, shaded_batch_);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      FragmentOutputs& to = unmixed_[numbers[i] / FragmentBatch::capacity];
      const std::size_t at = numbers[i] % FragmentBatch::capacity;
      to.r[at] = shaded_batch_.r[i], to.g[at] = shaded_batch_.g[i];
      to.b[at] = shaded_batch_.b[i], to.a[at] = shaded_batch_.a[i];
    }
  });
}

void FragmentBatcher::interpolate() {
  const float spacing = shader_.needs_derivatives(batch_->material) ? target_.spacing : 0.0f;
  std::uint32_t clipped = interpolate_.interpolate(corners_, target_.viewport, spacing, *batch_);
  while (clipped) {
    const int group = std::countr_zero(clipped);
    int last = group + 1;
    if (batch_->is_flat_run[group]) {
      last = interpolate_clipped_rows(group, spacing);
    } else {
      interpolate_clipped(static_cast<std::size_t>(group), spacing);
    }
    clipped &= last == 32 ? 0 : ~0u << last;
  }
  if (has_ends_) weigh_ends();
}

/// Finds the planes of a triangle that needs clipping.
const TriangleFacing& FragmentBatcher::know_clipped(std::int32_t id) {
  if (id != known_clipped_.id) {
    find_draw(id);
    known_clipped_ = {id, face_of(projected_, known_.number, id, target_.viewport)};
  }
  return known_clipped_.facing;
}

void FragmentBatcher::put_planes(std::size_t i, const BarycentricPlanes& planes) {
  for (std::size_t k = 0; k < 3; ++k)
    clipped_.x[k][i] = planes.x[k], clipped_.y[k][i] = planes.y[k], clipped_.one[k][i] = planes.one[k];
}

std::int32_t FragmentBatcher::is_front(std::size_t leader, const TriangleFacing& facing) const {
  return facing.is_clockwise == (corners_.is_mirrored[leader] != 0) ? 1 : 0;
}

/// The points of the rows from a group on of one triangle, which needs clipping. Gives the group after them.
int FragmentBatcher::interpolate_clipped_rows(int group, float spacing) {
  const int last = batch_->run_end[group];
  const std::size_t leader = batch_->leader(static_cast<std::size_t>(group) * FragmentBatch::group);
  const TriangleFacing& facing = know_clipped(static_cast<std::int32_t>(batch_->triangle[leader]));
  batch_->is_front[leader] = is_front(leader, facing);
  interpolate_.interpolate_clipped_rows(facing.planes, target_.viewport, spacing, *batch_, group * FragmentBatch::group,
                                        last * FragmentBatch::group);
  return last;
}

/// Does those of the group's points again whose triangles need clipping.
void FragmentBatcher::interpolate_clipped(std::size_t group, float spacing) {
  const std::size_t first = group * FragmentBatch::group;
  bool is_clipped[FragmentBatch::group] = {};
  for (std::size_t i = 0; i < FragmentBatch::group; ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      is_clipped[i] = is_clipped[i] || corners_.of(k, first + i, *batch_).needs_clipping();
    if (!is_clipped[i]) continue;
    const TriangleFacing& facing = know_clipped(static_cast<std::int32_t>(batch_->triangle[first + i]));
    put_planes(i, facing.planes);
    batch_->is_front[first + i] = is_front(first + i, facing);
  }
  std::copy_n(batch_->x + first, FragmentBatch::group, clipped_.px);
  std::copy_n(batch_->y + first, FragmentBatch::group, clipped_.py);
  interpolate_.interpolate_clipped(target_.viewport, spacing, clipped_);
  for (std::size_t k = 0; k < 2; ++k)
    for (std::size_t i = 0; i < FragmentBatch::group; ++i) {
      if (!is_clipped[i]) continue;
      batch_->b[k][first + i] = clipped_.b[k][i];
      batch_->dbdx[k][first + i] = clipped_.dbdx[k][i], batch_->dbdy[k][first + i] = clipped_.dbdy[k][i];
    }
}

/// Of a line the weights of the quad's corners become those of its two ends.
void FragmentBatcher::weigh_ends() {
  for (std::size_t i = 0; i < static_cast<std::size_t>(batch_->padded()); ++i) {
    const auto id = static_cast<std::int32_t>(batch_->triangle[batch_->leader(i)]);
    find_draw(id);
    const Draw& d = *known_.draw;
    if (!d.quads) continue;
    const std::uint32_t* v = &d.index[3 * static_cast<std::size_t>(id - known_.begin)];
    const Quad quad = make_quad(*d.quads, v[0] / 4, d.clip_from_object);
    const float share[3] = {quad.share[v[0] % 4], quad.share[v[1] % 4], quad.share[v[2] % 4]};
    const auto weigh = [&](float(&b)[2][FragmentBatch::padded_capacity], float whole) {
      const float first = whole - b[0][i] - b[1][i];
      b[0][i] = (first * share[0] + b[0][i] * share[1]) + b[1][i] * share[2];
      b[1][i] = 0;
    };
    weigh(batch_->b, 1), weigh(batch_->dbdx, 0), weigh(batch_->dbdy, 0);
  }
}

void FragmentBatcher::shade(std::span<const Fragment> fragments, std::vector<Linear>& colors, FragmentData* data) {
  shade_outputs(fragments, &colors, data);
}

void FragmentBatcher::shade_data(std::span<const Fragment> fragments, FragmentData& data) {
  shade_outputs(fragments, nullptr, &data);
}

void FragmentBatcher::shade_outputs(std::span<const Fragment> fragments, std::vector<Linear>* colors,
                                    FragmentData* data) {
  (colors ? shaded_ : evaluated_) += fragments.size();
  const OutputMask outputs{.color = colors != nullptr,
                           .normal = data && target_.normal,
                           .uv = data && target_.uv,
                           .albedo = data && target_.albedo};
  if (outputs.color) colors->resize(fragments.size());
  if (outputs.normal) data->normal.resize(fragments.size());
  if (outputs.uv) data->uv.resize(fragments.size());
  if (outputs.albedo) data->albedo.resize(fragments.size());
  for_batches(fragments, [&](std::span<const std::uint32_t> numbers) {
    shader_.shade(*batch_, outputs, shaded_batch_);
    const FragmentOutputs& s = shaded_batch_;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const std::uint32_t at = numbers[i];
      if (outputs.color) (*colors)[at] = {s.r[i], s.g[i], s.b[i], s.a[i]};
      if (outputs.normal) data->normal[at] = {s.normal[0][i], s.normal[1][i], s.normal[2][i]};
      if (outputs.uv) data->uv[at] = {s.uv[0][i], s.uv[1][i]};
      if (outputs.albedo) data->albedo[at] = {s.albedo[0][i], s.albedo[1][i], s.albedo[2][i]};
    }
  });
}

void FragmentBatcher::test_alpha(std::span<const Fragment> points, std::vector<std::uint8_t>& is_there) {
  shaded_ += points.size();
  is_there.resize(points.size());
  for_batches(points, [&](std::span<const std::uint32_t> numbers) {
    alignas(64) float alpha[FragmentBatch::padded_capacity];
    const float cutoff = shader_.alpha(*batch_, alpha);
    for (std::size_t i = 0; i < numbers.size(); ++i) is_there[numbers[i]] = alpha[i] >= cutoff;
  });
}

void FragmentBatcher::find_alpha_margins(std::span<const Fragment> points, std::vector<float>& margins) {
  shaded_ += points.size();
  margins.resize(points.size());
  for_batches(points, [&](std::span<const std::uint32_t> numbers) {
    alignas(64) float alpha[FragmentBatch::padded_capacity];
    const float cutoff = shader_.alpha(*batch_, alpha);
    for (std::size_t i = 0; i < numbers.size(); ++i) margins[numbers[i]] = alpha[i] - cutoff;
  });
}

}  // namespace zoneplate
