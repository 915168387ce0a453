// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openexr.h>

#include <string>

#include "zoneplate/os/library.h"

namespace zoneplate {

/// The reason why an image is rejected.
struct ExrRefusal {
  std::string cause;
};

/// The functions of libOpenEXRCore that the reader calls. The library is loaded at run time; the program is not linked
/// to it.
struct ExrLibrary {
  SharedLibrary library;
  decltype(&exr_start_read) start_read = library.find("exr_start_read");
  decltype(&exr_finish) finish = library.find("exr_finish");
  decltype(&exr_get_default_error_message) error_text = library.find("exr_get_default_error_message");
  decltype(&exr_get_storage) storage = library.find("exr_get_storage");
  decltype(&exr_get_channels) channels = library.find("exr_get_channels");
  decltype(&exr_get_scanlines_per_chunk) scanlines_per_chunk = library.find("exr_get_scanlines_per_chunk");
  decltype(&exr_get_tile_sizes) tile_sizes = library.find("exr_get_tile_sizes");
  decltype(&exr_read_scanline_chunk_info) scanline_chunk = library.find("exr_read_scanline_chunk_info");
  decltype(&exr_read_tile_chunk_info) tile_chunk = library.find("exr_read_tile_chunk_info");
  decltype(&exr_decoding_initialize) begin_decoding = library.find("exr_decoding_initialize");
  decltype(&exr_decoding_choose_default_routines) choose_routines =
      library.find("exr_decoding_choose_default_routines");
  decltype(&exr_decoding_run) decode = library.find("exr_decoding_run");
  decltype(&exr_decoding_destroy) end_decoding = library.find("exr_decoding_destroy");

  explicit ExrLibrary(const std::string& file) : library(Library::OpenExr, file + ": an EXR image") {}

  void check(exr_result_t result) const {
    if (result == EXR_ERR_FEATURE_NOT_IMPLEMENTED) throw ExrRefusal{"is packed in a way that is not read"};
    if (result != EXR_ERR_SUCCESS) throw ExrRefusal{std::string("is corrupt or cut off: ") + error_text(result)};
  }
};

}  // namespace zoneplate
