// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/antialias/post/display_light.h"
#include "zoneplate/antialias/reference/analytic/alpha.h"
#include "zoneplate/antialias/reference/analytic/cells.h"
#include "zoneplate/antialias/reference/analytic/colors.h"
#include "zoneplate/antialias/reference/analytic/net.h"

namespace zoneplate::antialias {

/// Samples the pixels that are too crowded for polygons: exact depths and alpha at stratified positions; the number of
/// samples depends on the variance of their colours.
///
/// The samples of a round form four groups, each of which is stratified; the variance of the groups' means gives a
/// standard error, the maximum of the channels. It mostly overestimates the error, because all samples together are
/// stratified more finely. A pixel takes 256 samples, then 1,024, then 4,096, until that estimate is at most `bound`,
/// or until more than `max_shaded` layers were shaded for it. The region of one surface that is hit by the samples of
/// one part of the pixel is shaded once, at its centroid.
///
/// Units     `bound` and the errors: of scene-linear or of display-linear light.
/// Exact     the same bits for any order of the triangles and any crop: positions depend only on the pixel's
///           coordinates.
/// Cost      time near n log n for n triangles; memory for the layers of a few thousand samples at most, and of one
///           sample at least.
class CrowdSampler {
 public:
  static constexpr double bound = 1.0 / 512;
  static constexpr std::size_t max_shaded = std::size_t{1} << 17;

  /// The contribution of a pixel to a neighbouring pixel: weighted colour and alpha, and the square of its standard
  /// error.
  struct Share {
    double r = 0, g = 0, b = 0, a = 0, variance = 0;
  };

  CrowdSampler(const ProjectedDraws& projected, const FragmentShader& shader, const Target& target,
               const PolynomialFilter& filter, int shading, int grid, Footprints footprints);

  /// Samples the pixel (x, y).
  void find(std::span<const PixelTriangle> triangles, int x, int y, const DisplayLight* display_light);

  /// The contributions to the neighbouring pixels, rows from the top.
  std::span<const Share> shares() const { return shares_; }
  /// The fraction of the pixel that opaque surfaces cover.
  double covered() const { return covered_; }

  std::uint64_t shaded() const { return colors_.shaded() + alpha_.tested(); }
  std::uint64_t samples() const { return samples_taken_; }

 private:
  /// A triangle that overlaps a square of the pixel.
  struct Member {
    std::uint32_t number;
    bool covers;
    double max_depth;
  };
  /// A triangle that covers a sample.
  struct Hit {
    double depth;
    std::uint32_t number;
  };
  struct Sample {
    double x, y;
    std::uint32_t group;
    std::uint32_t first, hits, next;  ///< indices of hits_
    std::uint32_t seen;               ///< number of visible hits, which are moved to the front
  };

  void take_round(std::size_t round);
  void visit(std::size_t round, int level, std::uint32_t column, std::uint32_t row);
  void gather(int level, Place centre, double half);
  void test_samples(std::size_t round, int level, std::uint32_t column, std::uint32_t row);
  void add_hits(SampleNet::Sample place, std::span<const Member> members);
  void finish_samples();
  bool advance(Sample& sample);
  void store(const Sample& sample);
  void fold();
  void join_groups();
  void estimate(std::size_t count);

  const PolynomialFilter& filter_;
  const int shading_, grid_;
  const SampleNet net_;
  AlphaTester alpha_;
  AreaFragmentColors colors_;
  std::vector<double> density_;  ///< for each of 8 × 8 squares and each neighbouring pixel, the filter's mean weight

  int x_ = 0, y_ = 0;  ///< the current pixel
  SampleNet::Shift shift_;
  std::span<const PixelTriangle> triangles_;
  /// True if a triangle is alpha-tested: the pixel has grid × grid parts, else shading × shading.
  bool is_fine_ = false;
  std::vector<std::vector<Member>> members_;  ///< by level of the quadtree
  std::vector<Hit> hits_;
  std::vector<Sample> samples_;
  std::vector<std::uint32_t> waiting_;  ///< samples whose next hit is alpha-tested
  std::vector<Fragment> points_;
  std::vector<Layer> layers_;
  AreaFragmentTable table_;  ///< weights by group and neighbouring pixel
  std::vector<Share> sum_;   ///< sums of shaded fragments, by group and neighbouring pixel
  std::size_t layers_shaded_ = 0;
  std::vector<Share> shares_;
  double covered_ = 0;
  const DisplayLight* display_light_ = nullptr;
  std::uint64_t samples_taken_ = 0;
};

}  // namespace zoneplate::antialias
