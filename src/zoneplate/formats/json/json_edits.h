// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/formats/json/json.h"

namespace zoneplate {

/// The value that a JSON pointer (RFC 6901) identifies below `root`; null where there is none.
JsonValue* find_at(JsonValue& root, std::string_view pointer);

/// Temporary changes of a JSON tree, which `undo` takes back. A change invalidates the JsonViews of the objects that
/// contain the changed value.
class JsonEdits {
 public:
  /// `root` must outlive the edits.
  explicit JsonEdits(JsonValue& root) : root_(root) {}

  /// Sets the element of a list, or the property of an object, that the pointer identifies; a missing property is
  /// added. Returns false where the list or object does not exist.
  bool set(std::string_view pointer, JsonValue value);

  /// The value as it is now; null where there is none.
  const JsonValue* find(std::string_view pointer) const { return find_at(root_, pointer); }

  /// Restores the tree to its state before the first `set`.
  void undo();

  /// Whether a value whose pointer begins with `prefix` is changed.
  bool touch(std::string_view prefix) const;

 private:
  struct Edit {
    std::string pointer;
    std::optional<JsonValue> before;  ///< nothing: the property was missing
  };
  JsonValue& root_;
  std::vector<Edit> edits_;
};

}  // namespace zoneplate
