// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/json/json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

namespace zoneplate {
namespace {

constexpr std::size_t max_depth = 64;  // maximum nesting: glTF has 8 levels, extensions and extras a few more

/// Builds the tree from the JSON library's events, and throws if a limit is exceeded.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit TreeBuilder(ImportBudget& budget) : budget_(budget) {}

  JsonValue take_root() { return std::move(root_); }

  bool null() override { return add({}); }
  bool boolean(bool v) override { return add({.kind = JsonValue::Kind::Boolean, .boolean = v}); }
  bool number_integer(number_integer_t v) override { return add_number(static_cast<double>(v)); }
  bool number_unsigned(number_unsigned_t v) override { return add_number(static_cast<double>(v)); }
  bool number_float(number_float_t v, const string_t&) override { return add_number(v); }
  bool string(string_t& v) override {
    budget_.take(v.size());
    return add({.kind = JsonValue::Kind::Text, .text = std::move(v)});
  }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(JsonValue::Kind::Object); }
  bool start_array(std::size_t) override { return open(JsonValue::Kind::List); }
  bool key(string_t& v) override {
    budget_.take(v.size() + 2 * sizeof(std::string));
    open_.back()->keys.push_back(std::move(v));
    return true;
  }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& e) override {
    // The library's messages have the form "[json.exception.parse_error.101] parse error at line 1, column 2: ...".
    const std::string text = e.what();
    const std::size_t end = text.find("] ");
    throw Error(ErrorKind::Input, budget_.file() + ": not JSON: " + one_line(text.substr(end + 2)));
  }

 private:
  static std::string one_line(std::string text) {
    for (char& c : text)
      if (static_cast<unsigned char>(c) < ' ') c = ' ';
    return text.substr(0, 200);
  }
  bool add_number(double v) { return add({.kind = JsonValue::Kind::Number, .number = v}); }

  /// The capacity of a list doubles, so that a value may take twice its own size.
  bool add(JsonValue&& value) {
    constexpr std::uint64_t values_per_check = 1024;
    if (++count_ % values_per_check == 0) budget_.check_time();
    budget_.take(2 * sizeof(JsonValue));
    last_ = open_.empty() ? &root_ : &open_.back()->items.emplace_back();
    *last_ = std::move(value);
    return true;
  }
  bool open(JsonValue::Kind kind) {
    if (open_.size() == max_depth)
      throw Error(ErrorKind::Input, budget_.file() + ": JSON nested deeper than " + std::to_string(max_depth));
    add({.kind = kind});
    open_.push_back(last_);  // the address is stable, because only the innermost open list grows
    return true;
  }
  bool close() {
    if (open_.back()->keys.size() > JsonValue::max_unsorted_keys) sort_keys(*open_.back());
    open_.pop_back();
    return true;
  }

  void sort_keys(JsonValue& object) {
    const std::size_t count = object.keys.size();
    const std::uint64_t working = count * (sizeof(std::size_t) + sizeof(std::string) + sizeof(JsonValue));
    budget_.take(working);
    budget_.check_time();
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const int difference = object.keys[a].compare(object.keys[b]);
      return difference != 0 ? difference < 0 : a < b;
    });
    std::vector<std::string> keys(count);
    std::vector<JsonValue> items(count);
    for (std::size_t i = 0; i < count; ++i)
      keys[i] = std::move(object.keys[order[i]]), items[i] = std::move(object.items[order[i]]);
    object.keys = std::move(keys), object.items = std::move(items);
    budget_.give_back(working);
  }

  ImportBudget& budget_;
  std::uint64_t count_ = 0;  ///< number of values so far
  JsonValue root_;
  JsonValue* last_ = nullptr;
  std::vector<JsonValue*> open_;
};

