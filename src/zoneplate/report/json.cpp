// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace zoneplate {

// One overload for each alternative of the value.
struct JsonWriter {
  using Out = nlohmann::ordered_json;

  static Out write(const Json& json) {
    return std::visit([](const auto& value) { return write(value); }, json.value_);
  }
  static Out write(std::monostate) { return nullptr; }
  static Out write(bool value) { return value; }
  static Out write(std::int64_t value) { return value; }
  static Out write(std::uint64_t value) { return value; }
  static Out write(double value) { return value; }
  // Converted to double through its shortest decimal text: 0.1f is 0.1, not 0.10000000149.
  static Out write(float value) {
    return std::isfinite(value)
               ? Out::parse(
                     nlohmann::basic_json<std::map, std::vector, std::string, bool, std::int64_t, std::uint64_t, float>(
                         value)
                         .dump())
               : Out(nullptr);
  }
  static Out write(const std::string& value) { return value; }
  static Out write(const Json::Array& values) {
    Out out = Out::array();
    for (const Json& value : values) out.push_back(write(value));
    return out;
  }
  static Out write(const Json::Object& members) {
    Out out = Out::object();
    for (const auto& [name, value] : members) out[name] = write(value);
    return out;
  }

  static std::string text(const Json& json, int indent) {
    return escaped(write(json).dump(indent, ' ', false, Out::error_handler_t::replace));
  }

  /// Escapes the control characters that JSON allows in strings, and terminals obey: DEL and C1.
  static std::string escaped(const std::string& text) {
    std::string out;
    for (std::size_t at = 0; at < text.size(); ++at) {
      const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
      if (byte(at) == 0x7f)
        out += "\\u007f";
      else if (byte(at) == 0xc2 && byte(at + 1) < 0xa0)
        out += fmt::format("\\u{:04x}", byte(++at));
      else
        out += text[at];
    }
    return out;
  }
};

std::string Json::text() const { return JsonWriter::text(*this, -1); }
std::string Json::indented() const { return JsonWriter::text(*this, 2); }

}  // namespace zoneplate
