// SPDX-License-Identifier: Apache-2.0
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
      has_segments_(std::any_of(projected.draws.begin(), projected.draws.end(),
                                [](const Draw& d) { return d.quads != nullptr; })),
      has_one_material_(std::all_of(projected.draws.begin(), projected.draws.end(),
                                    [&](const Draw& d) { return d.material == projected.draws[0].material; })),
      needs_coverage_(shader.needs_coverage()) {}

/// The indices of the list, sorted by material.
template <class T>
std::span<const std::uint32_t> FragmentBatcher::order_by_material(std::span<const T> list) {
  order_.clear();
  material_.clear();
  number_up_to(list.size());
  const auto as_is = std::span<const std::uint32_t>(identity_order_).first(list.size());
  if (list.empty()) return as_is;
  select_draw(list[0].id);
  one_material_ = current_.draw->material;
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

/// Extends identity_order_ to at least `count` elements.
void FragmentBatcher::number_up_to(std::size_t count) {
  for (std::size_t i = identity_order_.size(); i < count; ++i) identity_order_.push_back(static_cast<std::uint32_t>(i));
}

/// The number of elements from `first` on that share a material, at most `most`.
std::size_t FragmentBatcher::same_material(std::span<const std::uint32_t> order, std::size_t first,
                                           std::size_t most) const {
  const std::size_t limit = std::min(order.size(), first + most);
  if (material_.empty()) return limit - first;
  std::size_t last = first + 1;
  while (last < limit && material_[order[last]] == material_[order[first]]) ++last;
  return last - first;
}

void FragmentBatcher::select_draw(std::int32_t id) {
  if (id >= current_.begin && id < current_.end) return;
  current_.number = projected_.draw_of(id);
  current_.draw = &projected_.draws[current_.number];
  current_.screen = projected_.screen[current_.number].data();
  current_.begin = projected_.first_triangle[current_.number],
  current_.end = projected_.first_triangle[current_.number + 1];
}

int FragmentBatcher::material_of(std::int32_t id) {
  select_draw(id);
  return current_.draw->material;
}

/// Prefetches the indices of a triangle of the current draw.
void FragmentBatcher::prefetch_triangle(std::int32_t id) const {
  if (id < current_.begin || id >= current_.end) return;
  __builtin_prefetch(&current_.draw->index[3 * static_cast<std::size_t>(id - current_.begin)]);
}

/// FragmentBatch::coverage of a fragment with this set of a pixel's samples.
float FragmentBatcher::coverage_of(std::uint64_t samples) const {
  if (samples == 0) return 1;
  return static_cast<float>(std::popcount(samples)) / static_cast<float>(target_.samples.size());
}

/// Stores the values of a triangle at entry i of the batch. Its vertices, a random access, are only prefetched.
void FragmentBatcher::store_triangle(std::size_t i, std::int32_t id) {
  select_draw(id);
  const Draw& draw = *current_.draw;
  const auto local = static_cast<std::size_t>(id - current_.begin);
  const std::uint32_t* v = &draw.index[3 * local];
  batch_->triangle[i] = static_cast<std::uint32_t>(id);
  batch_->instance[i] = draw.instance;
  triangles_.is_mirrored[i] = draw.is_mirrored ? 1 : 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (current_.screen) {
      triangles_.vertex[k][i] = &current_.screen[v[k]];
      __builtin_prefetch(triangles_.vertex[k][i]);
    } else {
      computed_vertices_[k][i] = projected_.vertex(current_.number, v[k]);
      triangles_.vertex[k][i] = &computed_vertices_[k][i];
    }
    batch_->vertex[k][i] =
        draw.quads ? draw.quads->segment_vertices[local / 2 * 2 + std::min<std::size_t>(k, 1)] : v[k];
  }
}

