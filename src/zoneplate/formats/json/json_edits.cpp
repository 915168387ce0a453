// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/json/json_edits.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <utility>

namespace zoneplate {
namespace {

/// A reference token with its escapes ~1 and ~0 replaced by / and ~.
std::string unescaped(std::string_view token) {
  std::string out;
  for (std::size_t i = 0; i < token.size(); ++i) {
    const bool is_escape = token[i] == '~' && i + 1 < token.size() && (token[i + 1] == '0' || token[i + 1] == '1');
    out += is_escape ? (token[i + 1] == '0' ? '~' : '/') : token[i];
    if (is_escape) ++i;
  }
  return out;
}

std::optional<std::size_t> find_key(const JsonValue& object, const std::string& key) {
  // Of equal keys the last one counts, as in JsonView.
  for (std::size_t i = object.keys.size(); i-- > 0;)
    if (object.keys[i] == key) return i;
  return std::nullopt;
}

JsonValue* find_child(JsonValue& parent, std::string_view token) {
  if (parent.kind == JsonValue::Kind::List) {
    std::size_t i = 0;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), i);
    const bool is_index = error == std::errc() && end == token.data() + token.size() && i < parent.items.size();
    return is_index ? &parent.items[i] : nullptr;
  }
  if (parent.kind != JsonValue::Kind::Object) return nullptr;
  const auto i = find_key(parent, unescaped(token));
  return i ? &parent.items[*i] : nullptr;
}

void erase(JsonValue& object, const std::string& key) {
  const auto i = find_key(object, key);
  if (!i) return;
  object.keys.erase(object.keys.begin() + static_cast<std::ptrdiff_t>(*i));
  object.items.erase(object.items.begin() + static_cast<std::ptrdiff_t>(*i));
}

std::pair<std::string_view, std::string_view> split_last(std::string_view pointer) {
  const std::size_t slash = pointer.rfind('/');
  return {pointer.substr(0, slash), pointer.substr(slash + 1)};
}

}  // namespace

JsonValue* find_at(JsonValue& root, std::string_view pointer) {
  JsonValue* at = &root;
  while (at != nullptr && !pointer.empty()) {
    if (pointer.front() != '/') return nullptr;
    pointer.remove_prefix(1);
    const std::string_view token = pointer.substr(0, pointer.find('/'));
    at = find_child(*at, token);
    pointer.remove_prefix(token.size());
  }
  return at;
}

bool JsonEdits::set(std::string_view pointer, JsonValue value) {
  if (pointer.empty() || pointer.front() != '/') return false;
  const auto [parent_pointer, last] = split_last(pointer);
  JsonValue* const parent = find_at(root_, parent_pointer);
  if (parent == nullptr) return false;
  if (JsonValue* const there = find_child(*parent, last)) {
    edits_.push_back({std::string(pointer), std::exchange(*there, std::move(value))});
    return true;
  }
  // Objects of many keys are sorted; glTF objects that lack a property have few keys.
  if (parent->kind != JsonValue::Kind::Object || parent->keys.size() >= JsonValue::max_unsorted_keys) return false;
  edits_.push_back({std::string(pointer), std::nullopt});
  parent->keys.push_back(unescaped(last));
  parent->items.push_back(std::move(value));
  return true;
}

void JsonEdits::undo() {
  for (; !edits_.empty(); edits_.pop_back()) {
    Edit& edit = edits_.back();
    const auto [parent_pointer, last] = split_last(edit.pointer);
    if (edit.before)
      *find_at(root_, edit.pointer) = std::move(*edit.before);
    else if (JsonValue* const parent = find_at(root_, parent_pointer))
      erase(*parent, unescaped(last));
  }
}

bool JsonEdits::touch(std::string_view prefix) const {
  return std::any_of(edits_.begin(), edits_.end(), [&](const Edit& edit) { return edit.pointer.starts_with(prefix); });
}

}  // namespace zoneplate
