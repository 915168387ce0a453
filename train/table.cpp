// SPDX-License-Identifier: Apache-2.0
// table DATA -o TABLE: finds the filters of `learned-table` by least squares, from sequences that
//   zoneplate dataset --layout npy --ratio 2
// has written. table DATA --network WEIGHTS -o TABLE: those of `learned`, whose network has these weights. table
// --still SMALL TRUTH -o TABLE: those of `learned-table-still`, from PNG images of equal names in two folders, the
// second of twice the size. The tables have the same bytes on every machine.
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/codec/png.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/upscale/learned/learned_mean.h"
#include "zoneplate/upscale/table/learned_table.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;
using upscale::TableFit;

std::vector<std::uint8_t> bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path.string() + " cannot be read");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Rows, columns and channels of 32-bit floats.
struct Array {
  int height = 0, width = 0, channels = 0;
  std::vector<float> values;
};
Array read_npy(const fs::path& path) {
  const std::vector<std::uint8_t> bytes = bytes_of(path);
  const auto fail = [&] { return std::runtime_error(path.string() + " is not an array of 32-bit floats"); };
  if (bytes.size() < 10 || std::memcmp(bytes.data(), "\x93NUMPY\1\0", 8) != 0) throw fail();
  const std::size_t begin = 10 + bytes[8] + 256u * bytes[9];
  const std::string header(bytes.begin() + 10, bytes.begin() + static_cast<std::ptrdiff_t>(begin));
  Array out;
  const std::size_t shape = header.find('(');
  if (header.find("'<f4'") == header.npos || shape == header.npos ||
      std::sscanf(header.c_str() + shape, "(%d, %d, %d", &out.height, &out.width, &out.channels) < 2)
    throw fail();
  out.channels = std::max(out.channels, 1);
  out.values.resize(static_cast<std::size_t>(out.height) * static_cast<std::size_t>(out.width) *
                    static_cast<std::size_t>(out.channels));
  if (bytes.size() - begin != out.values.size() * sizeof(float)) throw fail();
  std::memcpy(out.values.data(), bytes.data() + begin, bytes.size() - begin);
  return out;
}

LinearImage color_of(const Array& array) {
  LinearImage out(array.width, array.height);
  for (std::size_t i = 0; i < out.values().size(); ++i) {
    const float* const v = array.values.data() + i * static_cast<std::size_t>(array.channels);
    out.values()[i] = {v[0], v[1], v[2], 1};
  }
  return out;
}

/// The sums of a sequence are divided by its mean square error, relative to a typical one: equal gains in dB count the
/// same, as in the loss of networks. The smaller constant bounds the weight of sequences almost without error.
constexpr double typical_error = 0.002, smallest_error = 1e-6;

/// `network`: that of `learned`; null: `taau`.
void add_sequence(const fs::path& data, const std::string& name, const network::Network* network, TableFit& fit) {
  TableFit sequence(upscale::CountGroups::form);
  const nlohmann::json info = nlohmann::json::parse(bytes_of(data / (name + ".json")));
  const int width = info["Width"], height = info["Height"];
  const auto mean = network ? std::make_unique<upscale::LearnedMean>(width, height, *network)
                            : std::make_unique<upscale::SampleMean>(width, height);
  int index = 0;
  for (const nlohmann::json& frame : info["Frames"]) {
    const std::string file = fmt::format("{}/{:04}.npy", name, index);
    const Array color = read_npy(data / "x2/color" / file), depth = read_npy(data / "x2/depth" / file),
                motion = read_npy(data / "x2/motion" / file);
    upscale::TaauInput input{.color = color_of(color),
                             .nearness = Plane<float>(color.width, color.height),
                             .motion_x = Plane<float>(color.width, color.height),
                             .motion_y = Plane<float>(color.width, color.height),
                             .jitter = {-frame["Jitter"][0].get<float>(), -frame["Jitter"][1].get<float>()},
                             .is_first = index == 0};
    const float near = frame["Near"], far = frame["Far"];
    const bool is_orthographic = frame.contains("HalfHeight");
    for (std::size_t i = 0; i < depth.values.size(); ++i) {
      const float d = depth.values[i];
      const float nearness = is_orthographic ? (far - d) / (far - near) : near * (far - d) / (d * (far - near));
      input.nearness.values()[i] = d < far ? std::clamp(nearness, 0.0f, 1.0f) : 0;
      input.motion_x.values()[i] = motion.values[2 * i], input.motion_y.values()[i] = motion.values[2 * i + 1];
    }
    const LinearImage image = mean->accumulate(input);
    if (index % 3 == 0)
      sequence.add(image, upscale::CountGroups::of(mean->counts()), color_of(read_npy(data / "ground_truth" / file)));
    ++index;
  }
  fit.add(sequence, typical_error / (sequence.error() + smallest_error));
}