void FragmentBatcher::fill(std::span<const Fragment> fragments, std::span<const std::uint32_t> numbers) {
  constexpr std::size_t ahead = 16;
  batch_->count = static_cast<int>(numbers.size());
  batch_->material = material_.empty() ? one_material_ : static_cast<int>(material_[numbers[0]]);
  batch_->one_instance = false;
  triangles_.screen = nullptr;
  std::fill(std::begin(batch_->is_flat_run), std::end(batch_->is_flat_run), false);
  for (std::size_t i = 0; i < static_cast<std::size_t>(batch_->padded()); ++i) {
    if (i + ahead < numbers.size()) prefetch_triangle(fragments[numbers[i + ahead]].id);
    const Fragment& point = fragments[numbers[std::min(i, numbers.size() - 1)]];
    store_triangle(i, point.id);
    batch_->x[i] = point.x, batch_->y[i] = point.y;
    if (needs_coverage_) batch_->coverage[i] = coverage_of(point.samples);
  }
  interpolate();
}

void FragmentBatcher::fill(std::span<const FragmentSpan> rows, std::span<const std::uint32_t> numbers) {
  batch_->count = static_cast<int>(numbers.size()) * FragmentBatch::group;
  batch_->material = material_.empty() ? one_material_ : static_cast<int>(material_[numbers[0]]);
  batch_->one_instance = false;
  triangles_.screen = nullptr;
  std::fill_n(batch_->is_flat_run, numbers.size(), true);
  for (std::size_t first = 0, i = 0; first < numbers.size(); first = i) {
    const std::int32_t id = rows[numbers[first]].id;
    store_triangle(first * FragmentBatch::group, id);
    for (; i < numbers.size() && rows[numbers[i]].id == id; ++i) {
      const FragmentSpan& row = rows[numbers[i]];
      batch_->run_begin[i] = static_cast<std::uint8_t>(first);
      batch_->x[i * FragmentBatch::group] = row.x, batch_->y[i * FragmentBatch::group] = row.y;
    }
    batch_->run_end[first] = static_cast<std::uint8_t>(i);
  }
  if (needs_coverage_) std::fill_n(batch_->coverage, batch_->count, target_.is_per_sample ? coverage_of(1) : 1.0f);
  interpolate();
}

/// True if all fragments of the list belong to one draw of triangles whose screen vertices are stored; it becomes the
/// current draw.
bool FragmentBatcher::are_of_one_draw(const FragmentList& list) {
  if (list.count == 0) return true;
  select_draw(list.id[0]);
  if (current_.draw->quads || !current_.screen) return false;
  if (projected_.draws.size() == 1) return true;
  const auto begin = static_cast<std::uint32_t>(current_.begin),
             size = static_cast<std::uint32_t>(current_.end) - begin;
  std::uint32_t others = 0;
  for (int i = 0; i < list.count; ++i) others += static_cast<std::uint32_t>(list.id[i]) - begin >= size ? 1 : 0;
  return others == 0;
}

/// Finds the vertices of the batch that begins at fragment `first` of a list of the current draw. Vertices and indices
/// are random accesses: both are prefetched about a batch ahead.
void FragmentBatcher::fetch_vertices(const FragmentList& list, std::size_t first) {
  constexpr std::size_t ahead = 160;
  const Draw& draw = *current_.draw;
  if (first == 0) vertex_memory_ = shader_.vertex_memory(draw.instance, draw.material);
  const std::uint32_t* const index = draw.index.data() - 3 * static_cast<std::size_t>(current_.begin);
  const auto prefetch_index = [&](std::size_t i) { __builtin_prefetch(index + 3 * std::ptrdiff_t{list.id[i]}); };
  const ScreenVertex* const screen = current_.screen;
  const auto [memory, stride] = vertex_memory_;
  const auto total = static_cast<std::size_t>(list.count);
  if (first == 0)
    for (std::size_t i = 0; i < std::min(ahead, total); ++i) prefetch_index(i);
  const std::size_t count = std::min<std::size_t>(FragmentBatch::capacity, total - first);
  const std::int32_t* const id = list.id + first;
  std::uint32_t *const v0 = next_->vertex[0], *const v1 = next_->vertex[1], *const v2 = next_->vertex[2];
  for (std::size_t i = 0; i < count; ++i) {
    // Neighbours mostly lie close to each other, so that prefetching every second one's indices suffices.
    if (i % 2 == 0 && first + i + ahead < total) prefetch_index(first + i + ahead);
    const std::uint32_t* const v = index + 3 * std::ptrdiff_t{id[i]};
    v0[i] = v[0], v1[i] = v[1], v2[i] = v[2];
    // The second vertex mostly shares a cache line with one of the others.
    for (const std::uint32_t vertex : {v0[i], v2[i]}) {
      __builtin_prefetch(screen + vertex);
      __builtin_prefetch(memory + vertex * stride);
    }
  }
}

