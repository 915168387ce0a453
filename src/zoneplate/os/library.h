// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "zoneplate/base/error.h"

namespace zoneplate {

/// Shared libraries that few files need. Each is loaded by the first such file: loading one takes as long as rendering
/// a small image.
enum class Library { Assimp, Avif, Jxl, Meshoptimizer, OpenExr, Tiff, Zstd, Lcms };

/// Thrown in a sandboxed child, which must not load code, for a library that its parent did not open. It is not an
/// Error, so that code which continues without an unreadable texture does not omit a readable one.
class LibraryNeeded : public std::runtime_error {
 public:
  /// `message` is the error message if the library is not installed.
  LibraryNeeded(Library library, const std::string& message) : std::runtime_error(message), library_(library) {}
  Library library() const { return library_; }

 private:
  Library library_;
};

/// Opens a library for the rest of the process; later child processes inherit it. False if it is not installed.
bool open_library(Library library);

/// The functions of an open library.
class SharedLibrary {
 public:
  /// Opens the library if it is not open yet. `place` is the prefix of error messages.
  ///
  /// Errors    ErrorKind::Input naming the library and its package if it is not installed; LibraryNeeded.
  SharedLibrary(Library library, const std::string& place);

  /// A function, which converts to a pointer of its type: decltype(&f) f = library.find("f").
  class Found {
   public:
    explicit Found(void (*address)()) : address_(address) {}
    template <class Function>
    operator Function*() const {  // implicit: its users state the type
      return reinterpret_cast<Function*>(address_);
    }

   private:
    void (*address_)();
  };

  /// Errors    ErrorKind::Input if the library has no such function.
  Found find(const char* symbol) const;

 private:
  Library library_;
  std::string place_;
};

}  // namespace zoneplate
