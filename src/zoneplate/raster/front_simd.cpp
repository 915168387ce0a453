#include <hwy/highway.h>

#include "zoneplate/raster/front.h"
#include "zoneplate/raster/small_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

/// Of those lanes the ones with a sample of the pattern within bounds of that size.
HWY_INLINE MI may_cover_a_sample(const Extent& e, VI width, VI height, const FrontRun& run, MI asked) {
  MI found = hn::MaskFromVec(hn::Zero(i32));
  for (std::int32_t s = 0; s < run.sample_count; ++s) {
    const MI none =
        hn::Or(hn::Gt(up_to(run.sample_x[s], e.low_x), width), hn::Gt(up_to(run.sample_y[s], e.low_y), height));
    found = hn::Or(found, hn::AndNot(none, asked));
    if (hn::AllFalse(i32, hn::AndNot(found, asked))) break;
  }
  return found;
}

/// Lanes with a pixel of the rectangle within the bounds.
HWY_INLINE MI meets_rectangle(const Extent& e, const FrontRun& run) {
  const VI beside =
      hn::Or(hn::Or(hn::Sub(set(run.right * 256 + 255), e.low_x), hn::Sub(e.high_x, set(run.left * 256))),
             hn::Or(hn::Sub(set(run.bottom * 256 + 255), e.low_y), hn::Sub(e.high_y, set(run.top * 256))));
  return hn::Not(hn::MaskFromVec(hn::BroadcastSignBit(beside)));
}

/// The work on one run, a vector of triangles at a time.
class Front {
 public:
  Front(const FrontRun& run, FragmentSink& sink, FrontResult& result) : run_(run), sink_(sink), result_(result) {}

  HWY_INLINE void run() {
    result_.general_count = result_.kept_count = 0, result_.drawn = 0;
    std::int32_t t = 0;
    for (; t + lanes <= run_.count; t += lanes) select(run_.index + 3 * t, t, hn::Eq(hn::Zero(i32), hn::Zero(i32)));
    if (t < run_.count) {
      // The last triangles are copied into a whole vector's room.
      std::uint32_t index[3 * lanes];
      for (std::int32_t k = 0; k < 3 * lanes; ++k)
        index[k] = run_.index[3 * t + (3 * t + k < 3 * run_.count ? k : k % 3)];
      select(index, t, hn::FirstN(i32, static_cast<std::size_t>(run_.count - t)));
    }
    draw_waiting(true);
    draw_samples(true);
  }

 private:
  HWY_INLINE void list(MI mask, VI number, std::int32_t* to, std::int32_t& count) {
    const Packing packing(mask);
    packing.store(number, to + count);
    count += packing.count();
  }

  HWY_INLINE void select(const std::uint32_t* index, std::int32_t t, MI asked) {
    Corners c;
    const MI clipped = load(run_.screen, index, run_.viewport, c);
    const Extent e = extent_of(c);
    const VI width = hn::Sub(e.high_x, e.low_x), height = hn::Sub(e.high_y, e.low_y), size = hn::Max(width, height);
    const VI number = hn::Add(hn::Iota(i32, 0), set(t));
    const MI general = hn::And(asked, hn::Or(clipped, hn::Gt(size, set(large_extent))));
    if (!hn::AllFalse(i32, general)) list(general, number, result_.general, result_.general_count);

    // A wrong area of a general lane does no harm: it is not looked at.
    const VI area = hn::Sub(hn::Mul(hn::Sub(c.x[1], c.x[0]), hn::Sub(c.y[2], c.y[0])),
                            hn::Mul(hn::Sub(c.y[1], c.y[0]), hn::Sub(c.x[2], c.x[0])));
    const MI backward = hn::Lt(area, hn::Zero(i32)), forward = hn::Gt(area, hn::Zero(i32));
    const MI facing = run_.facing > 0 ? forward : run_.facing < 0 ? backward : hn::Or(forward, backward);
    MI kept = hn::And(hn::AndNot(general, asked), facing);
    if (hn::AllFalse(i32, kept)) return;
    kept = may_cover_a_sample(e, width, height, run_, hn::And(kept, meets_rectangle(e, run_)));
    if (hn::AllFalse(i32, kept)) return;
    const MI small = hn::AndNot(hn::Gt(size, set(run_.small_extent)), kept);

    // Corners are taken clockwise.
    if (run_.facing <= 0) {
      swap_where(backward, c.x[1], c.x[2]);
      swap_where(backward, c.y[1], c.y[2]);
      swap_where(hn::RebindMask(f, backward), c.z[1], c.z[2]);
    }
    c.id = hn::Add(number, set(run_.first_id));
    keep(c, e, number, hn::AndNot(small, kept));
    if (hn::AllFalse(i32, small)) return;
    result_.drawn += hn::CountTrue(i32, small);
    if (run_.sample_count == 1 && cover(c, e, width, height, hn::Abs(area), small)) return;
    waiting_.add(c, Packing(small));
    if (waiting_.count >= Waiting::enough) draw_waiting(false);
  }

