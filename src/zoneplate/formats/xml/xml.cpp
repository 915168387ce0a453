// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/xml/xml.h"

#include <expat.h>
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "zoneplate/base/callback_error.h"
#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

/// The memory of one parser: names, open tags and unfinished tokens, of which a document may have any number.
struct Memory {
  std::uint64_t used = 0, limit = 0;
};
/// The memory of the parser that runs on this thread: expat's allocation functions have no argument for it.
thread_local Memory* memory_of_thread = nullptr;

class MemoryScope {
 public:
  explicit MemoryScope(Memory& memory) : outer_(std::exchange(memory_of_thread, &memory)) {}
  ~MemoryScope() { memory_of_thread = outer_; }
  MemoryScope(const MemoryScope&) = delete;
  MemoryScope& operator=(const MemoryScope&) = delete;

 private:
  Memory* outer_;
};

void* resize(void* old, std::size_t size) {
  Memory& memory = *memory_of_thread;
  const std::size_t old_size = old == nullptr ? 0 : ::malloc_usable_size(old);
  if (size > old_size && memory.used + (size - old_size) > memory.limit) return nullptr;
  void* const made = std::realloc(old, std::max<std::size_t>(size, 1));
  if (made != nullptr) memory.used += ::malloc_usable_size(made) - old_size;
  return made;
}
void* allocate(std::size_t size) { return resize(nullptr, size); }
void release(void* block) {
  if (block != nullptr) memory_of_thread->used -= ::malloc_usable_size(block);
  std::free(block);
}

/// A declaration of a namespace, which holds within the element at its depth.
struct Declaration {
  std::string prefix, uri;
  std::uint64_t depth = 0;
};

/// The prefix that an attribute declares, if it declares one; the default namespace has the prefix "".
std::optional<std::string_view> declared_prefix(std::string_view attribute) {
  constexpr std::string_view word = "xmlns";
  if (!attribute.starts_with(word)) return std::nullopt;
  if (attribute.size() == word.size()) return "";
  return attribute[word.size()] == ':' ? std::optional(attribute.substr(word.size() + 1)) : std::nullopt;
}

}  // namespace

std::optional<std::string_view> XmlElement::find(std::string_view local, std::string_view space) const {
  for (const XmlAttribute& a : attributes)
    if (a.name.local == local && a.name.space == space) return a.value;
  return std::nullopt;
}

struct XmlParser::State {
  XmlHandler& handler;
  std::string place;
  ImportBudget& budget;
  XML_Parser parser = nullptr;
  Memory memory{};
  CallbackError error{};
  std::vector<XmlAttribute> attributes{};
  std::vector<Declaration> declarations{};
  std::uint64_t fed = 0, depth = 0, charged = 0;
  std::uint64_t parsed = 0;  ///< the bytes before the tag or text that was parsed last

  /// Charges the memory that expat uses now.
  void charge() {
    budget.give_back(std::exchange(charged, 0));
    budget.take(memory.used);
    charged = memory.used;
  }

  template <class Body>
  void guard(const Body& body) {
    const bool is_done = error.guarded(false, [&] {
      body();
      return true;
    });
    if (!is_done) XML_StopParser(parser, XML_FALSE);
  }
  Error wrong(std::string_view cause) const {
    return {ErrorKind::Input, fmt::format("{}: line {}: {}", place, XML_GetCurrentLineNumber(parser), cause)};
  }

