// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <new>

namespace zoneplate {

/// An object of a C library and the function that frees it.
///
/// Errors    std::bad_alloc, where the library made none.
template <class T, class Free>
std::unique_ptr<T, Free> owned(T* object, Free free) {
  if (!object) throw std::bad_alloc();
  return {object, free};
}

}  // namespace zoneplate
