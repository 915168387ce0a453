// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/output_files.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Whether two series of numbers have one in common.
bool have_common(const FrameNumbers& a, const FrameNumbers& b) {
  const std::int64_t last = std::min(a.last, b.last), step = std::gcd(a.jump, b.jump);
  if ((a.first - b.first) % step != 0) return false;
  std::int64_t n = b.first < a.first ? b.first + (a.first - b.first + b.jump - 1) / b.jump * b.jump : b.first;
  for (std::int64_t tries = a.jump / step; tries > 0 && n <= last; --tries, n += b.jump)
    if ((n - a.first) % a.jump == 0) return true;
  return false;
}

std::int64_t length_of(std::int64_t frame, int digits) {
  std::int64_t length = 1;
  for (std::int64_t rest = frame / 10; rest != 0; rest /= 10) ++length;
  return std::max<std::int64_t>(length, digits) + (frame < 0 ? 1 : 0);
}

/// The name with each series of digits replaced by one mark.
std::string skeleton_of(std::string_view name) {
  std::string out;
  for (const char c : name)
    if (!is_digit(c) || !out.ends_with('\1')) out += is_digit(c) ? '\1' : c;
  return out;
}

/// How many characters at the end of `name` can be the beginning of a number: digits, and a sign before them.
std::size_t number_at_end(std::string_view name) {
  std::size_t size = 0;
  while (size < name.size() && is_digit(name[name.size() - 1 - size])) ++size;
  return size < name.size() && name[name.size() - 1 - size] == '-' ? size + 1 : size;
}

}  // namespace

/// All frames of one pattern, sorted by their first numbers.
struct OutputFiles::Pattern {
  std::span<const Files> files;
  std::vector<std::int64_t> reach;  ///< for each of them, the greatest last number up to it
  std::int64_t least = 0, greatest = 0;

  const Files& front() const { return files.front(); }
  auto key() const { return std::tie(front().folder, front().before, front().after); }

  explicit Pattern(std::span<const Files> same) : files(same), least(same.front().frames.first) {
    greatest = same.front().frames.last;
    for (const Files& file : same) reach.push_back(greatest = std::max(greatest, file.frames.last));
  }

  /// Items that write the same frame.
  std::optional<std::pair<const Files*, const Files*>> find_twice() const {
    std::vector<const Files*> open;
    for (const Files& file : files) {
      std::erase_if(open, [&](const Files* other) { return other->frames.last < file.frames.first; });
      for (const Files* other : open)
        if (other->item != file.item && have_common(other->frames, file.frames)) return std::pair(other, &file);
      open.push_back(&file);
    }
    return std::nullopt;
  }

  /// The files with this frame.
  const Files* find(std::int64_t frame) const {
    const auto after = std::ranges::upper_bound(files, frame, {}, [](const Files& file) { return file.frames.first; });
    for (auto i = after - files.begin(); i > 0 && reach[static_cast<std::size_t>(i - 1)] >= frame; --i) {
      const Files& file = files[static_cast<std::size_t>(i - 1)];
      if (frame <= file.frames.last && (frame - file.frames.first) % file.frames.jump == 0) return &file;
    }
    return nullptr;
  }

  /// The shortest and the longest number.
  std::pair<std::int64_t, std::int64_t> lengths() const {
    const std::int64_t first = length_of(least, front().digits), last = length_of(greatest, front().digits);
    const bool has_zero = least <= 0 && greatest >= 0;
    return {has_zero ? front().digits : std::min(first, last), std::max(first, last)};
  }

