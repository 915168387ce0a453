// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/version.h"

#include <draco/core/draco_version.h>
#include <expat.h>
#include <fmt/format.h>
#include <ft2build.h>
#include <hwy/highway.h>
#include <png.h>
#include <seccomp.h>
#include <webp/decode.h>
#include <zlib.h>
#include <CLI/Version.hpp>
#include <nlohmann/json.hpp>
#include FT_FREETYPE_H

#include <cstddef>
#include <cstdio>

#include <jpeglib.h>

#include "zoneplate/base/isa.h"
#include "zoneplate/commit.h"
#include "zoneplate/version.h"

#define ZONEPLATE_QUOTED(text) #text
#define ZONEPLATE_VALUE(macro) ZONEPLATE_QUOTED(macro)

namespace zoneplate::cli {
namespace {

std::string compiler() {
#if defined(__clang__)
  return fmt::format("clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  return fmt::format("gcc {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#endif
}

std::string freetype_version() {
  FT_Library library;
  if (FT_Init_FreeType(&library) != 0) return "unknown";
  int major = 0, minor = 0, patch = 0;
  FT_Library_Version(library, &major, &minor, &patch);
  FT_Done_FreeType(library);
  return fmt::format("{}.{}.{}", major, minor, patch);
}

std::string webp_version() {
  const int v = WebPGetDecoderVersion();
  return fmt::format("{}.{}.{}", v >> 16, v >> 8 & 255, v & 255);
}

std::string seccomp_library_version() {
  const scmp_version* const v = ::seccomp_version();
  return fmt::format("{}.{}.{}", v->major, v->minor, v->micro);
}

std::string expat_version() {
  const XML_Expat_Version v = XML_ExpatVersionInfo();
  return fmt::format("{}.{}.{}", v.major, v.minor, v.micro);
}

}  // namespace

std::string version_text() {
  return fmt::format(
      "zoneplate {} ({}, {})\n"
      "commit {}\n"
      "licence Apache-2.0\n"
      "libpng {}, zlib {}, libjpeg-turbo {}, libwebp {}, FreeType {}, Draco {}, libseccomp {}, expat {}, minizip (of "
      "zlib)\n"
      "fmt {}.{}.{}, Highway {}.{}.{}, JSON for Modern C++ {}.{}.{}, CLI11 {}\n"
      // Its licence requires this statement of programs (THIRD_PARTY.md).
      "Uses Jimenez's MLAA. Copyright (C) 2010 by Jorge Jimenez, Belen Masia, Jose I. Echevarria, Fernando Navarro and "
      "Diego Gutierrez.\n",
      version, name_of(best_isa()), compiler(), commit, png_get_libpng_ver(nullptr), ::zlibVersion(),
      ZONEPLATE_VALUE(LIBJPEG_TURBO_VERSION), webp_version(), freetype_version(), draco::kDracoVersion,
      seccomp_library_version(), expat_version(), FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100,
      HWY_MAJOR, HWY_MINOR, HWY_PATCH, NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
      NLOHMANN_JSON_VERSION_PATCH, CLI11_VERSION);
}

}  // namespace zoneplate::cli
