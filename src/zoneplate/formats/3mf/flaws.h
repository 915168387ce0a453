// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "zoneplate/base/utf8.h"
#include "zoneplate/formats/import/import_budget.h"

namespace zoneplate {

/// The kinds of flaws of a 3MF or AMF file, each of which leaves something out.
enum class Flaw {
  Relationship,  ///< the package does not say which part is the model
  Checksum,      ///< of a part
  Extension,     ///< that the file requires, and that is not read
  Reference,     ///< to an object or part that is not there
  Cycle,         ///< an object that contains itself
  Vertex,        ///< a triangle with a vertex that is not there
  NotFinite,     ///< a triangle with a vertex that is no number
  Property,      ///< of a triangle or an object that is not there, or that is invalid
  Texture,       ///< that is not in the package
  Transform,     ///< a matrix that is no matrix
  Build,         ///< items that are missing or that must not be built
};

/// Collects flaws, the first of each kind and the number of the others, and notes.
class FlawList {
 public:
  FlawList(const ImportBudget& budget, std::vector<std::string>& warnings) : budget_(budget), warnings_(warnings) {}

  /// Adds a flaw; `text()` describes the first of its kind, with names as the file has them.
  ///
  /// Errors    ErrorKind::Input with that text if the limits are strict.
  template <class Text>
  void add(Flaw flaw, const Text& text) {
    Entry& entry = entries_[flaw];
    if (entry.count++ > 0) return;
    entry.text = budget_.file() + ": " + printable(text());
    if (budget_.limits().is_strict) budget_.warn_of_flaw(warnings_, entry.text);
  }

  /// Adds a note on what is not drawn as the file states it, a sentence.
  void add_note(std::string text) { notes_.insert(std::move(text)); }

  /// Adds the warnings: one for each kind of flaw, then each note once.
  void report() {
    for (auto& [flaw, entry] : entries_)
      budget_.warn_of_flaw(
          warnings_, std::move(entry.text) + (entry.count > 1 ? fmt::format(" (and {} more)", entry.count - 1) : ""));
    for (const std::string& note : notes_) warnings_.push_back(budget_.file() + ": " + note);
    entries_.clear(), notes_.clear();
  }

 private:
  struct Entry {
    std::string text;
    std::uint64_t count = 0;
  };
  const ImportBudget& budget_;
  std::vector<std::string>& warnings_;
  std::map<Flaw, Entry> entries_;
  std::set<std::string> notes_;
};

}  // namespace zoneplate