const char* name_of(JsonValue::Kind kind) {
  switch (kind) {
    case JsonValue::Kind::Null:
      return "null";
    case JsonValue::Kind::Boolean:
      return "a boolean";
    case JsonValue::Kind::Number:
      return "a number";
    case JsonValue::Kind::Text:
      return "a string";
    case JsonValue::Kind::List:
      return "an array";
    case JsonValue::Kind::Object:
      return "an object";
  }
  return "";
}

std::string join(const std::string& place, const std::string& name) { return place + " " + name; }

/// Formats a number in its usual form: 3, 1e+300, -0.5.
std::string text_of(double number) {
  const bool is_whole = std::abs(number) < 1e15 && number == std::floor(number);
  return is_whole ? std::to_string(static_cast<std::int64_t>(number)) : nlohmann::json(number).dump();
}

}  // namespace

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text.substr(0, 120)) out += static_cast<unsigned char>(c) < ' ' || c == 0x7f ? '?' : c;
  return out + (text.size() > 120 ? "...'" : "'");
}

JsonValue parse_json(std::span<const std::uint8_t> bytes, ImportBudget& budget) {
  while (!bytes.empty() && bytes.back() == 0) bytes = bytes.first(bytes.size() - 1);
  TreeBuilder builder(budget);
  const char* text = reinterpret_cast<const char*>(bytes.data());
  nlohmann::json::sax_parse(text, text + bytes.size(), &builder);
  return builder.take_root();
}

JsonView::JsonView(const JsonValue& value, std::string place) : value_(&value), place_(std::move(place)) {
  if (value.kind != JsonValue::Kind::Object) fail(std::string("is ") + name_of(value.kind) + ", expected an object");
}

void JsonView::fail(const std::string& cause) const {
  throw Error(ErrorKind::Input, place_ + (place_.ends_with(':') ? " " : ": ") + cause);
}

const JsonValue* JsonView::find(const char* key) const {
  // Of equal keys the last one is used.
  if (value_->keys.size() > JsonValue::max_unsorted_keys) {
    const auto after = std::upper_bound(value_->keys.begin(), value_->keys.end(), key);
    const bool is_found = after != value_->keys.begin() && after[-1] == key;
    return is_found ? &value_->items[static_cast<std::size_t>(after - value_->keys.begin()) - 1] : nullptr;
  }
  for (std::size_t i = value_->keys.size(); i-- > 0;)
    if (value_->keys[i] == key) return &value_->items[i];
  return nullptr;
}

const JsonValue* JsonView::find(const char* key, JsonValue::Kind kind) const {
  const JsonValue* v = find(key);
  if (v && v->kind != kind) fail(std::string(key) + " is " + name_of(v->kind) + ", expected " + name_of(kind));
  return v;
}

std::span<const JsonValue> JsonView::list(const char* key) const {
  const JsonValue* v = find(key, JsonValue::Kind::List);
  return v ? std::span<const JsonValue>(v->items) : std::span<const JsonValue>();
}

JsonView JsonView::object(const char* key, const std::string& name) const {
  static const JsonValue empty{.kind = JsonValue::Kind::Object};
  const JsonValue* v = find(key, JsonValue::Kind::Object);
  return {v ? *v : empty, join(place_, name)};
}

std::optional<JsonView> JsonView::extension(const char* name) const {
  const JsonValue* const extensions = find("extensions");
  if (extensions == nullptr || extensions->kind == JsonValue::Kind::Null) return std::nullopt;
  const JsonView all(object("extensions"));
  const JsonValue* const found = all.find(name);
  if (found == nullptr || found->kind == JsonValue::Kind::Null) return std::nullopt;
  return JsonView(*found, join(place_, name));
}

bool JsonView::is_number(const char* key) const {
  const JsonValue* const found = find(key);
  return found != nullptr && found->kind == JsonValue::Kind::Number;
}

std::size_t JsonView::count(const char* key) const { return list(key).size(); }

JsonView JsonView::element(const char* key, std::size_t i, const std::string& name) const {
  return {list(key)[i], join(place_, name + " " + std::to_string(i))};
}

