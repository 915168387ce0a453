// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "zoneplate/image/hash_for_test.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// Writes the colours as a PFM.
inline void write_image(std::ofstream& file, const LinearImage& image) {
  file << "PF\n" << image.width() << ' ' << image.height() << "\n-1\n";
  for (int y = image.height(); y-- > 0;)
    for (int x = 0; x < image.width(); ++x)
      file.write(reinterpret_cast<const char*>(&image(x, y).r), 3 * sizeof(float));
}
inline const char* ending_of(const LinearImage&) { return ".pfm"; }

/// Writes a Targa of 32 bits a pixel, rows from the top.
inline void write_image(std::ofstream& file, const Rgba8Image& image) {
  const auto low = [](int x) { return static_cast<char>(x & 255); };
  const auto high = [](int x) { return static_cast<char>(x >> 8); };
  const char header[18] = {0,
                           0,
                           2,
                           0,
                           0,
                           0,
                           0,
                           0,
                           0,
                           0,
                           0,
                           0,
                           low(image.width()),
                           high(image.width()),
                           low(image.height()),
                           high(image.height()),
                           32,
                           0x28};
  file.write(header, sizeof header);
  for (const Rgba8 c : image.values())
    for (const std::uint8_t v : {c.b, c.g, c.r, c.a}) file.put(static_cast<char>(v));
}
inline const char* ending_of(const Rgba8Image&) { return ".tga"; }

/// Compares an image with a golden hash. One that differs is left in the folder `goldens`. The repository has no golden
/// images: with ZONEPLATE_GOLDENS=FOLDER in the environment, every image is left in that folder, so that those of an
/// earlier commit are the expected ones of `zoneplate metrics FOLDER goldens --report page.html`.
template <class Image>
void expect_golden(std::string name, const Image& image, std::uint64_t hash) {
  const std::uint64_t found = hash_of(image);
  const char* const all = std::getenv("ZONEPLATE_GOLDENS");
  if (found == hash && all == nullptr) return;
  for (char& c : name)
    if (std::string(" /:,=").find(c) != std::string::npos) c = '-';
  const std::filesystem::path folder = all == nullptr ? "goldens" : all, place = folder / (name + ending_of(image));
  std::filesystem::create_directories(folder);
  std::ofstream file(place, std::ios::binary);
  write_image(file, image);
  EXPECT_EQ(found, hash) << name << ": 0x" << std::hex << found << "u; the image is " << place;
}

}  // namespace zoneplate
