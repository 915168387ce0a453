// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/fourier/fourier_plan.h"

#include <algorithm>
#include <cassert>

#include "zoneplate/signal/functions.h"

namespace zoneplate {
namespace {

constexpr std::size_t lanes = FourierPlan::lanes;

// One complex element of each of the four signals.
struct Pack {
  double re[lanes], im[lanes];
};

Pack load(const double* re, const double* im) {
  Pack p;
  for (std::size_t l = 0; l < lanes; ++l) p.re[l] = re[l], p.im[l] = im[l];
  return p;
}

void store(const Pack& p, double* re, double* im) {
  for (std::size_t l = 0; l < lanes; ++l) re[l] = p.re[l], im[l] = p.im[l];
}

Pack operator+(const Pack& a, const Pack& b) {
  Pack p;
  for (std::size_t l = 0; l < lanes; ++l) p.re[l] = a.re[l] + b.re[l], p.im[l] = a.im[l] + b.im[l];
  return p;
}

Pack operator-(const Pack& a, const Pack& b) {
  Pack p;
  for (std::size_t l = 0; l < lanes; ++l) p.re[l] = a.re[l] - b.re[l], p.im[l] = a.im[l] - b.im[l];
  return p;
}

Pack operator*(const Pack& a, double s) {
  Pack p;
  for (std::size_t l = 0; l < lanes; ++l) p.re[l] = a.re[l] * s, p.im[l] = a.im[l] * s;
  return p;
}

struct Root {
  double re, im;
};

Pack operator*(const Pack& a, Root w) {
  Pack p;
  for (std::size_t l = 0; l < lanes; ++l) {
    p.re[l] = a.re[l] * w.re - a.im[l] * w.im;
    p.im[l] = a.re[l] * w.im + a.im[l] * w.re;
  }
  return p;
}

Pack times_minus_i(const Pack& a) {
  Pack p;
  for (std::size_t l = 0; l < lanes; ++l) p.re[l] = a.im[l], p.im[l] = -a.re[l];
  return p;
}

// The input and output of a stage: element k of group q, column s of the radix-p butterfly.
struct Views {
  const double *in_re, *in_im;
  double *out_re, *out_im;
  std::size_t groups, stride, radix;