bool JsonView::flag(const char* key, bool otherwise) const {
  const JsonValue* v = find(key, JsonValue::Kind::Boolean);
  return v ? v->boolean : otherwise;
}

std::string JsonView::text(const char* key, const std::string& otherwise) const {
  const JsonValue* v = find(key, JsonValue::Kind::Text);
  return v ? v->text : otherwise;
}

float JsonView::number(const char* key, std::optional<float> otherwise) const {
  const JsonValue* v = find(key, JsonValue::Kind::Number);
  if (!v && !otherwise) fail(std::string(key) + " is missing");
  if (!v) return *otherwise;
  if (!(std::abs(v->number) <= static_cast<double>(std::numeric_limits<float>::max())))
    fail(std::string(key) + " is " + text_of(v->number) + ", expected a number within a float's range");
  return static_cast<float>(v->number);
}

std::uint64_t JsonView::whole(const char* key, std::optional<std::uint64_t> otherwise, std::uint64_t limit) const {
  const JsonValue* v = find(key, JsonValue::Kind::Number);
  if (!v && !otherwise) fail(std::string(key) + " is missing");
  if (!v) return *otherwise;
  if (!(v->number >= 0 && v->number <= static_cast<double>(limit)) || v->number != std::floor(v->number))
    fail(std::string(key) + " is " + text_of(v->number) + ", expected a whole number from 0 to " +
         std::to_string(limit));
  return static_cast<std::uint64_t>(v->number);
}

std::optional<std::size_t> JsonView::find_index(const char* key, std::size_t count) const {
  if (!has(key)) return std::nullopt;
  const std::uint64_t i = whole(key);
  if (i >= count)
    fail(std::string(key) + " is " + std::to_string(i) + ", expected an index below " + std::to_string(count));
  return static_cast<std::size_t>(i);
}

std::size_t JsonView::index(const char* key, std::size_t count) const {
  if (!has(key)) fail(std::string(key) + " is missing");
  return *find_index(key, count);
}

template <class T>
std::vector<T> JsonView::number_list(const char* key, std::size_t count) const {
  if (!has(key)) return {};
  std::vector<T> out;
  for (const JsonValue& v : list(key)) {
    if (v.kind != JsonValue::Kind::Number) fail(std::string(key) + " holds " + name_of(v.kind) + ", expected numbers");
    if (!(std::abs(v.number) <= static_cast<double>(std::numeric_limits<float>::max())))
      fail(std::string(key) + " holds " + text_of(v.number) + ", expected numbers within a float's range");
    out.push_back(static_cast<T>(v.number));
  }
  if (count != 0 && out.size() != count)
    fail(std::string(key) + " holds " + std::to_string(out.size()) + " numbers, expected " + std::to_string(count));
  return out;
}

std::vector<float> JsonView::numbers(const char* key, std::size_t count) const {
  return number_list<float>(key, count);
}
std::vector<double> JsonView::doubles(const char* key, std::size_t count) const {
  return number_list<double>(key, count);
}

std::vector<std::size_t> JsonView::indices(const char* key, std::size_t count) const {
  std::vector<std::size_t> out;
  for (const JsonValue& v : list(key)) {
    if (v.kind != JsonValue::Kind::Number || !(v.number >= 0 && v.number < static_cast<double>(count)) ||
        v.number != std::floor(v.number))
      fail(std::string(key) + " holds " + (v.kind == JsonValue::Kind::Number ? text_of(v.number) : name_of(v.kind)) +
           ", expected indices below " + std::to_string(count));
    out.push_back(static_cast<std::size_t>(v.number));
  }
  return out;
}

std::vector<std::string> JsonView::texts(const char* key) const {
  std::vector<std::string> out;
  for (const JsonValue& v : list(key)) {
    if (v.kind != JsonValue::Kind::Text) fail(std::string(key) + " holds " + name_of(v.kind) + ", expected strings");
    out.push_back(v.text);
  }
  return out;
}

}  // namespace zoneplate
