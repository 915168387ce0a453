// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/raster/types/fragment_shader.h"

namespace zoneplate {

/// Alpha to coverage: converts alpha into a number of samples, and reports one binary digit of that number per call, so
/// that FragmentBatcher::test_alpha, which keeps one bit for each fragment, can carry it.
///
/// The number is alpha × samples, rounded. AlphaTest::Sharp first steepens alpha around the cutoff, so that it falls
/// from 1 to 0 within a pixel: (alpha - cutoff) / max(|d alpha/dx| + |d alpha/dy|, 1e-4) + ½, clamped.
/// Source    Golus, Anti-aliased Alpha Test: The Esoteric Alpha To Coverage, 2017.
class AlphaDigits : public FragmentShader {
 public:
  AlphaDigits(const FragmentShader& inner, int samples, bool is_sharp)
      : inner_(inner), samples_(samples), is_sharp_(is_sharp) {}

  int digits() const;
  void choose(int digit) { digit_ = digit; }

  void shade(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const override {
    inner_.shade(batch, outputs, out);
  }
  /// Writes 1 where the chosen digit of a fragment's number is 1, otherwise 0; the cutoff is 1.
  float alpha(const FragmentBatch& batch, float* out) const override;

 private:
  const FragmentShader& inner_;
  int samples_;
  bool is_sharp_;
  int digit_ = 0;
};

}  // namespace zoneplate
