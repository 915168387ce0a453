// SPDX-License-Identifier: Apache-2.0
// A fuzz target of libFuzzer: bytes that pretend to be the manifest of a batch, a JSON object a line.
//
// A line is refused in one line of text, or becomes a tree in which every key of an object is found, the last of equal
// ones.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/json/json.h"

namespace zoneplate {
namespace {

void check(const JsonValue& value, int depth) {
  constexpr int deepest = 64;
  if (depth > deepest) std::abort();
  if (value.kind == JsonValue::Kind::Object) {
    if (value.keys.size() != value.items.size()) std::abort();
    const JsonView view(value, "line 1");
    for (std::size_t i = 0; i < value.keys.size(); ++i) {
      const std::string& key = value.keys[i];
      if (key.find('\0') != key.npos) continue;  // such a key is no text of C
      if (!view.has(key.c_str())) std::abort();
      const bool is_last =
          std::find(value.keys.begin() + static_cast<std::ptrdiff_t>(i) + 1, value.keys.end(), key) == value.keys.end();
      if (is_last && value.items[i].kind == JsonValue::Kind::Text && view.text(key.c_str()) != value.items[i].text)
        std::abort();
    }
  }
  for (const JsonValue& item : value.items) check(item, depth + 1);
}

void read(std::string_view line) {
  ImportBudget budget("line 1", {.memory = 1 << 24, .seconds = 5});
  try {
    check(parse_json({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}, budget), 0);
  } catch (const Error& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
}

}  // namespace
}  // namespace zoneplate

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    zoneplate::read(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return 0;
}
