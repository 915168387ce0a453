// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

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

/// Collects flaws: the first of each kind, and the number of the others.
class FlawList {
 public:
  FlawList(const ImportBudget& budget, std::vector<std::string>& warnings) : budget_(budget), warnings_(warnings) {}

  /// Adds a flaw; `text()` describes the first of its kind.
  ///
  /// Errors    ErrorKind::Input with that text if the limits are strict.
  template <class Text>
  void add(Flaw flaw, const Text& text) {
    Entry& entry = entries_[static_cast<std::size_t>(flaw)];
    if (entry.count++ > 0) return;
    entry.text = budget_.file() + ": " + text();
    if (budget_.limits().is_strict) budget_.warn_of_flaw(warnings_, entry.text);
  }

  /// Adds the warnings, one for each kind.
  void report() {
    for (Entry& entry : entries_)
      if (entry.count > 0)
        budget_.warn_of_flaw(
            warnings_, std::move(entry.text) + (entry.count > 1 ? fmt::format(" (and {} more)", entry.count - 1) : ""));
    entries_ = {};
  }

 private:
  struct Entry {
    std::string text;
    std::uint64_t count = 0;
  };
  const ImportBudget& budget_;
  std::vector<std::string>& warnings_;
  std::array<Entry, 11> entries_{};
};

/// Appends to an array whose memory is charged to the budget.
template <class T>
void append_charged(std::vector<T>& values, T value, ImportBudget& budget) {
  if (values.size() == values.capacity()) {
    const std::size_t old = values.capacity(), grown = old < 8 ? 16 : 2 * old;
    budget.take(grown * sizeof(T));
    values.reserve(grown);
    budget.give_back(old * sizeof(T));
  }
  values.push_back(std::move(value));
}

}  // namespace zoneplate
