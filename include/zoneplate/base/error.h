// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "zoneplate/base/api.h"

namespace ZONEPLATE_API zoneplate {

/// The kind of an error; the command line maps it to its exit code.
enum class ErrorKind {
  Failed,  ///< rendering or another run-time failure (exit 1)
  Usage,   ///< a wrong option, value or combination (exit 2)
  Input,   ///< an input that is missing, corrupt or unsupported (exit 3)
  Output,  ///< an output that cannot be written (exit 4)
};

/// The exception of the library: an input (a file, a scene, an argument) is invalid, or the system fails.
///
/// The message is one line that names the place, what was found and what was expected:
/// `chair.gltf: mesh 3: POSITION holds 12 bytes, expected 36 (3 vertices)`.
class Error : public std::runtime_error {
 public:
  /// An error with its message, one line without a line end.
  Error(ErrorKind trouble, const std::string& message) : std::runtime_error(message), trouble_(trouble) {}
  /// The kind of the error; `what()` is its message.
  ErrorKind trouble() const { return trouble_; }

 private:
  ErrorKind trouble_;
};

}  // namespace zoneplate
