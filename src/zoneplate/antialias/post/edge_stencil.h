// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zoneplate {

/// The rows that an edge row is computed from: two above, one above, the row itself, one below.
///
/// Shape     valid from two values before the first to 33 after the last.
template <class T>
struct EdgeRows {
  const T* row[4];
};

}  // namespace zoneplate
