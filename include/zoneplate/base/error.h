// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#pragma GCC visibility push(default)
namespace zoneplate {

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
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  /// The kind of the error; `what()` is its message.
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

}  // namespace zoneplate
#pragma GCC visibility pop
