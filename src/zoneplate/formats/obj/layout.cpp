// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/layout.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <string_view>
#include <utility>

namespace zoneplate {
namespace {

bool says(const ObjFile& file, ObjStateKind kind) {
  return std::any_of(file.chunks.begin(), file.chunks.end(), [&](const ObjChunk& chunk) {
    return std::any_of(chunk.states.begin(), chunk.states.end(), [&](const ObjState& s) { return s.kind == kind; });
  });
}

/// The operand of `s`: a group number, or "off"; any other word is group 1.
std::uint32_t smoothing_of(const std::string& text) {
  std::uint32_t group = 0;
  const auto [end, trouble] = std::from_chars(text.data(), text.data() + text.size(), group);
  if (trouble == std::errc{}) return std::min(group, smooth_by_angle - 1);
  return text.empty() || text == "off" ? 0 : 1;
}

/// The current name, and its index in a list to which it is appended at its first use.
///
/// The text of a name must outlive this object. A map is used and not a hash table, because a malicious file could
/// choose names that collide.
class CurrentName {
 public:
  CurrentName(std::vector<std::string>& list, std::string_view first) : list_(list), name_(first) {}
  void set(std::string_view name) { name_ = name, number_ = none; }
  int number() {
    if (number_ != none) return number_;
    const auto [found, is_new] = numbers_.try_emplace(name_, static_cast<int>(list_.size()));
    if (is_new) list_.emplace_back(name_), bytes_ += of_a_name + 2 * name_.size();
    return number_ = found->second;
  }
  /// The memory of the names: in the list, in the map, and later as names of meshes or materials.
  std::uint64_t bytes() const { return bytes_; }

 private:
  static constexpr int none = -1;
  static constexpr std::uint64_t of_a_name = 4 * sizeof(std::string) + 64;
  std::vector<std::string>& list_;
  std::uint64_t bytes_ = 0;
  std::string_view name_;
  int number_ = none;
  std::map<std::string_view, int> numbers_;
};

}  // namespace

ObjLayout lay_out(const ObjFile& file, const std::string& unnamed, ImportBudget& budget) {
  ObjLayout layout;
  CurrentName object(layout.objects, unnamed), material(layout.materials, "");
  std::uint64_t library_bytes = 0, counted = 0;
  const auto count = [&] {
    const std::uint64_t bytes =
        object.bytes() + material.bytes() + library_bytes + 2 * layout.runs.size() * sizeof(ObjRun);
    budget.take(bytes - std::exchange(counted, bytes));
    budget.check_time();
  };
  const ObjStateKind naming = says(file, ObjStateKind::Object) ? ObjStateKind::Object : ObjStateKind::Group;
  std::uint32_t smoothing = says(file, ObjStateKind::Smoothing) ? 0 : smooth_by_angle;

  for (std::size_t c = 0; c < file.chunks.size(); ++c) {
    const ObjChunk& chunk = file.chunks[c];
    std::uint32_t begin = 0;
    const auto add_run = [&](std::uint32_t end) {
      if (end == begin) return;
      layout.runs.push_back({static_cast<std::uint32_t>(c), begin, end, object.number(), material.number(), smoothing});
      begin = end;
      constexpr std::size_t runs_per_count = 1024;
      if (layout.runs.size() % runs_per_count == 0) count();
    };
    for (const ObjState& state : chunk.states) {
      add_run(state.before);
      if (state.kind == naming) object.set(state.text.empty() ? unnamed : state.text);
      if (state.kind == ObjStateKind::Material) material.set(state.text);
      if (state.kind == ObjStateKind::Smoothing) smoothing = smoothing_of(state.text);
      if (state.kind == ObjStateKind::Library && (layout.libraries.empty() || layout.libraries.back() != state.text)) {
        layout.libraries.push_back(state.text);
        library_bytes += 2 * sizeof(std::string) + state.text.size();
      }
    }
    add_run(static_cast<std::uint32_t>(chunk.elements.size()));
    count();
  }
  return layout;
}

}  // namespace zoneplate