/// Fills the batch with fragments of the current draw, whose vertices are found, and finds those of the next batch.
void FragmentBatcher::fill(const FragmentList& list, std::size_t first, std::size_t count) {
  const Draw& draw = *current_.draw;
  std::swap(batch_, next_);
  batch_->count = static_cast<int>(count);
  batch_->material = draw.material;
  batch_->one_instance = true;
  triangles_.screen = current_.screen;
  const auto padded = static_cast<std::size_t>(batch_->padded());
  std::fill_n(batch_->is_flat_run, padded / FragmentBatch::group, false);
  // A full batch has a constant count, so that the compiler vectorizes the copies.
  std::fill_n(batch_->instance, FragmentBatch::capacity, draw.instance);
  std::fill_n(triangles_.is_mirrored, FragmentBatch::capacity, draw.is_mirrored ? 1 : 0);
  const auto copy = [&](const auto* from, auto* to) {
    std::memcpy(to, from, count * sizeof(*to));
    std::fill(to + count, to + padded, to[count - 1]);
  };
  copy(list.x + first, batch_->x);
  copy(list.y + first, batch_->y);
  copy(list.id + first, batch_->triangle);
  for (std::uint32_t(&v)[FragmentBatch::padded_capacity] : batch_->vertex)
    std::fill(v + count, v + padded, v[count - 1]);
  for (std::size_t i = 0; needs_coverage_ && i < padded; ++i)
    batch_->coverage[i] = coverage_of(FragmentList::samples(list.at[first + std::min(i, count - 1)]));
  if (first + count < static_cast<std::size_t>(list.count)) fetch_vertices(list, first + count);
  interpolate();
}

template <class Use>
void FragmentBatcher::for_batches(std::span<const Fragment> fragments, Use use) {
  const auto order = order_by_material(fragments);
  for (std::size_t first = 0; first < fragments.size();) {
    const std::size_t count = same_material(order, first, FragmentBatch::capacity);
    const auto numbers = order.subspan(first, count);
    fill(fragments, numbers);
    use(numbers);
    first += count;
  }
}

/// Shades fragments of several draws in batches by material: fills unmixed_.
void FragmentBatcher::shade_mixed(const FragmentList& list) {
  const auto total = static_cast<std::size_t>(list.count);
  mixed_.clear();
  for (std::size_t i = 0; i < total; ++i)
    mixed_.push_back({list.x[i], list.y[i], list.id[i], 0, FragmentList::samples(list.at[i])});
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
  std::uint32_t clipped = interpolate_.interpolate(triangles_, target_.viewport, spacing, *batch_);
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
  if (has_segments_) weigh_segment_vertices();
}

/// Finds the planes of a triangle that needs clipping.
const TriangleFacing& FragmentBatcher::clipped_facing(std::int32_t id) {
  if (id != current_clipped_.id) {
    select_draw(id);
    current_clipped_ = {id, face_of(projected_, current_.number, id, target_.viewport)};
  }
  return current_clipped_.facing;
}

void FragmentBatcher::store_planes(std::size_t i, const BarycentricPlanes& planes) {
  for (std::size_t k = 0; k < 3; ++k)
    clipped_.x[k][i] = planes.x[k], clipped_.y[k][i] = planes.y[k], clipped_.one[k][i] = planes.one[k];
}

std::int32_t FragmentBatcher::is_front(std::size_t leader, const TriangleFacing& facing) const {
  return facing.is_clockwise == (triangles_.is_mirrored[leader] != 0) ? 1 : 0;
}

/// Interpolates the run that begins at a group, of one triangle that needs clipping. Returns the group after the run.
int FragmentBatcher::interpolate_clipped_rows(int group, float spacing) {
  const int last = batch_->run_end[group];
  const std::size_t leader = batch_->leader(static_cast<std::size_t>(group) * FragmentBatch::group);
  const TriangleFacing& facing = clipped_facing(static_cast<std::int32_t>(batch_->triangle[leader]));
  batch_->is_front[leader] = is_front(leader, facing);
  interpolate_.interpolate_clipped_rows(facing.planes, target_.viewport, spacing, *batch_, group * FragmentBatch::group,
                                        last * FragmentBatch::group);
  return last;
}

