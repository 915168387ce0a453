// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "zoneplate/codec/system/stored_image.h"
#include "zoneplate/os/library.h"

namespace zoneplate {

/// Decodes an image by a shared library in a child process with limits; in a LimitedChild, which has limits already, in
/// that process.
///
/// `place` is the prefix of error messages, `memory` the bytes that decoding takes at most. `decode` opens the library
/// as a SharedLibrary.
/// Errors    those of `decode`; ErrorKind::Input as LimitedChild for a child that fails, or that answers with more than
///           `max_pixels` pixels; as SharedLibrary for a library that is not installed.
StoredImage decode_in_child(const std::string& place, Library library, std::uint64_t memory, std::uint64_t max_pixels,
                            const std::function<StoredImage()>& decode);

}  // namespace zoneplate
