// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/base/error.h"

namespace zoneplate::cli {

/// The exit code of a program that ends with an error of this kind.
constexpr int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::Failed:
      return 1;
    case ErrorKind::Usage:
      return 2;
    case ErrorKind::Input:
      return 3;
    case ErrorKind::Output:
      return 4;
  }
  return 1;
}

}  // namespace zoneplate::cli