/// Interpolates again the fragments of the group whose triangles need clipping.
void FragmentBatcher::interpolate_clipped(std::size_t group, float spacing) {
  const std::size_t first = group * FragmentBatch::group;
  bool is_clipped[FragmentBatch::group] = {};
  for (std::size_t i = 0; i < FragmentBatch::group; ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      is_clipped[i] = is_clipped[i] || triangles_.of(k, first + i, *batch_).needs_clipping();
    if (!is_clipped[i]) continue;
    const TriangleFacing& facing = clipped_facing(static_cast<std::int32_t>(batch_->triangle[first + i]));
    store_planes(i, facing.planes);
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

/// Converts the weights of a line's quad to weights of the segment's two vertices.
void FragmentBatcher::weigh_segment_vertices() {
  for (std::size_t i = 0; i < static_cast<std::size_t>(batch_->padded()); ++i) {
    const auto id = static_cast<std::int32_t>(batch_->triangle[batch_->leader(i)]);
    select_draw(id);
    const Draw& d = *current_.draw;
    if (!d.quads) continue;
    const std::uint32_t* v = &d.index[3 * static_cast<std::size_t>(id - current_.begin)];
    const Quad quad = make_quad(*d.quads, v[0] / 4, d.clip_from_object);
    const float t[3] = {quad.segment_t[v[0] % 4], quad.segment_t[v[1] % 4], quad.segment_t[v[2] % 4]};
    const auto weigh = [&](float(&b)[2][FragmentBatch::padded_capacity], float whole) {
      const float first = whole - b[0][i] - b[1][i];
      b[0][i] = (first * t[0] + b[0][i] * t[1]) + b[1][i] * t[2];
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
                           .albedo = data && target_.albedo,
                           .footprint = data && target_.stores_footprint()};
  if (outputs.color) colors->resize(fragments.size());
  if (outputs.normal) data->normal.resize(fragments.size());
  if (outputs.uv) data->uv.resize(fragments.size());
  if (outputs.albedo) data->albedo.resize(fragments.size());
  if (outputs.footprint) data->footprint.resize(fragments.size());
  for_batches(fragments, [&](std::span<const std::uint32_t> numbers) {
    shader_.shade(*batch_, outputs, shaded_batch_);
    const FragmentOutputs& s = shaded_batch_;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const std::uint32_t at = numbers[i];
      if (outputs.color) (*colors)[at] = {s.r[i], s.g[i], s.b[i], s.a[i]};
      if (outputs.normal) data->normal[at] = {s.normal[0][i], s.normal[1][i], s.normal[2][i]};
      if (outputs.uv) data->uv[at] = {s.uv[0][i], s.uv[1][i]};
      if (outputs.albedo) data->albedo[at] = {s.albedo[0][i], s.albedo[1][i], s.albedo[2][i]};
      if (outputs.footprint) data->footprint[at] = {s.mip_level[i], s.anisotropy[i]};
    }
  });
}

void FragmentBatcher::test_alpha(std::span<const Fragment> fragments, std::vector<std::uint8_t>& is_there) {
  shaded_ += fragments.size();
  is_there.resize(fragments.size());
  for_batches(fragments, [&](std::span<const std::uint32_t> numbers) {
    alignas(64) float alpha[FragmentBatch::padded_capacity];
    const float cutoff = shader_.alpha(*batch_, alpha);
    for (std::size_t i = 0; i < numbers.size(); ++i) is_there[numbers[i]] = alpha[i] >= cutoff;
  });
}

void FragmentBatcher::evaluate_alpha_margins(std::span<const Fragment> fragments, std::vector<float>& margins) {
  shaded_ += fragments.size();
  margins.resize(fragments.size());
  for_batches(fragments, [&](std::span<const std::uint32_t> numbers) {
    alignas(64) float alpha[FragmentBatch::padded_capacity];
    const float cutoff = shader_.alpha(*batch_, alpha);
    for (std::size_t i = 0; i < numbers.size(); ++i) margins[numbers[i]] = alpha[i] - cutoff;
  });
}

}  // namespace zoneplate