  /// Whether names of both may be equal, where this name has `more` characters before the number than `other`, which
  /// must be the beginning of its numbers.
  bool may_meet(const Pattern& other, std::size_t more) const {
    const auto [shortest, longest] = lengths();
    const auto [other_shortest, other_longest] = other.lengths();
    const auto extra = static_cast<std::int64_t>(more);
    if (more == 0 && (greatest < other.least || other.greatest < least)) return false;
    for (std::int64_t size = std::max(shortest, other_shortest - extra);
         size <= std::min(longest, other_longest - extra); ++size) {
      const std::string_view begin = std::string_view(front().before).substr(front().before.size() - more);
      if (more == 0 || begin[0] == '-' || size + extra > 17) return true;
      std::int64_t base = *frame_of(begin, static_cast<int>(more));
      for (std::int64_t i = 0; i < size; ++i) base *= 10;
      if (base + std::max<std::int64_t>(least, 0) <= other.greatest && base + greatest >= other.least) return true;
    }
    return false;
  }
};

std::uint32_t OutputFiles::folder_of(const std::string& path) {
  const auto [place, is_new] = written_folders_.try_emplace(path, 0);
  if (!is_new) return place->second;
  std::error_code error;
  const fs::path folder = path.empty() ? "." : path;
  fs::path resolved = fs::weakly_canonical(fs::absolute(folder, error), error);
  if (error) resolved = fs::absolute(folder, error).lexically_normal();
  std::string name = resolved.string();
  if (!name.ends_with('/')) name += '/';
  const auto [index, is_other] = resolved_folders_.try_emplace(name, static_cast<std::uint32_t>(folder_names_.size()));
  if (is_other) folder_names_.push_back(std::move(name));
  return place->second = index->second;
}

void OutputFiles::add(const std::string& path, std::uint64_t item, bool is_read) {
  std::string target = path;
  try {
    target = link_target(path);
  } catch (const Error&) {  // a loop of links, for which the item fails alone
  }
  const std::size_t name = target.rfind('/') + 1;
  files_.push_back(
      {.folder = folder_of(target.substr(0, name)), .is_read = is_read, .before = target.substr(name), .item = item});
}

void OutputFiles::add(const std::string& path, const FramePlace& place, const FrameNumbers& frames,
                      std::uint64_t item) {
  const std::size_t name = place.begin == 0 ? 0 : path.rfind('/', place.begin - 1) + 1;
  const std::int64_t steps = std::max<std::int64_t>(frames.last - frames.first, 0) / frames.jump;
  frames_.push_back({.folder = folder_of(path.substr(0, name)),
                     .digits = place.digits,
                     .before = path.substr(name, place.begin - name),
                     .after = path.substr(place.begin + place.size),
                     .frames = {frames.first, frames.first + steps * frames.jump, steps == 0 ? 1 : frames.jump},
                     .item = item});
}

OutputFiles::Collision OutputFiles::collision(const Files& a, const Files& b) const {
  std::error_code error;
  std::string path =
      folder_names_[a.folder] + a.before + std::string(static_cast<std::size_t>(a.digits), '#') + a.after;
  const std::string here = fs::current_path(error).string() + '/';
  if (path.starts_with(here)) path.erase(0, here.size());
  if (a.is_read != b.is_read) return {a.is_read ? b.item : a.item, a.is_read ? a.item : b.item, true, path};
  return {std::min(a.item, b.item), std::max(a.item, b.item), false, path};
}

/// Groups the sorted frames: those with the same name but for the number.
std::vector<OutputFiles::Pattern> OutputFiles::patterns() const {
  std::vector<Pattern> out;
  const auto key = [](const Files& file) { return std::tie(file.folder, file.before, file.after, file.digits); };
  for (std::size_t begin = 0; begin < frames_.size();) {
    std::size_t end = begin + 1;
    while (end < frames_.size() && key(frames_[end]) == key(frames_[begin])) ++end;
    out.emplace_back(std::span(frames_).subspan(begin, end - begin));
    begin = end;
  }
  return out;
}

std::span<const OutputFiles::Pattern> OutputFiles::with_name(std::span<const Pattern> all, std::uint32_t folder,
                                                             std::string_view before, std::string_view after) {
  const auto key = [](const Pattern& pattern) {
    const Files& files = pattern.front();
    return std::tuple(files.folder, std::string_view(files.before), std::string_view(files.after));
  };
  const std::tuple wanted(folder, before, after);
  const auto begin = std::ranges::lower_bound(all, wanted, {}, key),
             end = std::ranges::upper_bound(all, wanted, {}, key);
  return {begin, end};
}