  Pack in(std::size_t j, std::size_t q, std::size_t s) const {
    const std::size_t i = ((q + groups * j) * stride + s) * lanes;
    return load(in_re + i, in_im + i);
  }
  void out(std::size_t k, std::size_t q, std::size_t s, const Pack& p) const {
    const std::size_t i = ((q * radix + k) * stride + s) * lanes;
    store(p, out_re + i, out_im + i);
  }
};

using Roots = std::pair<const double*, const double*>;

Root root(const Roots& w, std::size_t i) { return {w.first[i], w.second[i]}; }

void radix2(const Views& v, const Roots& w) {
  for (std::size_t q = 0; q < v.groups; ++q) {
    const Root w1 = root(w, q * v.stride);
    for (std::size_t s = 0; s < v.stride; ++s) {
      const Pack a = v.in(0, q, s), b = v.in(1, q, s);
      v.out(0, q, s, a + b);
      v.out(1, q, s, (a - b) * w1);
    }
  }
}

void radix3(const Views& v, const Roots& w) {
  const double half_root3 = 0.86602540378443865;
  for (std::size_t q = 0; q < v.groups; ++q) {
    const Root w1 = root(w, q * v.stride), w2 = root(w, 2 * q * v.stride);
    for (std::size_t s = 0; s < v.stride; ++s) {
      const Pack a = v.in(0, q, s), b = v.in(1, q, s), c = v.in(2, q, s);
      const Pack sum = b + c, across = times_minus_i(b - c) * half_root3;
      const Pack mid = a - sum * 0.5;
      v.out(0, q, s, a + sum);
      v.out(1, q, s, (mid + across) * w1);
      v.out(2, q, s, (mid - across) * w2);
    }
  }
}

void radix4(const Views& v, const Roots& w) {
  for (std::size_t q = 0; q < v.groups; ++q) {
    const Root w1 = root(w, q * v.stride), w2 = root(w, 2 * q * v.stride), w3 = root(w, 3 * q * v.stride);
    for (std::size_t s = 0; s < v.stride; ++s) {
      const Pack a = v.in(0, q, s), b = v.in(1, q, s), c = v.in(2, q, s), d = v.in(3, q, s);
      const Pack even = a + c, odd = b + d, even_difference = a - c, turned = times_minus_i(b - d);
      v.out(0, q, s, even + odd);
      v.out(1, q, s, (even_difference + turned) * w1);
      v.out(2, q, s, (even - odd) * w2);
      v.out(3, q, s, (even_difference - turned) * w3);
    }
  }
}

void radix5(const Views& v, const Roots& w) {
  const double c1 = 0.30901699437494742, s1 = 0.95105651629515357, c2 = -0.80901699437494742, s2 = 0.58778525229247313;
  for (std::size_t q = 0; q < v.groups; ++q) {
    const std::size_t step = q * v.stride;
    const Root w1 = root(w, step), w2 = root(w, 2 * step), w3 = root(w, 3 * step), w4 = root(w, 4 * step);
    for (std::size_t s = 0; s < v.stride; ++s) {
      const Pack a = v.in(0, q, s), b = v.in(1, q, s), c = v.in(2, q, s), d = v.in(3, q, s), e = v.in(4, q, s);
      const Pack be = b + e, cd = c + d, b_e = times_minus_i(b - e), c_d = times_minus_i(c - d);
      const Pack near = a + be * c1 + cd * c2, far = a + be * c2 + cd * c1;
      const Pack near_across = b_e * s1 + c_d * s2, far_across = b_e * s2 - c_d * s1;
      v.out(0, q, s, a + be + cd);
      v.out(1, q, s, (near + near_across) * w1);
      v.out(2, q, s, (far + far_across) * w2);
      v.out(3, q, s, (far - far_across) * w3);
      v.out(4, q, s, (near - near_across) * w4);
    }
  }
}

// A butterfly of any odd radix p by the definition; the p-th roots of unity are every (n / p)-th of the n-th.
void radix_any(const Views& v, const Roots& w, std::size_t n) {
  const std::size_t p = v.radix, step = n / p;
  Pack a[FourierPlan::max_radix];
  for (std::size_t q = 0; q < v.groups; ++q)
    for (std::size_t s = 0; s < v.stride; ++s) {
      for (std::size_t j = 0; j < p; ++j) a[j] = v.in(j, q, s);
      for (std::size_t k = 0; k < p; ++k) {
        Pack sum = a[0];
        for (std::size_t j = 1; j < p; ++j) sum = sum + a[j] * root(w, j * k % p * step);
        v.out(k, q, s, sum * root(w, q * k * v.stride));
      }
    }
}

std::vector<std::size_t> radices(std::size_t n) {
  std::vector<std::size_t> out;
  for (std::size_t p : {4u, 2u, 3u, 5u})
    for (; n % p == 0; n /= p) out.push_back(p);
  for (std::size_t p = 7; n > 1; p += 2)
    for (; n % p == 0; n /= p) out.push_back(p);
  return out;
}

}  // namespace

FourierPlan::FourierPlan(std::size_t n) : n_(n), scratch_size_(2 * n * lanes) {
  assert(n >= 1);
  const std::vector<std::size_t> factors = radices(n);
  if (factors.empty() || *std::max_element(factors.begin(), factors.end()) <= max_radix) {
    std::size_t left = n, done = 1;
    for (const std::size_t p : factors) {
      left /= p;
      stages_.push_back({p, left, done});
      done *= p;
    }
    for (std::size_t k = 0; k < n; ++k) {
      const SineCosine w = unit_root(k, n);
      cos_.push_back(w.cosine), sin_.push_back(-w.sine);
    }
    return;
  }

  // Bluestein: jk = (j² + k² - (k - j)²) / 2 turns the transform into a convolution with the chirp e^(+πi j²/n),
  // between two multiplications by its conjugate. The chirp's angles are reduced in integers.
  for (std::size_t k = 0; k < n; ++k) {
    const SineCosine w = unit_root(k * k % (2 * n), 2 * n);
    cos_.push_back(w.cosine), sin_.push_back(-w.sine);
  }
  const std::size_t m = fast_size(2 * n - 1);
  padded_ = std::make_unique<FourierPlan>(m);
  scratch_size_ = 2 * m * lanes + padded_->scratch_size_;
  std::vector<double> re(m * lanes), im(m * lanes), scratch = padded_->make_scratch();
  for (std::size_t k = 0; k < n; ++k)
    for (const std::size_t at : {k, (m - k) % m}) re[at * lanes] = cos_[k], im[at * lanes] = -sin_[k];
  padded_->forward(re.data(), im.data(), scratch);
  for (std::size_t k = 0; k < m; ++k) {
    filter_re_.push_back(re[k * lanes] / static_cast<double>(m));
    filter_im_.push_back(im[k * lanes] / static_cast<double>(m));
  }
}

void FourierPlan::forward(double* re, double* im, double* scratch) const {
  padded_ ? run_chirp(re, im, scratch) : run_stages(re, im, scratch);
}

void FourierPlan::run_stages(double* re, double* im, double* scratch) const {
  // Each stage reads one buffer and writes the other; after an odd number of stages the result is in the scratch
  // buffer.
  double *from_re = re, *from_im = im, *to_re = scratch, *to_im = scratch + n_ * lanes;
  const Roots w{cos_.data(), sin_.data()};
  for (const Stage& stage : stages_) {
    const Views v{from_re, from_im, to_re, to_im, stage.groups, stage.stride, stage.radix};
    switch (stage.radix) {
      case 2:
        radix2(v, w);
        break;
      case 3:
        radix3(v, w);
        break;
      case 4:
        radix4(v, w);
        break;
      case 5:
        radix5(v, w);
        break;
      default:
        radix_any(v, w, n_);
    }
    std::swap(from_re, to_re), std::swap(from_im, to_im);
  }
  if (from_re != re) std::copy_n(from_re, n_ * lanes, re), std::copy_n(from_im, n_ * lanes, im);
}

void FourierPlan::run_chirp(double* re, double* im, double* scratch) const {
  const std::size_t m = padded_->n_;
  double *a_re = scratch, *a_im = scratch + m * lanes, *rest = scratch + 2 * m * lanes;
  std::fill_n(scratch, 2 * m * lanes, 0.0);
  for (std::size_t k = 0; k < n_; ++k)
    store(load(re + k * lanes, im + k * lanes) * Root{cos_[k], sin_[k]}, a_re + k * lanes, a_im + k * lanes);
  padded_->forward(a_re, a_im, rest);
  for (std::size_t k = 0; k < m; ++k)
    store(load(a_re + k * lanes, a_im + k * lanes) * Root{filter_re_[k], filter_im_[k]}, a_re + k * lanes,
          a_im + k * lanes);
  padded_->forward(a_im, a_re, rest);
  for (std::size_t k = 0; k < n_; ++k)
    store(load(a_re + k * lanes, a_im + k * lanes) * Root{cos_[k], sin_[k]}, re + k * lanes, im + k * lanes);
}

std::size_t fast_size(std::size_t n) {
  for (std::size_t size = std::max<std::size_t>(1, n);; ++size) {
    std::size_t left = size;
    for (std::size_t p : {2u, 3u, 5u})
      while (left % p == 0) left /= p;
    if (left == 1) return size;
  }
}

}  // namespace zoneplate
