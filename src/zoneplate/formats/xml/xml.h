// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"

namespace zoneplate {

/// A name in a namespace, whose URI is empty if it has none. A prefix that nothing declares is its own namespace:
/// some programs write such names.
struct XmlName {
  std::string_view space, local;
  bool operator==(const XmlName&) const = default;
};

/// An attribute of a start tag.
struct XmlAttribute {
  XmlName name;
  std::string_view value;  ///< references are resolved
};

/// A start tag. It is valid until the handler returns.
struct XmlElement {
  XmlName name;
  std::span<const XmlAttribute> attributes;

  /// The value of an attribute; nothing if the element does not have it.
  std::optional<std::string_view> find(std::string_view local, std::string_view space = {}) const;
};

/// Receives the parts of an XML document in their order. It may throw.
class XmlHandler {
 public:
  virtual ~XmlHandler() = default;
  virtual void begin(const XmlElement& element) = 0;
  virtual void end(const XmlName& /*name*/) {}
  /// A part of the text between two tags, in UTF-8.
  virtual void text(std::string_view /*text*/) {}
  /// The declaration of a prefix, before the `begin` of its element. The default namespace has the prefix "".
  virtual void declare(std::string_view /*prefix*/, std::string_view /*uri*/) {}
};

/// Parses an XML document piece by piece, with the library expat: UTF-8, UTF-16, Latin-1, with or without a byte order
/// mark. A document type declaration is refused, so that there are no entities but those of XML.
///
/// Errors    ErrorKind::Input naming the place, the line and the cause: not well-formed, a document type declaration, a
///           tag of more than 4 MiB, limits of the budget exceeded; and the handler's own.
/// Requires  the arguments outlive the parser.
class XmlParser {
 public:
  /// `place` is the document's name for messages.
  XmlParser(XmlHandler& handler, std::string place, ImportBudget& budget);
  ~XmlParser();
  XmlParser(const XmlParser&) = delete;
  XmlParser& operator=(const XmlParser&) = delete;

  /// Parses the next bytes.
  void feed(std::span<const std::uint8_t> bytes) { parse(bytes, false); }
  /// Ends the document.
  void finish() { parse({}, true); }

 private:
  struct State;
  void parse(std::span<const std::uint8_t> bytes, bool is_last);
  std::unique_ptr<State> state_;
};

}  // namespace zoneplate