  HWY_INLINE void keep(const Corners& c, const Extent& e, VI number, MI mask) {
    if (hn::AllFalse(i32, mask)) return;
    if (run_.records)
      record(c, e, mask);
    else
      list(mask, number, result_.kept, result_.kept_count);
  }

  // Of one sample a pixel: finds what the triangles cover before they are set up, for half of the tiny ones cover
  // nothing. False where that may be many.
  HWY_INLINE bool cover(const Corners& c, const Extent& e, VI width, VI height, VI area, MI small) {
    const VI to_x = up_to(run_.sample_x[0], e.low_x), to_y = up_to(run_.sample_y[0], e.low_y);
    const VI more_x = hn::Sub(width, to_x), more_y = hn::Sub(height, to_y);
    if (!hn::AllFalse(i32, hn::And(small, hn::Gt(hn::Max(more_x, more_y), set(511))))) return false;
    SetUp t;
    set_up_edges(c, run_.is_top_left, t);
    const VI px = hn::Add(e.low_x, to_x), py = hn::Add(e.low_y, to_y);
    const VI e1 = edge_at<1>(c, t, px, py), e2 = edge_at<2>(c, t, px, py);
    const Edges row{hn::Add(hn::Sub(hn::Sub(area, e1), e2), t.bias[0]), hn::Add(e1, t.bias[1]), hn::Add(e2, t.bias[2])};
    // What lies beyond the bounds is outside. A bit for each candidate; mostly none or one is covered.
    const VI dead = hn::VecFromMask(i32, hn::Not(small));
    const Edges below = row.down(t);
    VI left = hn::Or(hn::Or(bit_of<1>(row, dead), bit_of<2>(row.right(t), dead)),
                     hn::Or(bit_of<4>(below, dead), bit_of<8>(below.right(t), dead)));
    const VI zero = hn::Zero(i32), pixel = set(256);
    for (MI mask = hn::Gt(left, zero); !hn::AllFalse(i32, mask); mask = hn::Gt(left, zero)) {
      const VI rest = hn::And(left, hn::Sub(left, set(1))), first = hn::Xor(left, rest);
      const VI x = hn::Add(px, hn::And(hn::Or(hn::ShiftLeft<7>(first), hn::ShiftLeft<5>(first)), pixel));
      const VI y = hn::Add(py, hn::And(hn::Or(hn::ShiftLeft<6>(first), hn::ShiftLeft<5>(first)), pixel));
      samples_.add(c, x, y, Packing(mask));
      left = rest;
    }
    if (samples_.count >= Waiting::enough) draw_samples(false);
    return true;
  }

  template <int bit>
  static HWY_INLINE VI bit_of(const Edges& e, VI dead) {
    return hn::AndNot(hn::BroadcastSignBit(e.outside(dead)), set(bit));
  }

  HWY_NOINLINE void draw_samples(bool is_end) {
    samples_.take(is_end, [&](std::int32_t i, MI alive) HWY_ATTR { draw_samples_at(i, alive); });
  }

