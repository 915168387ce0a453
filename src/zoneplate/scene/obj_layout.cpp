#include "zoneplate/scene/obj_layout.h"

#include <algorithm>
#include <charconv>
#include <unordered_map>
#include <utility>

namespace zoneplate {
namespace {

bool says(const ObjFile& file, ObjStateKind kind) {
  return std::any_of(file.chunks.begin(), file.chunks.end(), [&](const ObjChunk& chunk) {
    return std::any_of(chunk.states.begin(), chunk.states.end(), [&](const ObjState& s) { return s.kind == kind; });
  });
}

/// A number, or off; any other word is on.
std::uint32_t smoothing_of(const std::string& text) {
  std::uint32_t group = 0;
  const auto [end, trouble] = std::from_chars(text.data(), text.data() + text.size(), group);
  if (trouble == std::errc{}) return std::min(group, smooth_by_angle - 1);
  return text.empty() || text == "off" ? 0 : 1;
}

/// The number of a name in a list, where it is put if it is new.
class Names {
 public:
  explicit Names(std::vector<std::string>& list) : list_(list) {}
  int number(const std::string& name) {
    const auto [found, is_new] = numbers_.try_emplace(name, static_cast<int>(list_.size()));
    if (is_new) list_.push_back(name);
    return found->second;
  }

 private:
  std::vector<std::string>& list_;
  std::unordered_map<std::string, int> numbers_;
};

}  // namespace

ObjLayout lay_out(const ObjFile& file, const std::string& unnamed) {
  ObjLayout layout;
  Names objects(layout.objects), materials(layout.materials);
  const ObjStateKind naming = says(file, ObjStateKind::Object) ? ObjStateKind::Object : ObjStateKind::Group;
  std::string object = unnamed, material;
  std::uint32_t smoothing = says(file, ObjStateKind::Smoothing) ? 0 : smooth_by_angle;

  for (std::size_t c = 0; c < file.chunks.size(); ++c) {
    const ObjChunk& chunk = file.chunks[c];
    std::uint32_t begin = 0;
    const auto add_run = [&](std::uint32_t end) {
      if (end == begin) return;
      layout.runs.push_back({static_cast<std::uint32_t>(c), begin, end, objects.number(object),
                             materials.number(material), smoothing});
      begin = end;
    };
    for (const ObjState& state : chunk.states) {
      add_run(state.before);
      if (state.kind == naming) object = state.text.empty() ? unnamed : state.text;
      if (state.kind == ObjStateKind::Material) material = state.text;
      if (state.kind == ObjStateKind::Smoothing) smoothing = smoothing_of(state.text);
      if (state.kind == ObjStateKind::Library) layout.libraries.push_back(state.text);
    }
    add_run(static_cast<std::uint32_t>(chunk.elements.size()));
  }
  return layout;
}

}  // namespace zoneplate
