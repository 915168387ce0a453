// SPDX-License-Identifier: Apache-2.0
// The same metrics by scikit-image, if Debian's python3-skimage is installed, on five pairs of generated images.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "zoneplate/math/random.h"
#include "zoneplate/metrics/charts_for_test.h"
#include "zoneplate/metrics/psnr.h"
#include "zoneplate/metrics/ssim/ssim.h"

namespace zoneplate::metrics {
namespace {

constexpr const char* program = R"(
import sys, numpy
try:
    from skimage.metrics import structural_similarity, peak_signal_noise_ratio
except ImportError:
    print("none")
    sys.exit()
pairs = numpy.fromfile(sys.argv[1]).reshape(-1, 2, int(sys.argv[2]), int(sys.argv[3]))
for a, b in pairs:
    print(structural_similarity(a, b, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1),
          peak_signal_noise_ratio(a, b, data_range=1),
          structural_similarity(a, b, data_range=1), structural_similarity(a, b, win_size=9, use_sample_covariance=False, data_range=1))
)";

/// The grey values of a pair as doubles; the pairs are the four charts, and noise of two amplitudes.
struct GreyPair {
  Plane<double> reference, test;
};

std::vector<GreyPair> grey_pairs() {
  std::vector<GreyPair> pairs;
  for (int which = 0; which < 4; ++which) {
    const ChartPair chart = chart_pair(which);
    pairs.push_back({luma_plane(as_codes(chart.reference)), luma_plane(as_codes(chart.test))});
  }
  GreyPair noise{Plane<double>(256, 128), Plane<double>(256, 128)};
  for (std::uint32_t i = 0; i < noise.reference.values().size(); ++i) {
    noise.reference.values()[i] = unit_float(hash(i));
    noise.test.values()[i] = 0.8 * noise.reference.values()[i] + 0.2 * static_cast<double>(unit_float(hash(i, 1)));
  }
  pairs.push_back(noise);
  return pairs;
}

double psnr_of(const GreyPair& pair) {
  double sum = 0;
  for (std::size_t i = 0; i < pair.reference.values().size(); ++i) {
    const double d = pair.reference.values()[i] - pair.test.values()[i];
    sum += d * d;
  }
  return psnr_of_mse(sum / static_cast<double>(pair.reference.values().size()));
}

/// The output of the script for the pairs in a file.
std::string output_of_python(const std::string& script, const std::string& data) {
  const std::string command = "/usr/bin/python3 '" + script + "' '" + data + "' 128 256 2>/dev/null";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  std::string text;
  std::array<char, 4096> part{};
  while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe)) text.append(part.data(), n);
  ::pclose(pipe);
  return text;
}

TEST(Skimage, AgreesOnSsimAndPsnr) {
  const auto folder = std::filesystem::temp_directory_path() / ("zoneplate_skimage_test_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string script = (folder / "metrics.py").string(), data = (folder / "pairs.bin").string();
  std::ofstream(script) << program;
  const std::vector<GreyPair> pairs = grey_pairs();
  std::ofstream out(data, std::ios::binary);
  for (const GreyPair& pair : pairs) {
    for (const Plane<double>* plane : {&pair.reference, &pair.test}) {
      out.write(reinterpret_cast<const char*>(plane->values().data()),
                static_cast<std::streamsize>(plane->values().size_bytes()));
    }
  }
  out.close();
  const std::string text = output_of_python(script, data);
  std::filesystem::remove_all(folder);
  if (text.empty() || text.starts_with("none")) GTEST_SKIP() << "python3-skimage is not installed";

  const char* at = text.c_str();
  for (const GreyPair& pair : pairs) {
    double ssim = 0, psnr = 0, uniform7 = 0, uniform9 = 0;
    int length = 0;
    ASSERT_EQ(std::sscanf(at, "%lf %lf %lf %lf%n", &ssim, &psnr, &uniform7, &uniform9, &length), 4) << text;
    at += length;
    EXPECT_NEAR(structural_similarity(pair.reference, pair.test).ssim, ssim, 1e-10);
    EXPECT_NEAR(psnr_of(pair), psnr, 1e-10);
    EXPECT_NEAR(structural_similarity(pair.reference, pair.test, {7, true}).ssim, uniform7, 1e-10);
    EXPECT_NEAR(structural_similarity(pair.reference, pair.test, {9, false}).ssim, uniform9, 1e-10);
  }
}

}  // namespace
}  // namespace zoneplate::metrics
