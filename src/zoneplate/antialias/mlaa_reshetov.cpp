// The first morphological antialiasing: separation lines of any length, in shapes of L, Z and U.
//
// A Z or U is split at its middle into two L; each L is a triangle from a height on the step at its end down to the
// middle (or to the far end, of a single L). The height is where the mixed colours of the two sides meet. Lines of both
// directions count from the picture as it was, not one after the other.
//
// Source: Reshetov, Morphological Antialiasing, HPG 2009.
#include <cmath>
#include <cstdlib>

#include "zoneplate/antialias/codes.h"
#include "zoneplate/antialias/mlaa.h"

namespace zoneplate::antialias {

float split_height(int near, int across, int beyond, int beyond_near) {
  const int numerator = beyond_near - near, denominator = across - near - beyond + beyond_near;
  if (denominator == 0) return 0.5f;
  const float h = static_cast<float>(numerator) / static_cast<float>(denominator);
  return h >= 0 && h <= 1 ? h : 0.5f;
}

namespace {

/// A difference in the upper four bits of a channel.
constexpr int least_difference = 16;

bool differ(Rgba8 a, Rgba8 b) {
  return std::abs(a.r - b.r) >= least_difference || std::abs(a.g - b.g) >= least_difference ||
         std::abs(a.b - b.b) >= least_difference;
}

EdgePlane find_edges(const Rgba8Image& image) {
  EdgePlane edges(image.width(), image.height(), 1);
  for_rows(image.height(), [&](int y) {
    for (int x = 0; x < image.width(); ++x) {
      const bool is_left = x > 0 && differ(image(x, y), image(x - 1, y));
      const bool is_top = y > 0 && differ(image(x, y), image(x, y - 1));
      *edges.at(x, y) = static_cast<std::uint8_t>(is_left | is_top << 1);
    }
  });
  edges.extend();
  return edges;
}

enum class Side { None, Below, Above };

/// The separation lines of one direction: `i` runs along them, `j` across; horizontal ones are top edges.
class Lines {
 public:
  Lines(const Rgba8Image& image, const EdgePlane& edges, WeightPlane& weights, bool is_horizontal)
      : image_(image), edges_(edges), weights_(weights), is_horizontal_(is_horizontal) {}

  int count() const { return is_horizontal_ ? image_.height() : image_.width(); }

  /// Weighs every line between pixels j - 1 and j.
  void weigh(int j) {
    for (int begin = 0; begin < length();) {
      if (!is_edge(begin, j)) {
        ++begin;
        continue;
      }
      int end = begin + 1;
      while (end < length() && is_edge(end, j)) ++end;
      weigh_line(begin, end, j);
      begin = end;
    }
  }

 private:
  int length() const { return is_horizontal_ ? image_.width() : image_.height(); }
  const std::uint8_t& edge(int i, int j) const { return *(is_horizontal_ ? edges_.at(i, j) : edges_.at(j, i)); }
  bool is_edge(int i, int j) const { return edge(i, j) & (is_horizontal_ ? top_edge : left_edge); }
  /// Whether something crosses before pixel i of row j; nothing does at the picture's sides.
  bool crosses(int i, int j) const {
    return i > 0 && i < length() && edge(i, j) & (is_horizontal_ ? left_edge : top_edge);
  }
  /// The sum of a pixel's codes, weighed as luma.
  int luma(int i, int j) const {
    const int jj = std::clamp(j, 0, count() - 1);
    const Rgba8 c = is_horizontal_ ? image_(i, jj) : image_(jj, i);
    return 299 * c.r + 587 * c.g + 114 * c.b;
  }

  void weigh_line(int begin, int end, int j) {
    const bool below[2] = {crosses(begin, j), crosses(end, j)}, above[2] = {crosses(begin, j - 1), crosses(end, j - 1)};
    Side side[2];
    for (int k = 0; k < 2; ++k) side[k] = below[k] == above[k] ? Side::None : below[k] ? Side::Below : Side::Above;
    // What crosses on both sides joins the other end's side to a Z.
    for (int k = 0; k < 2; ++k)
      if (below[k] && above[k] && side[1 - k] != Side::None)
        side[k] = below[1 - k] && above[1 - k] ? Side::None : side[1 - k] == Side::Below ? Side::Above : Side::Below;
    const bool is_whole = side[0] == Side::None || side[1] == Side::None;
    const float reach = static_cast<float>(end - begin) / (is_whole ? 1.0f : 2.0f);
    if (side[0] != Side::None) weigh_part(begin, 1, reach, j, side[0]);
    if (side[1] != Side::None) weigh_part(end - 1, -1, reach, j, side[1]);
  }

  /// The triangle that begins at the step before pixel `first` and ends `reach` pixels on.
  void weigh_part(int first, int direction, float reach, int j, Side side) {
    const int near = side == Side::Below ? j : j - 1, across = side == Side::Below ? j - 1 : j;
    const int beyond = first - direction;
    const float height =
        split_height(luma(first, near), luma(first, across), luma(beyond, near), luma(beyond, near + (near - across)));
    for (int k = 0; static_cast<float>(k) < reach; ++k) {
      const float at = height * (reach - static_cast<float>(k)) / reach;
      const float rest = std::min(1.0f, reach - static_cast<float>(k));
      const float next = height * (reach - static_cast<float>(k) - rest) / reach;
      add(first + direction * k, j, side, (at + next) * 0.5f * rest);
    }
  }

  void add(int i, int j, Side side, float area) {
    EdgeWeights& w = *(is_horizontal_ ? weights_.at(i, j) : weights_.at(j, i));
    std::uint8_t& weight = is_horizontal_ ? (side == Side::Below ? w.from_above : w.to_above)
                                          : (side == Side::Below ? w.from_left : w.to_left);
    weight = static_cast<std::uint8_t>(std::min(255, weight + rounded_code(255 * area)));
  }

  const Rgba8Image& image_;
  const EdgePlane& edges_;
  WeightPlane& weights_;
  bool is_horizontal_;
};

}  // namespace

WeightPlane mlaa_reshetov_weights(const Rgba8Image& image) {
  const EdgePlane edges = find_edges(image);
  WeightPlane weights(image.width(), image.height(), 1);
  for_rows(image.height(), [&](int y) { std::fill_n(weights.at(0, y), image.width(), EdgeWeights{}); });
  for (const bool is_horizontal : {true, false}) {
    Lines lines(image, edges, weights, is_horizontal);
    for_rows(lines.count(), [&](int j) { lines.weigh(j); });
  }
  weights.extend();
  return weights;
}

}  // namespace zoneplate::antialias
