// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/filter/items.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "zoneplate/base/error.h"
#include "zoneplate/batch/output_files.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/job/output/frame_name.h"
#include "zoneplate/metrics/file/picture_file.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

std::string output_in_folder(const std::string& folder, const std::string& input) {
  const std::string ending = is_linear_file(input) || extension_of(input) == ".hdr" ? ".exr" : ".png";
  return (fs::path(folder) / fs::path(input).stem()).string() + ending;
}

std::string output_of(const std::string& output, const std::string& input, std::optional<std::uint64_t> frame) {
  constexpr std::uint64_t most = 999'999'999;
  const std::size_t name = output.rfind('/') + 1;
  const std::optional<FramePlace> place = find_frame_place(output.substr(name));
  if (!place) return output_in_folder(output, input);
  if (!frame)
    throw Error(ErrorKind::Usage, fmt::format("{}: has a place for a frame number, and {} is no frame of a sequence, "
                                              "as f.####.png: give a folder",
                                              output, input));
  if (*frame > most) throw Error(ErrorKind::Usage, fmt::format("{}: its number is greater than {}", input, most));
  return output.substr(0, name) + frame_name(output.substr(name), *place, static_cast<int>(*frame));
}

/// "2, 4, 6-9".
std::string ranges_of(const std::set<std::uint64_t>& numbers) {
  std::string text;
  for (auto at = numbers.begin(); at != numbers.end();) {
    const std::uint64_t first = *at;
    std::uint64_t last = first;
    while (++at != numbers.end() && *at == last + 1) ++last;
    text += (text.empty() ? "" : ", ") + std::to_string(first);
    if (last > first) text += (last == first + 1 ? ", " : "-") + std::to_string(last);
  }
  return text;
}

/// The files of one operand, by the numbers of their frames.
struct Sequence {
  std::string name;  ///< for messages
  metrics::PictureFiles files;

  bool is_numbered() const { return !files.numbers.empty(); }
  std::set<std::uint64_t> numbers() const { return {files.numbers.begin(), files.numbers.end()}; }
};

Sequence sequence_of(const char* option, const std::string& operand) {
  if (operand.empty()) return {};
  return {fmt::format("{} {}", option, operand), metrics::list_pictures(operand)};
}

/// Requires that all numbered sequences have the same numbers.
void check_numbers(std::span<const Sequence* const> sequences) {
  std::set<std::uint64_t> all;
  for (const Sequence* s : sequences) all.merge(s->numbers());
  std::string text;
  for (const Sequence* s : sequences) {
    std::set<std::uint64_t> missing = all;
    for (const std::uint64_t number : s->files.numbers) missing.erase(number);
    if (missing.empty()) continue;
    text += fmt::format("{}{} has no frame {}", text.empty() ? "" : "; ", s->name, ranges_of(missing));
  }
  if (!text.empty()) throw Error(ErrorKind::Input, text + ": frames, depth and motion are paired by their numbers");
}

/// The files of a pass in the order of the items.
std::vector<std::string> files_for(std::span<const FilterItem> items, const Sequence& pass, bool are_numbered) {
  if (pass.files.paths.empty() || items.size() == 1) return pass.files.paths;
  check_count(pass.name, pass.files.paths.size(), items.size());
  if (!are_numbered || !pass.is_numbered()) return pass.files.paths;
  std::map<std::uint64_t, std::string> by_number;
  for (std::size_t i = 0; i < pass.files.paths.size(); ++i)
    by_number.emplace(pass.files.numbers[i], pass.files.paths[i]);
  std::vector<std::string> out;
  for (const FilterItem& item : items) out.push_back(by_number.at(*item.frame));
  return out;
}

bool is_folder(const std::string& path) {
  std::error_code ignored;
  return path.ends_with('/') || fs::is_directory(path, ignored);
}

}  // namespace

bool is_linear_file(const std::string& path) {
  const std::string ending = extension_of(path);
  return ending == ".exr" || ending == ".pfm";
}

std::vector<FilterItem> plan_items(const std::string& operand, const std::string& output) {
  const metrics::PictureFiles inputs = metrics::list_pictures(operand);
  if (inputs.paths.size() == 1 && inputs.paths.front() == operand) {
    if (is_folder(output))
      return {{.input = operand, .output = output_in_folder(output, operand), .is_in_folder = true}};
    return {{.input = operand, .output = output}};
  }
  std::vector<FilterItem> items;
  for (std::size_t i = 0; i < inputs.paths.size(); ++i) {
    FilterItem item{.input = inputs.paths[i], .output = {}};
    if (!inputs.numbers.empty()) item.frame = inputs.numbers[i];
    item.output = output_of(output, item.input, item.frame);
    items.push_back(std::move(item));
  }
  return items;
}

void check_outputs(std::span<const FilterItem> items, std::span<const std::string> kept) {
  OutputFiles files;
  for (std::size_t i = 0; i < items.size(); ++i) files.add(items[i].output, i);
  for (std::size_t i = 0; i < kept.size(); ++i) files.add(kept[i], items.size() + i, true);
  const std::optional<OutputFiles::Collision> found = files.find_collision();
  if (!found) return;
  if (found->is_read)
    throw Error(ErrorKind::Usage, fmt::format("{}: would replace the input {}; write elsewhere, or give --force",
                                              items[found->first].output, kept[found->second - items.size()]));
  throw Error(ErrorKind::Usage,
              fmt::format("--output: {} and {} would both be written to {}", items[found->first].input,
                          items[found->second].input, items[found->first].output));
}

FramePasses find_passes(const std::string& operand, std::span<const FilterItem> items, const std::string& depth,
                        const std::string& motion) {
  Sequence frames{.name = operand, .files = {}};
  for (const FilterItem& item : items)
    if (item.frame) frames.files.numbers.push_back(*item.frame);
  const Sequence depths = sequence_of("--depth", depth), motions = sequence_of("--motion", motion);
  std::vector<const Sequence*> numbered;
  for (const Sequence& s : {std::cref(frames), std::cref(depths), std::cref(motions)})
    if (s.is_numbered()) numbered.push_back(&s);
  if (frames.is_numbered()) check_numbers(numbered);
  return {files_for(items, depths, frames.is_numbered()), files_for(items, motions, frames.is_numbered())};
}

void check_count(const std::string& name, std::size_t files, std::size_t frames) {
  if (files != frames)
    throw Error(ErrorKind::Input,
                fmt::format("{}: has {} frames, expected {}, one for each image", name, files, frames));
}

std::string gaps_in(std::span<const FilterItem> items) {
  std::set<std::uint64_t> numbers;
  for (const FilterItem& item : items)
    if (item.frame) numbers.insert(*item.frame);
  std::uint64_t step = 0;
  for (auto at = numbers.begin(); at != numbers.end() && std::next(at) != numbers.end(); ++at)
    step = std::gcd(step, *std::next(at) - *at);
  constexpr std::size_t most = 1'000'000;  // a number such as a time is no sequence with gaps
  std::set<std::uint64_t> missing;
  for (auto at = numbers.begin(); step > 0 && at != numbers.end() && std::next(at) != numbers.end(); ++at)
    for (std::uint64_t number = *at + step; number < *std::next(at) && missing.size() < most; number += step)
      missing.insert(number);
  return ranges_of(missing);
}

}  // namespace zoneplate
