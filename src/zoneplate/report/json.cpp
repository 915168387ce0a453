// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/json.h"

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
    return write(json).dump(indent, ' ', false, Out::error_handler_t::replace);
  }
};

std::string Json::text() const { return JsonWriter::text(*this, -1); }
std::string Json::indented() const { return JsonWriter::text(*this, 2); }

}  // namespace zoneplate
