// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/3mf/package.h"

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/formats/import/model_path.h"
#include "zoneplate/formats/xml/xml.h"

namespace zoneplate {
namespace {

/// Finds a relationship in a relationship part.
class Relationships : public XmlHandler {
 public:
  explicit Relationships(std::string_view type) : type_(type) {}
  void begin(const XmlElement& element) override {
    if (element.name.local != "Relationship" || !target.empty()) return;
    if (element.find("Type") == type_ && element.find("TargetMode") != "External")
      target = part_name(element.find("Target").value_or(""));
  }
  std::string target;

 private:
  std::string_view type_;
};

}  // namespace

std::string part_name(std::string_view name) {
  std::string out;
  std::string text = decode_percent(name);
  for (char& c : text) c = c == '\\' ? '/' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find('/', at), text.size());
    const std::string_view segment = std::string_view(text).substr(at, end - at);
    at = end + 1;
    if (segment.empty() || segment == ".") continue;
    if (segment == "..")
      out.resize(out.rfind('/') == std::string::npos ? 0 : out.rfind('/'));
    else
      out.append(out.empty() ? "" : "/").append(segment);
  }
  return out;
}

Package::Package(std::span<const std::uint8_t> bytes, ImportBudget& budget) : budget_(budget), archive_(bytes, budget) {
  constexpr std::uint64_t of_the_map = 64;
  for (std::size_t i = 0; i < archive_.names().size(); ++i) {
    budget.take(of_the_map + archive_.names()[i].size());
    parts_.try_emplace(part_name(archive_.names()[i]), i);
  }
}

std::optional<std::size_t> Package::find(std::string_view name) const {
  const auto found = parts_.find(part_name(name));
  return found == parts_.end() ? std::nullopt : std::optional(found->second);
}

std::string Package::find_ending(std::string_view ending) const {
  for (const auto& [name, part] : parts_)
    if (name.ends_with(ending)) return name;
  return "";
}

std::vector<std::uint8_t> Package::contents(std::size_t part) {
  std::vector<std::uint8_t> bytes;
  try {
    archive_.read(part, [&](std::span<const std::uint8_t> piece) {
      budget_.take(piece.size());
      bytes.insert(bytes.end(), piece.begin(), piece.end());
    });
  } catch (const Error&) {
    budget_.give_back(bytes.size());
    throw;
  }
  return bytes;
}

std::string Package::target_of_type(std::string_view type) {
  const auto part = find("_rels/.rels");
  if (!part) return "";
  Relationships relationships(type);
  XmlParser parser(relationships, budget_.file() + ": " + printable(name(*part)), budget_);
  archive_.read(*part, [&](std::span<const std::uint8_t> piece) { parser.feed(piece); });
  parser.finish();
  return relationships.target;
}

}  // namespace zoneplate
