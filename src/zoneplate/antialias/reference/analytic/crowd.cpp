// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/crowd.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/base/deadline.h"
#include "zoneplate/math/random.h"

namespace zoneplate::antialias {
namespace {

constexpr std::size_t max_hits = std::size_t{1} << 16;    // hits that are collected before samples are finished
constexpr std::size_t max_layers = std::size_t{1} << 16;  // layers that are collected before fragments are shaded
constexpr std::size_t few_members = 3;                    // a square of this many members is not divided
// Squares along a pixel's side for which the filter's weights are tabulated.
constexpr int squares = 8;

/// True if a point is inside of an edge; of two triangles that share an edge, it is inside of exactly one.
bool is_inside(const Line& edge, Place p) {
  const double d = edge.distance(p);
  return d > 0 || (d == 0 && (edge.a > 0 || (edge.a == 0 && edge.b > 0)));
}

bool is_inside(const PixelTriangle& t, Place p) {
  return is_inside(t.edge[0], p) && is_inside(t.edge[1], p) && is_inside(t.edge[2], p);
}

double depth_at(const PixelTriangle& t, Place p) { return (t.z + t.zx * p.x) + t.zy * p.y; }

}  // namespace

CrowdSampler::CrowdSampler(const ProjectedDraws& projected, const FragmentShader& shader, const Target& target,
                           const PolynomialFilter& filter, int shading, int grid, Footprints footprints)
    : filter_(filter),
      shading_(shading),
      grid_(grid),
      alpha_(projected, shader, target, footprints.alpha),
      colors_(projected, shader, target, footprints),
      members_(SampleNet::deepest + 2),
      table_(SampleNet::groups * filter.weight_count()) {
  for_grid(unit_square(), {0, 0}, 1.0 / squares, squares, [&](int, int, const ConvexPolygon& square) {
    density_.resize(density_.size() + filter_.weight_count());
    const auto weights = std::span(density_).last(filter_.weight_count());
    filter_.add_weights(square, weights);
    for (double& weight : weights) weight *= squares * squares;
  });
}

void CrowdSampler::find(std::span<const PixelTriangle> triangles, int x, int y, const DisplayLight* display_light) {
  x_ = x, y_ = y;
  triangles_ = triangles, display_light_ = display_light;
  const auto across = static_cast<std::uint32_t>(x), down = static_cast<std::uint32_t>(y);
  shift_ = {hash(across, down, 0), hash(across, down, 1)};
  table_.clear();
  table_.begin_pixel(x, y);
  sum_.assign(SampleNet::groups * filter_.weight_count(), {});
  covered_ = 0, layers_shaded_ = 0;
  is_fine_ = std::ranges::any_of(triangles, [](const PixelTriangle& t) { return t.alpha_mode == AlphaMode::Mask; });
  members_[0].clear();
  for (std::uint32_t i = 0; i < triangles.size(); ++i) members_[0].push_back({i, triangles[i].covers_all, 0});
  std::size_t count = 0;
  for (std::size_t round = 0; round < SampleNet::ends.size(); ++round) {
    if (round > 0) join_groups();
    take_round(round);
    estimate(SampleNet::ends[round]);
    count = SampleNet::ends[round];
    if (shares_[shares_.size() / 2].variance <= bound * bound || layers_shaded_ > max_shaded) break;
  }
  covered_ /= static_cast<double>(count);
}

void CrowdSampler::take_round(std::size_t round) {
  samples_taken_ += net_.size(round);
  visit(round, 0, 0, 0);
  finish_samples();
  fold();
}

/// Samples a square of the pixel's quadtree, given the members of its parent.
void CrowdSampler::visit(std::size_t round, int level, std::uint32_t column, std::uint32_t row) {
  const double side = 1.0 / (1 << level);
  gather(level, {(column + 0.5) * side, (row + 0.5) * side}, side / 2);
  const std::size_t count = members_[static_cast<std::size_t>(level) + 1].size();
  if (count == 0) return;
  if (level == SampleNet::deepest || count <= few_members) return test_samples(round, level, column, row);
  for (std::uint32_t k = 0; k < 4; ++k) visit(round, level + 1, 2 * column + k % 2, 2 * row + k / 2);
}

/// Computes members_[level + 1]: the members of members_[level] that overlap the square and are not entirely hidden in
/// it.
void CrowdSampler::gather(int level, Place centre, double half) {
  const std::vector<Member>& from = members_[static_cast<std::size_t>(level)];
  std::vector<Member>& found = members_[static_cast<std::size_t>(level) + 1];
  found.clear();
  if (from.size() > 1000) check_deadline();
  double hidden_below = -1;
  for (const Member& m : from) {
    const PixelTriangle& t = triangles_[m.number];
    bool covers = true, misses = false;
    if (!m.covers)
      for (const Line& edge : t.edge) {
        const double d = edge.distance(centre), reach = half * (std::abs(edge.a) + std::abs(edge.b)) + on_line;
        covers = covers && d > reach;
        misses = misses || d < -reach;
      }
    if (misses) continue;
    const double z = depth_at(t, centre), change = half * (std::abs(t.zx) + std::abs(t.zy));
    if (covers && t.alpha_mode == AlphaMode::Opaque) hidden_below = std::max(hidden_below, z - change);
    if (z + change < hidden_below) continue;
    found.push_back({m.number, covers, z + change});
  }
  std::erase_if(found, [&](const Member& m) { return m.max_depth < hidden_below; });
}

void CrowdSampler::test_samples(std::size_t round, int level, std::uint32_t column, std::uint32_t row) {
  const std::vector<Member>& members = members_[static_cast<std::size_t>(level) + 1];
  net_.for_square(round, level, column, row, shift_, [&](SampleNet::Sample place) {
    add_hits(place, members);
    if (hits_.size() > max_hits) finish_samples();
  });
}

/// Adds a sample with its triangles, near to far, up to the first opaque one.
void CrowdSampler::add_hits(SampleNet::Sample place, std::span<const Member> members) {
  const Place p{place.x, place.y};
  const std::size_t first = hits_.size();
  const auto is_nearer = [&](const Hit& a, const Hit& b) {
    return a.depth != b.depth ? a.depth > b.depth : triangles_[a.number].id < triangles_[b.number].id;
  };
  Hit wall{-1, 0};
  bool has_wall = false;
  for (const Member& m : members) {
    const PixelTriangle& t = triangles_[m.number];
    const Hit hit{depth_at(t, p), m.number};
    if (has_wall && !is_nearer(hit, wall)) continue;
    if (!m.covers && !is_inside(t, p)) continue;
    if (t.alpha_mode == AlphaMode::Opaque)
      wall = hit, has_wall = true;
    else
      hits_.push_back(hit);
  }
  const auto begin = hits_.begin() + static_cast<std::ptrdiff_t>(first);
  if (has_wall) {
    hits_.erase(std::remove_if(begin, hits_.end(), [&](const Hit& h) { return !is_nearer(h, wall); }), hits_.end());
    hits_.push_back(wall);
  }
  std::sort(hits_.begin() + static_cast<std::ptrdiff_t>(first), hits_.end(), is_nearer);
  if (hits_.size() > first)
    samples_.push_back({place.x, place.y, place.group, static_cast<std::uint32_t>(first),
                        static_cast<std::uint32_t>(hits_.size() - first), 0, 0});
}

/// Advances to the next alpha-tested hit; false if an opaque hit or the end comes first.
bool CrowdSampler::advance(Sample& s) {
  for (; s.next < s.hits; ++s.next) {
    const Hit hit = hits_[s.first + s.next];
    if (triangles_[hit.number].alpha_mode == AlphaMode::Mask) return true;
    hits_[s.first + s.seen++] = hit;
  }
  return false;
}

/// Tests alpha for all samples together, starting with the nearest surfaces, and adds visible layers to the fragments.
void CrowdSampler::finish_samples() {
  waiting_.clear();
  for (std::uint32_t i = 0; i < samples_.size(); ++i)
    if (advance(samples_[i])) waiting_.push_back(i);
  while (!waiting_.empty()) {
    check_deadline();
    points_.clear();
    for (const std::uint32_t i : waiting_) {
      const Sample& s = samples_[i];
      const auto place = [](int pixel, double v) { return pixel * 256 + static_cast<std::int32_t>(v * 256 + 0.5); };
      points_.push_back({place(x_, s.x), place(y_, s.y), triangles_[hits_[s.first + s.next].number].id, 0, 0});
    }
    const auto margin = alpha_.margins(points_);
    std::size_t left = 0;
    for (std::size_t k = 0; k < waiting_.size(); ++k) {
      Sample& s = samples_[waiting_[k]];
      if (margin[k] >= 0) {
        hits_[s.first + s.seen++] = hits_[s.first + s.next];
        continue;
      }
      ++s.next;
      if (advance(s)) waiting_[left++] = waiting_[k];
    }
    waiting_.resize(left);
  }
  for (const Sample& s : samples_)
    if (s.seen > 0) store(s);
  samples_.clear();
  hits_.clear();
  if (table_.layer_count() > max_layers) fold();
}

void CrowdSampler::store(const Sample& s) {
  layers_.clear();
  for (std::uint32_t i = 0; i < s.seen; ++i) {
    const PixelTriangle& t = triangles_[hits_[s.first + i].number];
    layers_.push_back({t.id, t.alpha_mode});
  }
  const auto square = [&](int count) { return static_cast<int>(s.y * count) * count + static_cast<int>(s.x * count); };
  const std::size_t i = table_.find(static_cast<std::uint32_t>(square(is_fine_ ? grid_ : shading_)), is_fine_, layers_);
  AreaMoments& m = table_.fragment(i).moments;
  m = {m.area + 1, m.x + s.x, m.y + s.y};
  const std::size_t count = filter_.weight_count();
  const auto weights = table_.weights_of(i).subspan(s.group * count, count);
  for (std::size_t k = 0; k < count; ++k) weights[k] += density_[static_cast<std::size_t>(square(squares)) * count + k];
}

/// Shades the fragments and adds them to the sums.
void CrowdSampler::fold() {
  layers_shaded_ += table_.layer_count();
  colors_.find(table_);
  for (std::size_t i = 0; i < table_.fragments().size(); ++i) {
    const AreaFragment& f = table_.fragments()[i];
    if (table_.layers_of(f).back().alpha_mode != AlphaMode::Blend) covered_ += f.moments.area;
    const Linear c = display_light_ ? (*display_light_)(colors_.color(i)) : colors_.color(i);
    const std::span<const double> w = table_.weights_of(i);
    for (std::size_t k = 0; k < sum_.size(); ++k) {
      Share& s = sum_[k];
      s.r += w[k] * c.r, s.g += w[k] * c.g, s.b += w[k] * c.b, s.a += w[k] * c.a;
    }
  }
  table_.clear();
  table_.begin_pixel(x_, y_);
}

/// Merges all groups into the first group of the next round.
void CrowdSampler::join_groups() {
  const std::size_t around = filter_.weight_count();
  for (std::size_t k = 0; k < around; ++k)
    for (std::size_t g = 1; g < SampleNet::groups; ++g) {
      Share &to = sum_[k], &from = sum_[g * around + k];
      to.r += from.r, to.g += from.g, to.b += from.b, to.a += from.a;
      from = {};
    }
}

/// Computes the pixel's shares after `count` samples.
void CrowdSampler::estimate(std::size_t count) {
  constexpr std::size_t groups = SampleNet::groups;
  const std::size_t around = filter_.weight_count();
  const auto n = static_cast<double>(count);
  shares_.assign(around, {});
  for (std::size_t k = 0; k < around; ++k)
    for (double Share::*channel : {&Share::r, &Share::g, &Share::b, &Share::a}) {
      double all = 0, squared = 0;
      for (std::size_t g = 0; g < groups; ++g) all += sum_[g * around + k].*channel;
      for (std::size_t g = 0; g < groups; ++g) {
        const double off = (sum_[g * around + k].*channel * groups - all) / n;
        squared += off * off;
      }
      shares_[k].*channel = all / n;
      shares_[k].variance = std::max(shares_[k].variance, squared / (groups * (groups - 1)));
    }
}

}  // namespace zoneplate::antialias