LinearImage read_png(const fs::path& path) {
  const Rgba8Image codes = decode_png(bytes_of(path), path.string()).pixels;
  LinearImage out(codes.width(), codes.height());
  std::ranges::transform(codes.values(), out.values().begin(), [](const Rgba8& c) {
    return Linear{decode_srgb8(c.r), decode_srgb8(c.g), decode_srgb8(c.b), 1};
  });
  return out;
}

void add_still(const fs::path& small, const fs::path& truth, TableFit& fit) {
  const LinearImage from = read_png(small), to = read_png(truth);
  const upscale::Interpolated base =
      upscale::interpolated(from, {from.width(), from.height(), 0, 0, {to.width(), to.height(), std::nullopt}});
  fit.add(base.image, base.group, to);
}

/// The names of the files of an extension, in order, without it.
std::vector<std::string> names_in(const fs::path& folder, const char* extension) {
  std::vector<std::string> out;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == extension) out.push_back(entry.path().stem().string());
  std::ranges::sort(out);
  return out;
}

constexpr const char* usage =
    "usage: table DATA -o TABLE\n       table DATA --network WEIGHTS -o TABLE\n       table --still SMALL TRUTH -o "
    "TABLE\n";

int run(const std::vector<std::string>& args) {
  const bool is_still = !args.empty() && args[0] == "--still", has_network = args.size() > 1 && args[1] == "--network";
  if (args.size() != (is_still || has_network ? 5u : 3u) || args[args.size() - 2] != "-o") {
    fmt::print(stderr, "{}", usage);
    return 2;
  }
  const fs::path data = args[is_still ? 1 : 0];
  std::optional<network::Network> network;
  if (has_network) network.emplace(bytes_of(args[2]), upscale::LearnedNetwork::form, args[2]);
  const std::vector<std::string> names = names_in(data, is_still ? ".png" : ".json");
  TableFit fit(is_still ? upscale::PhaseGroups::form : upscale::CountGroups::form);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (is_still)
      add_still(data / (names[i] + ".png"), fs::path(args[2]) / (names[i] + ".png"), fit);
    else
      add_sequence(data, names[i], network ? &*network : nullptr, fit);
    if ((i + 1) % 20 == 0 || i + 1 == names.size()) fmt::print("{} of {}\n", i + 1, names.size());
  }
  const std::vector<std::uint8_t> table = fit.bytes();
  const fs::path output = args.back(), part = args.back() + ".part";
  std::ofstream(part, std::ios::binary)
      .write(reinterpret_cast<const char*>(table.data()), static_cast<std::streamsize>(table.size()));
  fs::rename(part, output);
  return 0;
}

}  // namespace
}  // namespace zoneplate

int main(int argc, char** argv) {
  try {
    return zoneplate::run({argv + 1, argv + argc});
  } catch (const std::exception& e) {
    fmt::print(stderr, "table: {}\n", e.what());
    return 1;
  }
}
