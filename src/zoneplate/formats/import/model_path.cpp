// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/import/model_path.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

#include "zoneplate/base/error.h"
#include "zoneplate/base/lower_case.h"

namespace zoneplate {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/// The value of each base64 character (RFC 4648, standard and URL-safe alphabets), 64 for white space, 255 for others.
constexpr std::array<std::uint8_t, 256> base64_values() {
  std::array<std::uint8_t, 256> value{};
  for (auto& v : value) v = 255;
  for (std::uint8_t i = 0; i < 26; ++i) {
    value[static_cast<std::size_t>('A' + i)] = i;
    value[static_cast<std::size_t>('a' + i)] = static_cast<std::uint8_t>(26 + i);
  }
  for (std::uint8_t i = 0; i < 10; ++i) value[static_cast<std::size_t>('0' + i)] = static_cast<std::uint8_t>(52 + i);
  value['+'] = value['-'] = 62;
  value['/'] = value['_'] = 63;
  value[' '] = value['\n'] = value['\r'] = value['\t'] = 64;
  return value;
}

bool is_within(const std::filesystem::path& folder, const std::filesystem::path& file) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end() && rest != file.end();
}

/// Whether a path without symbolic links is one of `allowed` or below one of them.
bool is_allowed(std::span<const std::string> allowed, const std::filesystem::path& file) {
  return std::any_of(allowed.begin(), allowed.end(), [&](const std::string& path) {
    std::error_code trouble;
    const std::filesystem::path known = std::filesystem::weakly_canonical(path, trouble);
    return !trouble && (known == file || is_within(known, file));
  });
}

struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

/// Opens the folder that contains a file, from the root on, without following any link: after `path` has been checked,
/// no part of it can be replaced by a link that leads elsewhere. (A name in /proc would identify an open file too, but
/// not every system has /proc, and inside the sandbox there is no openat2.)
///
/// Requires  `path` is canonical.
Descriptor open_parent(const std::filesystem::path& path) {
  constexpr int flags = O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
  int folder = ::open("/", flags);
  for (const std::filesystem::path& part : path.parent_path().relative_path()) {
    const int next = folder < 0 ? -1 : ::openat(folder, part.c_str(), flags);
    const int error = errno;
    if (folder >= 0) ::close(folder);
    folder = next, errno = error;
  }
  return {folder};
}

}  // namespace

std::string decode_percent(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
    out += low >= 0 ? static_cast<char>(high * 16 + low) : text[i];
    if (low >= 0) i += 2;
  }
  return out;
}

std::optional<std::vector<std::uint8_t>> decode_base64(std::string_view text) {
  static constexpr std::array<std::uint8_t, 256> value = base64_values();
  while (!text.empty() && (text.back() == '=' || value[static_cast<std::uint8_t>(text.back())] == 64))
    text.remove_suffix(1);
  std::vector<std::uint8_t> out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const std::uint8_t v = value[static_cast<std::uint8_t>(c)];
    if (v == 255) return std::nullopt;
    if (v == 64) continue;
    bits = bits << 6 | v;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    out.push_back(static_cast<std::uint8_t>(bits >> held));
  }
  return held == 6 ? std::nullopt : std::optional(std::move(out));  // six bits are not a byte
}

bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  if (colon == std::string_view::npos || colon == 0) return false;
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return is_letter(uri[0]) && std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), [&](char c) {
           return is_letter(c) || (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
         });
}

std::optional<std::string> find_path(const std::string& folder, std::string_view uri,
                                     std::span<const std::string> allowed) {
  namespace fs = std::filesystem;
  const std::string name = decode_percent(uri);
  constexpr std::size_t max_bytes = 4096;  // the maximum length of a path in Linux (PATH_MAX)
  if (name.empty() || name.size() > max_bytes || name.find('\0') != std::string::npos) return std::nullopt;
  const fs::path file = fs::path(folder) / name;

  // Symbolic links and ".." are resolved first, so that the check applies to the file that would be opened.
  std::error_code trouble;
  const fs::path inside = fs::weakly_canonical(folder.empty() ? "." : folder, trouble);
  if (trouble) return std::nullopt;
  const fs::path found = fs::weakly_canonical(inside / name, trouble);
  if (trouble || !(is_within(inside, found) || is_allowed(allowed, found))) return std::nullopt;
  return file.string();
}