  /// The declarations are few; the innermost one counts.
  std::string_view space_of(std::string_view prefix) const {
    const auto found = std::find_if(declarations.rbegin(), declarations.rend(),
                                    [&](const Declaration& d) { return d.prefix == prefix; });
    return found == declarations.rend() ? prefix : std::string_view(found->uri);
  }
  /// An attribute without a prefix is in no namespace.
  XmlName name_of(std::string_view name, bool is_attribute) const {
    const std::size_t colon = name.find(':');
    if (colon != std::string_view::npos) return {space_of(name.substr(0, colon)), name.substr(colon + 1)};
    return {is_attribute ? std::string_view() : space_of(""), name};
  }
  void declare(std::string_view prefix, std::string_view uri) {
    constexpr std::size_t most = 1000;  // each name is compared with all of them
    if (declarations.size() == most) throw wrong("declares more than 1000 namespaces within each other");
    budget.take(2 * sizeof(Declaration) + prefix.size() + uri.size());
    declarations.push_back({std::string(prefix), std::string(uri), depth});
    handler.declare(prefix, uri);
  }
  void begin(const char* name, const char* const* pairs) {
    ++depth;
    for (const char* const* p = pairs; *p != nullptr; p += 2)
      if (const auto prefix = declared_prefix(p[0])) declare(*prefix, p[1]);
    attributes.clear();
    for (const char* const* p = pairs; *p != nullptr; p += 2)
      if (!declared_prefix(p[0])) attributes.push_back({name_of(p[0], true), p[1]});
    handler.begin({name_of(name, false), attributes});
  }
  void end(const char* name) {
    handler.end(name_of(name, false));
    for (; !declarations.empty() && declarations.back().depth == depth; declarations.pop_back())
      budget.give_back(2 * sizeof(Declaration) + declarations.back().prefix.size() + declarations.back().uri.size());
    --depth;
  }

  static State& of(void* data) { return *static_cast<State*>(data); }
  static void begin(void* data, const XML_Char* name, const XML_Char** pairs) {
    of(data).guard([&] { of(data).begin(name, pairs); });
  }
  static void end(void* data, const XML_Char* name) {
    of(data).guard([&] { of(data).end(name); });
  }
  static void text(void* data, const XML_Char* text, int length) {
    of(data).guard([&] { of(data).handler.text({text, static_cast<std::size_t>(length)}); });
  }
  static void refuse(void* data, const XML_Char*, const XML_Char*, const XML_Char*, int) {
    of(data).guard([&] { throw of(data).wrong("has a document type declaration, which is not read"); });
  }
};

XmlParser::XmlParser(XmlHandler& handler, std::string place, ImportBudget& budget)
    : state_(new State{handler, std::move(place), budget}) {
  State& s = *state_;
  s.memory.limit = budget.memory_left();
  const MemoryScope scope(s.memory);
  const XML_Memory_Handling_Suite functions{allocate, resize, release};
  s.parser = XML_ParserCreate_MM(nullptr, &functions, nullptr);
  if (s.parser == nullptr) budget.take(budget.memory_left() + 1);
  s.charge();
  XML_SetUserData(s.parser, &s);
  XML_SetElementHandler(s.parser, State::begin, State::end);
  XML_SetCharacterDataHandler(s.parser, State::text);
  XML_SetStartDoctypeDeclHandler(s.parser, State::refuse);
}

XmlParser::~XmlParser() {
  const MemoryScope scope(state_->memory);
  state_->budget.give_back(state_->charged);
  XML_ParserFree(state_->parser);
}

void XmlParser::parse(std::span<const std::uint8_t> bytes, bool is_last) {
  // expat parses an unfinished tag again with each piece.
  constexpr std::uint64_t max_of_a_tag = std::uint64_t{4} << 20;
  constexpr std::size_t max_at_once = std::size_t{1} << 16;
  State& s = *state_;
  do {
    const std::span<const std::uint8_t> piece = bytes.first(std::min(bytes.size(), max_at_once));
    bytes = bytes.subspan(piece.size());
    s.budget.check_time();
    s.memory.limit = s.charged + s.budget.memory_left();
    const MemoryScope scope(s.memory);
    const XML_Status status = XML_Parse(s.parser, reinterpret_cast<const char*>(piece.data()),
                                        static_cast<int>(piece.size()), is_last && bytes.empty() ? 1 : 0);
    s.error.rethrow();
    if (status != XML_STATUS_OK) {
      const XML_Error cause = XML_GetErrorCode(s.parser);
      if (cause == XML_ERROR_NO_MEMORY) s.budget.take(s.budget.memory_left() + 1);
      throw s.wrong(fmt::format("is not well-formed XML: {}", XML_ErrorString(cause)));
    }
    s.charge();
    s.fed += piece.size();
    // Newer versions wait for more of an unfinished tag before they parse it again, and then know no index.
    if (const XML_Index at = XML_GetCurrentByteIndex(s.parser); at >= 0) s.parsed = static_cast<std::uint64_t>(at);
    if (s.fed > s.parsed + max_of_a_tag) throw s.wrong("has a tag of more than 4 MiB");
  } while (!bytes.empty());
}

}  // namespace zoneplate
