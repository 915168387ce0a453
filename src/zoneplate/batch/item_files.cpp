// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/item_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "zoneplate/base/error.h"
#include "zoneplate/base/sha256.h"
#include "zoneplate/batch/whole_file.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/job/check.h"
#include "zoneplate/job/environment_file.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

bool is_whole(const BatchItem& args, const std::string& path) {
  std::error_code ignored;
  try {
    return fs::is_regular_file(path, ignored) && can_be_whole(args, path);
  } catch (const Error&) {  // without permission to read it, for example
    return false;
  }
}

bool are_whole(const BatchItem& args, int frame, const Ledger* ledger) {
  const std::string job = ledger != nullptr ? job_digest(args) : "";
  for (int layer = -1; layer < static_cast<int>(args.aovs.size()); ++layer) {
    const std::string path = output_path(args, frame, layer);
    if (ledger != nullptr ? !ledger->has_whole(path, job) : !is_whole(args, path)) return false;
  }
  return true;
}

bool keeps_files(const BatchItem& args, const Ledger* ledger) { return args.skip_existing || ledger != nullptr; }

// The name of a data pass of frames: its ending follows the frame number.
std::string with_layer(const BatchItem& args, const Aov& aov) {
  const std::size_t end = args.frame_place->begin + args.frame_place->size;
  return args.output.substr(0, end) + aov_path('0' + args.output.substr(end), aov.name).substr(1);
}

}  // namespace

void add_files(const BatchItem& args, std::uint64_t item, OutputFiles& files) {
  std::vector<std::string> inputs = environment_files(args);
  inputs.push_back(args.input);
  for (std::string& path : args.default_material.files()) inputs.push_back(std::move(path));
  for (const std::string& read : inputs)
    if (is_picture_ending(extension_of(read))) files.add(read, item, true);
  if (!args.frame_place) {
    for (int layer = -1; layer < static_cast<int>(args.aovs.size()); ++layer)
      files.add(output_path(args, 0, layer), item);
    return;
  }
  const SequenceArgs& s = args.sequence;
  const std::int64_t first = s.first_frame(), longest = std::int64_t{max_frames - 1} * s.jump;
  const FrameNumbers frames{first, s.last_frame().value_or(first + longest), s.jump};
  files.add(args.output, *args.frame_place, frames, item);
  for (const Aov* aov : args.aovs)
    if (const std::string name = with_layer(args, *aov); name != args.output)
      files.add(name, *args.frame_place, frames, item);
}

void check_own_files(const BatchItem& args) {
  OutputFiles files;
  add_files(args, 0, files);
  if (const auto collision = files.find_collision())
    throw Error(ErrorKind::Usage,
                fmt::format("{} would be written to {}, which is read as well", args.input, collision->path));
}

void check_outputs(const BatchItem& args) {
  if (args.output == "-" && ::isatty(STDOUT_FILENO) == 1)
    throw Error(ErrorKind::Usage, "an image will not be written to a terminal");
  const int frame = args.sequence.first.value_or(0);
  for (int layer = -1; layer < static_cast<int>(args.aovs.size()); ++layer)
    check_savable(output_path(args, frame, layer));
}

std::string job_digest(const BatchItem& args) {
  const LoadLimits& limits = args.load.limits;  // files beside the model, and what is left out of it
  return sha256_of(fmt::format("{}\n{}\n{}{}\n{}", args.input, extension_of(args.named_output()), args.given,
                               limits.is_strict, fmt::join(limits.allowed_paths, "\n")))
      .substr(0, 16);
}

std::size_t folder_end(const BatchItem& args) {
  const std::size_t slash =
      args.output.substr(0, args.frame_place ? args.frame_place->begin : args.output.npos).rfind('/');
  return slash == std::string::npos ? 0 : slash + 1;
}

bool can_be_whole(const BatchItem& args, const std::string& path) {
  const FileBytes file(path);
  if (extension_of(path) != ".rgba") return is_whole_file(extension_of(path), file.bytes());
  const std::optional<Crop>& crop = args.options.crop;
  const auto width = static_cast<std::uint64_t>(crop ? crop->width : args.options.width);
  const auto height = static_cast<std::uint64_t>(crop ? crop->height : args.options.height);
  return file.bytes().size() == width * height * (args.bit_depth == 16 ? 8 : 4);
}

bool is_finished(const BatchItem& args, const Ledger* ledger) {
  return keeps_files(args, ledger) && !args.frame_place && args.output != "-" && are_whole(args, 0, ledger);
}

std::vector<int> finished_frames(const BatchItem& args, const Ledger* ledger) {
  std::vector<int> frames;
  if (!keeps_files(args, ledger) || !args.frame_place) return frames;
  // The frame number is in the name of a file, or of a folder of files.
  const std::string& path = args.output;
  const std::size_t place = args.frame_place->begin, place_end = place + args.frame_place->size;
  const std::size_t begin = folder_end(args);
  const std::string before = path.substr(begin, place - begin);
  const std::string after = path.substr(place_end, std::min(path.find('/', place_end), path.size()) - place_end);
  std::error_code error;
  fs::directory_iterator entry(begin == 0 ? "." : path.substr(0, begin), error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.size() < before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after)) continue;
    const auto frame =
        frame_of(std::string_view(name).substr(before.size(), name.size() - before.size() - after.size()),
                 args.frame_place->digits);
    const std::int64_t last = args.sequence.last_frame().value_or(std::numeric_limits<int>::max());
    if (!frame || *frame < args.sequence.first_frame() || *frame > last) continue;
    if (are_whole(args, static_cast<int>(*frame), ledger)) frames.push_back(static_cast<int>(*frame));
  }
  std::ranges::sort(frames);
  return frames;
}

}  // namespace zoneplate
