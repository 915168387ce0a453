// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "zoneplate/math/basis.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// Points of a disc, by the square of the radius and a turn, each with a point of a square. They are a lattice of four
/// dimensions, of which the first 2^k points are a lattice too for every k.
///
/// Source    extensible lattices: Hickernell, Hong, L'Ecuyer and Lemieux, SIAM J. Sci. Comput. 22, 2000. The generator
///           (1, 39) has the least error of occlusion by a sphere, over 16, 32, 64 and 256 points, of those tried; the
///           other two dimensions are the third and fourth of Cools, Kuo and Nuyens, SIAM J. Sci. Comput. 28, 2006.
class DiscLattice {
 public:
  struct Point {
    std::uint32_t square;  ///< of the radius, in units of 2^-32
    float cosine, sine;    ///< of the turn
    std::uint32_t x, y;    ///< in the square, in units of 2^-32
  };

  explicit DiscLattice(int count) {
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
      const float turn = 6.28318531f * unit_float(reversed(i) * 39u);
      points_.push_back({reversed(i), cos(turn), sin(turn), reversed(i) * 245389u, reversed(i) * 97823u});
    }
  }
  const Point& operator[](std::uint32_t i) const { return points_[i]; }

 private:
  /// The bits in reverse order.
  static constexpr std::uint32_t reversed(std::uint32_t v) {
    v = (v >> 1 & 0x55555555u) | (v & 0x55555555u) << 1;
    v = (v >> 2 & 0x33333333u) | (v & 0x33333333u) << 2;
    v = (v >> 4 & 0x0f0f0f0fu) | (v & 0x0f0f0f0fu) << 4;
    v = (v >> 8 & 0x00ff00ffu) | (v & 0x00ff00ffu) << 8;
    return v >> 16 | v << 16;
  }

  std::vector<Point> points_;
};

/// A random turn of the disc.
struct DiscTurn {
  float cosine, sine;

  DiscTurn(std::uint32_t seed, std::uint32_t dimension) {
    const float angle = 6.28318531f * unit_float(hash(seed, dimension, 2));
    cosine = cos(angle), sine = sin(angle);
  }
  /// The cosine and the sine of a point's turn, after this one.
  struct Turned {
    float cosine, sine;
  };
  template <class Point>
  Turned operator()(const Point& p) const {
    return {p.cosine * cosine - p.sine * sine, p.sine * cosine + p.cosine * sine};
  }
};

/// The lattice of one receiver: shifted by a random vector, which is a turn of the disc and a rotation of the areas of
/// its rings.
class ShiftedDisc {
 public:
  struct Point {
    float square;        ///< of the radius, in [0, 1)
    float cosine, sine;  ///< of the turn
    float x, y;          ///< in [-1, 1)
  };

  /// `dimension`: which of the independent lattices of a receiver.
  ShiftedDisc(const DiscLattice& lattice, std::uint32_t seed, std::uint32_t dimension)
      : lattice_(lattice),
        square_(hash(seed, dimension, 1)),
        x_(hash(seed, dimension, 3)),
        y_(hash(seed, dimension, 4)),
        turn_(seed, dimension) {}
  Point operator()(std::uint32_t i) const {
    const DiscLattice::Point& p = lattice_[i];
    const DiscTurn::Turned turned = turn_(p);
    return {unit_float(p.square + square_), turned.cosine, turned.sine, 2 * unit_float(p.x + x_) - 1,
            2 * unit_float(p.y + y_) - 1};
  }

 private:
  const DiscLattice& lattice_;
  std::uint32_t square_, x_, y_;
  DiscTurn turn_;
};

/// 2^32 divided by the golden ratio; its multiples, modulo 2^32, are evenly spaced.
inline constexpr std::uint32_t golden_step = 2654435769u;

/// Points of a disc on a spiral of equal areas, the golden angle apart, for any number of them. No part of the points
/// covers the disc evenly, unlike that of a DiscLattice, but all of them do so better.
///
/// Source    Vogel, A Better Way to Construct the Sunflower Head, Mathematical Biosciences 44, 1979.
class DiscSpiral {
 public:
  struct Point {
    float cosine, sine;  ///< of the turn
  };

  explicit DiscSpiral(int count) {
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
      const float turn = 6.28318531f * unit_float(i * golden_step);
      points_.push_back({cos(turn), sin(turn)});
    }
  }
  const Point& operator[](std::uint32_t i) const { return points_[i]; }
  int count() const { return static_cast<int>(points_.size()); }

 private:
  std::vector<Point> points_;
};

/// The spiral of one receiver: turned by a random angle, and moved outwards by a random part of its step.
class TurnedSpiral {
 public:
  TurnedSpiral(const DiscSpiral& spiral, std::uint32_t seed)
      : spiral_(spiral),
        step_(1 / static_cast<float>(spiral.count())),
        start_(unit_float(hash(seed, 0, 1)) * step_),
        turn_(seed, 0) {}
  ShiftedDisc::Point operator()(std::uint32_t i) const {
    const float square = start_ + static_cast<float>(i) * step_;
    const DiscTurn::Turned turned = turn_(spiral_[i]);
    return {std::min(square, 1.0f), turned.cosine, turned.sine, 0, 0};
  }

 private:
  const DiscSpiral& spiral_;
  float step_, start_;
  DiscTurn turn_;
};

/// Directions about a unit axis.
class DirectionsAbout {
 public:
  explicit DirectionsAbout(float3 axis) : axis_(axis), basis_(axis) {}
  float3 axis() const { return axis_; }

  /// Uniform in solid angle over the cone of the directions whose cosine with the axis is at least 1 - height.
  float3 of_cone(const ShiftedDisc::Point& p, float height) const {
    const float below = p.square * height;
    return at(std::sqrt(below * (2 - below)), 1 - below, p);
  }
  /// Density proportional to the cosine with the axis.
  float3 of_cosine(const ShiftedDisc::Point& p) const { return at(std::sqrt(p.square), std::sqrt(1 - p.square), p); }

 private:
  float3 at(float sine, float cosine, const ShiftedDisc::Point& p) const {
    return basis_.first * (sine * p.cosine) + basis_.second * (sine * p.sine) + axis_ * cosine;
  }
  float3 axis_;
  Basis basis_;
};

}  // namespace zoneplate