  HWY_INLINE void draw_samples_at(std::int32_t i, MI alive) {
    const Corners c = samples_.get(i);
    const VI px = hn::Load(i32, samples_.sample_x + i), py = hn::Load(i32, samples_.sample_y + i);
    const VI pixel_x = hn::ShiftRight<8>(px), pixel_y = hn::ShiftRight<8>(py);
    SetUp t;
    t.dx[2] = hn::Sub(c.x[1], c.x[0]), t.dy[2] = hn::Sub(c.y[1], c.y[0]);
    set_up_plane(c, hn::Min(hn::Min(c.x[0], c.x[1]), c.x[2]), hn::Min(hn::Min(c.y[0], c.y[1]), c.y[2]), t);
    const Way way(c, t);
    const VD sx = hn::Set(f64, static_cast<double>(run_.sample_x[0]));
    const VD sy = hn::Set(f64, static_cast<double>(run_.sample_y[0]));
    const VF first = narrowed(way.depth<0>(t, sx, sy), way.depth<1>(t, sx, sy));
    const VF row = hn::Add(first, hn::Mul(t.step_y, hn::ConvertTo(f, hn::Sub(pixel_y, t.origin_y))));
    const VF z = hn::Add(row, hn::Mul(t.step_x, hn::ConvertTo(f, hn::Sub(pixel_x, t.origin_x))));
    put_by_tile(run_, sink_, alive, pixel_x, pixel_y, hn::Min(hn::Max(z, t.z_low), t.z_high),
                what_at(c.id, pixel_x, pixel_y));
  }

  HWY_NOINLINE void draw_waiting(bool is_end) {
    waiting_.take(is_end, [&](std::int32_t i, MI alive) HWY_ATTR {
      const Corners c = waiting_.get(i);
      draw(c, extent_of(c), alive);
    });
  }

  // What make_triangle does.
  HWY_NOINLINE void record(Corners c, Extent e, MI mask) {
    SetUp t;
    set_up(c, e, run_.is_top_left, t);
    RecordLanes r;
    r.store_edge<0>(c, t);
    r.store_edge<1>(c, t);
    r.store_edge<2>(c, t);
    r.store_rest(c, e, t);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(i32, mask, bits);
    for (std::uint32_t left = bits[0]; left; left &= left - 1)
      r.copy(__builtin_ctz(left), run_.records[result_.kept_count++]);
  }

  HWY_NOINLINE void draw(const Corners& c, const Extent& e, MI alive) {
    SetUp t;
    set_up(c, e, run_.is_top_left, t);
    const VI dead = hn::VecFromMask(i32, hn::Not(alive));
    const VI width = hn::AndNot(dead, hn::Sub(e.high_x, e.low_x));
    const VI height = hn::AndNot(dead, hn::Sub(e.high_y, e.low_y));
    const Work work{c, e, t, Way(c, t), dead, hn::ShiftLeft<16>(c.id)};
    const std::int32_t tile = tile_of_all(e, dead);
    // A sample of one kind has at most a candidate more in each direction than there are whole pixels.
    if (tile < 0) {
      scatter(work, candidates(width), candidates(height));
    } else if (!hn::AllFalse(i32, hn::Gt(hn::Max(width, height), set(511)))) {
      append_many(work, tile, candidates(width), candidates(height));
    } else if (!hn::AllFalse(i32, hn::Gt(width, set(255)))) {
      append<2, 2>(work, tile);
    } else if (!hn::AllFalse(i32, hn::Gt(height, set(255)))) {
      append<1, 2>(work, tile);
    } else {
      append<1, 1>(work, tile);
    }
  }

  static HWY_INLINE int candidates(VI extent) { return (hn::GetLane(hn::MaxOfLanes(i32, extent)) >> 8) + 1; }

  /// A vector of triangles on its way to become fragments.
  struct Work {
    const Corners& c;
    const Extent& e;
    const SetUp& t;
    Way way;
    VI dead;
    VI number;  ///< as what is said of fragments has it
  };