std::optional<std::string> PathFinder::find(std::string_view uri) {
  namespace fs = std::filesystem;
  const std::optional<std::string> exact = find_path(folder_, uri, allowed_);
  std::error_code trouble;
  if (!exact || fs::exists(*exact, trouble)) return exact;
  const fs::path inside = fs::weakly_canonical(folder_.empty() ? "." : folder_, trouble);
  const auto is_readable = [&](const fs::path& place) {
    const fs::path found = fs::weakly_canonical(place, trouble);
    return !trouble && (found == inside || is_within(inside, found) || is_allowed(allowed_, found));
  };
  fs::path place;
  for (const fs::path& part : fs::path(*exact)) {
    const fs::path same = place / part;
    if (fs::exists(fs::symlink_status(same, trouble))) {
      place = same;
      continue;
    }
    const fs::path folder = place.empty() ? fs::path(".") : place;
    if (!is_readable(folder)) return exact;
    const Names& names = names_in(folder.string());
    const auto other = names.find(lower_case(part.string()));
    if (other == names.end()) return exact;
    place /= other->second;
  }
  return is_readable(place) ? place.string() : exact;
}

const PathFinder::Names& PathFinder::names_in(const std::string& folder) {
  const auto [known, is_new] = known_.try_emplace(folder);
  Names& names = known->second;
  if (!is_new) return names;
  // Not an iterator of the standard library, which calls fcntl: the sandbox does not allow it.
  const std::unique_ptr<DIR, int (*)(DIR*)> open(::opendir(folder.c_str()), ::closedir);
  constexpr std::size_t max_entries = 1 << 16;  // the memory of the names is not counted
  while (open != nullptr && entries_ < max_entries) {
    const dirent* const entry = ::readdir(open.get());
    if (entry == nullptr) break;
    ++entries_;
    const std::string name = entry->d_name;
    const auto [kept, is_first] = names.try_emplace(lower_case(name), name);
    if (!is_first) kept->second = std::min(kept->second, name);
  }
  if (entries_ == max_entries) names.clear();  // the order of the entries must not matter
  return names;
}

FileBytes open_found(const std::string& folder, const std::string& path, std::span<const std::string> allowed,
                     std::optional<std::uint64_t> limit) {
  namespace fs = std::filesystem;
  const auto fail = [&](const std::string& cause) -> Error { return {ErrorKind::Input, path + ": " + cause}; };
  std::error_code trouble;
  const fs::path opened = fs::canonical(path, trouble);
  if (trouble) throw fail("cannot be read: " + trouble.message());
  const fs::path inside = fs::canonical(folder.empty() ? "." : folder, trouble);
  if (trouble || !(is_within(inside, opened) || is_allowed(allowed, opened)))
    throw fail("leads out of the model's folder");
  const Descriptor parent = open_parent(opened);
  const std::string name = opened.filename();
  struct stat status {};
  if (parent.number < 0 || ::fstatat(parent.number, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0)
    throw fail(std::string("cannot be read: ") + std::strerror(errno));
  if (S_ISLNK(status.st_mode)) throw fail("leads out of the model's folder");
  if (!S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) throw fail("is not a regular file");
  // If it has been replaced by a pipe since, opening it does not block; reading it would end at once.
  const Descriptor file{::openat(parent.number, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)};
  return limit ? FileBytes(file.number, path, *limit) : FileBytes::reclaimable(file.number, path);
}

bool is_stream(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
         !std::filesystem::is_directory(status);
}

}  // namespace zoneplate