std::optional<OutputFiles::Collision> OutputFiles::of_patterns(std::span<const Pattern> all) const {
  for (const Pattern& pattern : all) {
    if (const auto two = pattern.find_twice()) return collision(*two->first, *two->second);
    const Files& own = pattern.front();
    const std::string_view before = own.before;
    for (std::size_t more = 0; more <= number_at_end(before); ++more)
      for (const Pattern& other : with_name(all, own.folder, before.substr(0, before.size() - more), own.after))
        if (&other != &pattern && pattern.may_meet(other, more)) return collision(own, other.front());
  }
  return std::nullopt;
}

/// Tries each number in the name of a file, and in those of its folders, as the number of a frame.
std::optional<OutputFiles::Collision> OutputFiles::of_file(const Files& file, std::span<const Pattern> all) const {
  const std::string path = folder_names_[file.folder] + file.before;
  const std::string_view text = path;
  for (std::size_t at = 0; at < path.size(); ++at) {
    std::size_t end = at + 1;
    while (end < path.size() && is_digit(path[end])) ++end;
    if (!is_digit(path[at]) && (path[at] != '-' || end == at + 1)) continue;
    const std::size_t name = path.rfind('/', at) + 1;
    const auto folder = resolved_folders_.find(path.substr(0, name));
    if (folder == resolved_folders_.end()) continue;
    for (const Pattern& pattern : with_name(all, folder->second, text.substr(name, at - name), text.substr(end))) {
      const auto frame = frame_of(text.substr(at, end - at), pattern.front().digits);
      const Files* const frames = frame ? pattern.find(*frame) : nullptr;
      if (frames != nullptr && (frames->item != file.item || file.is_read)) return collision(file, *frames);
    }
  }
  return std::nullopt;
}

/// Finds names that are the same but for digits and for which of their numbers is that of the frame.
std::optional<OutputFiles::Collision> OutputFiles::of_places(std::span<const Pattern> all) const {
  std::vector<std::tuple<std::uint32_t, std::string, std::ptrdiff_t, const Files*>> found;
  for (const Pattern& pattern : all) {
    std::string begin = skeleton_of(pattern.front().before);
    if (begin.ends_with('\1')) begin.pop_back();
    found.emplace_back(pattern.front().folder, begin + '\1' + skeleton_of(pattern.front().after),
                       std::ranges::count(begin, '\1'), &pattern.front());
  }
  std::ranges::sort(found);
  for (std::size_t i = 1; i < found.size(); ++i) {
    const auto& [folder, skeleton, place, files] = found[i - 1];
    const auto& [next_folder, next_skeleton, next_place, next_files] = found[i];
    if (folder == next_folder && skeleton == next_skeleton && place != next_place)
      return collision(*files, *next_files);
  }
  return std::nullopt;
}

std::optional<OutputFiles::Collision> OutputFiles::find_collision() {
  std::ranges::sort(files_, {}, [](const Files& f) { return std::tie(f.folder, f.before, f.is_read, f.item); });
  for (std::size_t i = 1; i < files_.size(); ++i) {
    const Files &a = files_[i - 1], &b = files_[i];
    if (a.folder == b.folder && a.before == b.before && !a.is_read && (b.is_read || a.item != b.item))
      return collision(a, b);
  }
  std::ranges::sort(frames_, {}, [](const Files& f) {
    return std::tie(f.folder, f.before, f.after, f.digits, f.frames.first, f.item);
  });
  const std::vector<Pattern> all = patterns();
  std::optional<Collision> found = of_patterns(all);
  if (!found) found = of_places(all);
  for (std::size_t i = 0; i < files_.size() && !all.empty() && !found; ++i) found = of_file(files_[i], all);
  return found;
}

}  // namespace zoneplate
