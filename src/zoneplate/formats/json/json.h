// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"

namespace zoneplate {

/// A JSON value. This type is independent of the JSON library, which only one source file uses, and every value is
/// charged to the memory budget.
struct JsonValue {
  enum class Kind : std::uint8_t { Null, Boolean, Number, Text, List, Object };
  Kind kind = Kind::Null;
  bool boolean = false;
  double number = 0;  ///< integers are exact up to 2^53
  std::string text{};
  std::vector<JsonValue> items{};   ///< elements of a list, or values of an object
  std::vector<std::string> keys{};  ///< one key per item of an object; in the file's order, or sorted if there are many

  /// The keys of an object with more than this number are sorted for binary search; equal ones keep the file's order.
  static constexpr std::size_t max_unsorted_keys = 64;
};

/// Parses a JSON text; trailing white space and zero bytes are ignored.
///
/// Errors    ErrorKind::Input: not JSON or not UTF-8 (with line and column), nested deeper than 64 values, exceeding
///           the budget's memory or time.
JsonValue parse_json(std::span<const std::uint8_t> bytes, ImportBudget& budget);

/// A text of the file in the form for messages: quoted, on one line, truncated.
std::string quoted(const std::string& text);

/// An object of the file, with its name for messages: "chair.gltf: mesh 3 primitive 0".
///
/// For a missing key, accessors return the default, or throw if there is none; a value of the wrong type is an error.
class JsonView {
 public:
  /// Errors    ErrorKind::Input if `value` is not an object.
  JsonView(const JsonValue& value, std::string place);

  const std::string& place() const { return place_; }
  /// The same object with another name in messages.
  JsonView renamed(std::string place) const { return {*value_, std::move(place)}; }
  [[noreturn]] void fail(const std::string& cause) const;

  bool has(const char* key) const { return find(key) != nullptr; }
  bool is_number(const char* key) const;
  std::span<const std::string> keys() const { return value_->keys; }

  /// The object under `key`; an empty object if it is missing. Its name in messages is this one's followed by `name`.
  JsonView object(const char* key, const std::string& name) const;
  JsonView object(const char* key) const { return object(key, key); }
  /// extensions.`name`, if present; null is not.
  std::optional<JsonView> extension(const char* name) const;

  std::size_t count(const char* list) const;
  /// Element i of a list of objects, named "`name` i".
  JsonView element(const char* list, std::size_t i, const std::string& name) const;

  bool flag(const char* key, bool otherwise) const;
  std::string text(const char* key, const std::string& otherwise = {}) const;
  /// A finite float.
  float number(const char* key, std::optional<float> otherwise = std::nullopt) const;
  /// An integer in [0, limit].
  std::uint64_t whole(const char* key, std::optional<std::uint64_t> otherwise = std::nullopt,
                      std::uint64_t limit = std::uint64_t{1} << 53) const;
  /// An index into a list of `count` elements; nothing if the key is missing.
  std::optional<std::size_t> find_index(const char* key, std::size_t count) const;
  /// An index into a list of `count` elements; the key is required.
  std::size_t index(const char* key, std::size_t count) const;
  /// A list of finite floats; empty if it is missing, otherwise of `count` elements (0: any number).
  std::vector<float> numbers(const char* key, std::size_t count) const;
  /// The same numbers as doubles.
  std::vector<double> doubles(const char* key, std::size_t count) const;
  /// A list of indices into a list of `count` elements; empty if it is missing.
  std::vector<std::size_t> indices(const char* key, std::size_t count) const;
  std::vector<std::string> texts(const char* key) const;

 private:
  const JsonValue* find(const char* key) const;
  const JsonValue* find(const char* key, JsonValue::Kind kind) const;
  std::span<const JsonValue> list(const char* key) const;
  template <class T>
  std::vector<T> number_list(const char* key, std::size_t count) const;

  const JsonValue* value_;
  std::string place_;
};

}  // namespace zoneplate