  /// Where the candidates lie in no more columns and rows than that.
  template <int columns, int rows>
  HWY_INLINE void append(const Work& w, std::int32_t tile) {
    for (std::int32_t s = 0; s < run_.sample_count; ++s) {
      const Candidates n = candidates_of(w.c, w.e, w.t, w.way, run_.sample_x[s], run_.sample_y[s]);
      cover_few<columns, rows>(w.t, n, w.dead, append_at(w, n, s, tile, columns * rows));
    }
  }

  HWY_NOINLINE void append_many(const Work& w, std::int32_t tile, int columns, int rows) {
    for (std::int32_t s = 0; s < run_.sample_count; ++s) {
      const Candidates n = candidates_of(w.c, w.e, w.t, w.way, run_.sample_x[s], run_.sample_y[s]);
      Edges row{n.e[0], n.e[1], n.e[2]};
      for (int j = 0; j < rows; ++j, row = row.down(w.t))
        cover_row(w.t, n, row, w.dead, columns, j, append_at(w, n, s, tile, columns + 1));
    }
  }

  HWY_INLINE Append append_at(const Work& w, const Candidates& n, std::int32_t s, std::int32_t tile, int places) {
    SampleFragments* const part = part_with_room(run_, sink_, tile, places * lanes);
    const VI in_tile = set(63);
    const VI place = hn::Add(hn::ShiftLeft<6>(hn::And(n.pixel_y, in_tile)), hn::And(n.pixel_x, in_tile));
    const auto rest = (static_cast<std::uint32_t>(s) << 12) - (static_cast<std::uint32_t>(part->first_id) << 16);
    return {part, hn::Add(hn::Add(place, w.number), set(static_cast<std::int32_t>(rest)))};
  }

  HWY_NOINLINE void scatter(const Work& w, int columns, int rows) {
    for (std::int32_t s = 0; s < run_.sample_count; ++s) {
      const Candidates n = candidates_of(w.c, w.e, w.t, w.way, run_.sample_x[s], run_.sample_y[s]);
      Edges row{n.e[0], n.e[1], n.e[2]};
      for (int j = 0; j < rows; ++j, row = row.down(w.t))
        cover_row(w.t, n, row, w.dead, columns, j, Scatter{run_, sink_, n, w.c.id, s});
    }
  }

  // The tile in which all lanes lie, so that whole vectors go to one list; or -1.
  HWY_INLINE std::int32_t tile_of_all(const Extent& e, VI dead) const {
    const auto first = hn::FindFirstTrue(i32, hn::Eq(dead, hn::Zero(i32)));
    const auto lane = hn::IndicesFromVec(i32, set(static_cast<std::int32_t>(first)));
    const VI x = hn::TableLookupLanes(e.low_x, lane), y = hn::TableLookupLanes(e.low_y, lane);
    const VI beyond =
        hn::Or(hn::Or(hn::Xor(e.low_x, x), hn::Xor(e.high_x, x)), hn::Or(hn::Xor(e.low_y, y), hn::Xor(e.high_y, y)));
    if (!hn::AllTrue(i32, hn::Eq(hn::ShiftRight<14>(hn::AndNot(dead, beyond)), hn::Zero(i32)))) return -1;
    const std::int32_t column = hn::GetLane(x) >> 14, row = hn::GetLane(y) >> 14;
    return (row - sink_.first_row) * sink_.columns + column - sink_.first_column;
  }

  const FrontRun& run_;
  FragmentSink& sink_;
  FrontResult& result_;
  Waiting waiting_;  ///< triangles
  Waiting samples_;  ///< samples that are covered
};

void run_front(const FrontRun& run, FragmentSink& sink, FrontResult& result) { Front(run, sink, result).run(); }

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
const FrontKernels FrontKernels::HWY_NAMESPACE = {.run = HWY_NAMESPACE::run_front};
}  // namespace zoneplate
