// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/xml/xml.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

/// Writes down what it receives.
class Record : public XmlHandler {
 public:
  std::string text_of_all;

  void begin(const XmlElement& element) override {
    text_of_all += "<" + of(element.name);
    for (const XmlAttribute& a : element.attributes) text_of_all += " " + of(a.name) + "=" + std::string(a.value);
    text_of_all += ">";
    if (element.name.local == "throw") throw Error(ErrorKind::Input, "thrown");
  }
  void end(const XmlName& name) override { text_of_all += "</" + of(name) + ">"; }
  void text(std::string_view text) override { text_of_all += text; }

 private:
  static std::string of(const XmlName& name) {
    return (name.space.empty() ? "" : std::string(name.space) + "|") + std::string(name.local);
  }
};

std::string parsed(std::string_view text, std::size_t piece = 1000, const LoadLimits& limits = {}) {
  Record record;
  ImportBudget budget("file", limits);
  try {
    XmlParser parser(record, "file: part", budget);
    for (std::size_t at = 0; at < text.size(); at += piece) {
      const std::string_view part = text.substr(at, piece);
      parser.feed({reinterpret_cast<const std::uint8_t*>(part.data()), part.size()});
    }
    parser.finish();
  } catch (const Error& error) {
    return error.what();
  }
  return record.text_of_all;
}

TEST(Xml, NamesAreInTheirNamespaces) {
  const char* const text =
      "\xef\xbb\xbf<?xml version='1.0'?><a xmlns='one' xmlns:p='two' b='1' p:c='2 &lt; 3'>t<p:d xmlns:p='three'/>"
      "<p:e/><n xmlns=''/></a>";
  for (const std::size_t piece : {1u, 7u, 1000u})
    EXPECT_EQ(parsed(text, piece), "<one|a b=1 two|c=2 < 3>t<three|d></three|d><two|e></two|e><n></n></one|a>");
  EXPECT_EQ(parsed("<a><q:b r:c='1'/></a>"), "<a><q|b r|c=1></q|b></a>") << "prefixes that nothing declares";
}

TEST(Xml, ReadsUtf16) {
  const std::string text = "<a b='\u00e9'/>";
  std::string wide = "\xff\xfe";
  for (const char16_t c : std::u16string(u"<a b='\u00e9'/>"))
    wide += static_cast<char>(c & 255), wide += static_cast<char>(c >> 8);
  EXPECT_EQ(parsed(wide, 3), parsed(text));
}

TEST(Xml, RefusalsNamePlaceAndLine) {
  EXPECT_EQ(parsed("<a>\n<b></a>"), "file: part: line 2: is not well-formed XML: mismatched tag");
  EXPECT_EQ(parsed("<a>"), "file: part: line 1: is not well-formed XML: no element found");
  EXPECT_EQ(parsed("<a><throw/>\n<b/></a>"), "thrown");
}

TEST(Xml, ThereAreNoEntitiesOfDocuments) {
  const std::string cause = "file: part: line 1: has a document type declaration, which is not read";
  EXPECT_EQ(parsed("<!DOCTYPE a [<!ENTITY b 'c'><!ENTITY d '&b;&b;'>]><a>&d;</a>"), cause);
  EXPECT_EQ(parsed("<!DOCTYPE a SYSTEM 'file:///etc/passwd'><a/>"), cause);
  EXPECT_EQ(parsed("<a>&b;</a>"), "file: part: line 1: is not well-formed XML: undefined entity");
}

TEST(Xml, WhatNeedsMuchMemoryIsRefused) {
  const std::string limit = "file: needs more than the limit of 1 MB (--max-memory)";
  std::string nested, names;
  for (int i = 0; i < 200000; ++i) nested += "<aaaaaaaa>", names += fmt::format("<n{}/>", i);
  EXPECT_EQ(parsed(nested, 65536, {.memory = 1 << 20}), limit);
  EXPECT_EQ(parsed("<a>" + names + "</a>", 65536, {.memory = 1 << 20}), limit);
  EXPECT_EQ(parsed("<a b='" + std::string(2 << 20, 'x') + "'/>", 65536, {.memory = 1 << 20}), limit);
  EXPECT_EQ(parsed("<a b='" + std::string(5 << 20, 'x') + "'/>", 65536),
            "file: part: line 1: has a tag of more than 4 MiB");
}

}  // namespace
}  // namespace zoneplate
