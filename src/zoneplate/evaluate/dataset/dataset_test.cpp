// SPDX-License-Identifier: Apache-2.0
// Tests that read data sets back as Arm's neural-graphics-model-gym does.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/evaluate/dataset/sequence.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/report/json_for_test.h"

namespace zoneplate {
namespace {

using Rows = std::array<std::array<double, 4>, 4>;
using Vector = std::array<double, 4>;

Vector product(const Rows& m, const Vector& v) {
  Vector out{};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) out[i] += m[i][j] * v[j];
  return out;
}

/// The solution x of m x = v, by elimination with pivots.
Vector solved(Rows m, Vector v) {
  for (std::size_t k = 0; k < 4; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < 4; ++i)
      if (std::abs(m[i][k]) > std::abs(m[pivot][k])) pivot = i;
    std::swap(m[k], m[pivot]), std::swap(v[k], v[pivot]);
    for (std::size_t i = 0; i < 4; ++i) {
      if (i == k) continue;
      const double factor = m[i][k] / m[k][k];
      for (std::size_t j = 0; j < 4; ++j) m[i][j] -= factor * m[k][j];
      v[i] -= factor * v[k];
    }
  }
  for (std::size_t k = 0; k < 4; ++k) v[k] /= m[k][k];
  return v;
}

/// Of a list in column-major order.
Rows rows_of(const nlohmann::json& list) {
  Rows out{};
  for (std::size_t i = 0; i < 16; ++i) out[i % 4][i / 4] = list[i].get<double>();
  return out;
}

class DatasetVerb : public ProgramTest {
 protected:
  std::vector<Plane<float>> exr(const std::string& name, const std::vector<std::string>& channels) const {
    const FileBytes file((place / name).string());
    EXPECT_EQ(exr_channel_names(file.bytes()).size(), channels[0] == "R" && channels.size() == 3 ? 4 : channels.size());
    return decode_exr_channels(file.bytes(), name, channels);
  }
  std::vector<Plane<float>> pass(const std::string& name, int frame, const std::vector<std::string>& channels,
                                 const char* sequence = "0000") const {
    return exr(fmt::format("data/{}/{}/{:04}.exr", name, sequence, frame), channels);
  }
  nlohmann::json json(const std::string& name) const { return parsed_json(text_of(place / name)); }
  /// The values of an array of NumPy, after its header.
  template <class T>
  std::vector<T> npy(const std::string& name) const {
    const std::string bytes = text_of(place / name);
    const std::size_t begin = bytes.find('\n') + 1;
    std::vector<T> out((bytes.size() - begin) / sizeof(T));
    std::memcpy(out.data(), bytes.data() + begin, out.size() * sizeof(T));
    return out;
  }
};

double bilinear(const Plane<float>& p, double x, double y) {
  const double cx = std::clamp(x, 0.0, p.width() - 1.0), cy = std::clamp(y, 0.0, p.height() - 1.0);
  const int i = std::min(static_cast<int>(cx), p.width() - 2), j = std::min(static_cast<int>(cy), p.height() - 2);
  const double u = cx - i, v = cy - j;
  const auto at = [&](int a, int b) { return static_cast<double>(p(i + a, j + b)); };
  return (at(0, 0) * (1 - u) + at(1, 0) * u) * (1 - v) + (at(0, 1) * (1 - u) + at(1, 1) * u) * v;
}

TEST_F(DatasetVerb, DepthMotionJitterAndCamerasAgree) {
  const ProgramAnswer answer =
      run("dataset teapot --layout nss -o data --sequences 1 --frames 3 --size 96x54 --ratio 2,1.5 --reference "
          "converged:samples=64");
  ASSERT_EQ(answer.code, 0) << answer.out;
  const nlohmann::json all = json("data/0000.json");
  EXPECT_EQ(all["Version"], "1.0.1");
  EXPECT_EQ(all["UpscalingRatiosIndices"]["x1_5_index"], 1);
  EXPECT_EQ(all["TargetResolution"]["X"], 96);
  ASSERT_EQ(all["Frames"].size(), 3u);
  EXPECT_EQ(all["Frames"][0]["CameraCut"], true);
  for (int frame = 1; frame < 3; ++frame) {
    const nlohmann::json &now = all["Frames"][static_cast<std::size_t>(frame)],
                         &last = all["Frames"][static_cast<std::size_t>(frame - 1)];
    EXPECT_EQ(now["CameraCut"], false);
    const Rows clip_now = rows_of(now["ViewProjection"]), clip_last = rows_of(last["ViewProjection"]);
    for (const auto& [folder, index, width, height] : {std::tuple("x2", 0, 48, 27), std::tuple("x1_5", 1, 64, 36)}) {
      const Plane<float> depth = pass(std::string(folder) + "/depth", frame, {"R"})[0];
      const std::vector<Plane<float>> motion = pass(std::string(folder) + "/motion", frame, {"R", "G"});
      EXPECT_EQ(pass(std::string(folder) + "/color", frame, {"R", "G", "B"})[0].width(), width);
      ASSERT_EQ(depth.width(), width);
      ASSERT_EQ(depth.height(), height);
      const nlohmann::json& jitter = now["NormalizedPerRatioJitter"][static_cast<std::size_t>(index)];
      EXPECT_NEAR(jitter["X"].get<double>() * width, now["Jitter"]["X"].get<double>(), 1e-9);
      int surfaces = 0;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const double u = (x + 0.5) / width + jitter["X"].get<double>();
          const double v = (y + 0.5) / height + jitter["Y"].get<double>();
          const double z = static_cast<double>(depth(x, y));  // ReverseZ is false
          if (z >= 1) continue;                               // background
          ++surfaces;
          const Vector point = solved(clip_now, {2 * u - 1, 1 - 2 * v, z, 1});
          const Vector before = product(clip_last, point);
          const double moved_x = u - (before[0] / before[3] + 1) / 2, moved_y = v - (1 - before[1] / before[3]) / 2;
          // Vertices snap to 1/256 pixel in both frames, and motion is a half float.
          EXPECT_NEAR(static_cast<double>(motion[0](x, y)), moved_x, 2.0 / 256 / width + std::abs(moved_x) / 1024);
          EXPECT_NEAR(static_cast<double>(motion[1](x, y)), moved_y, 2.0 / 256 / height + std::abs(moved_y) / 1024);
        }
      EXPECT_GT(surfaces, width * height / 10);
    }
  }
}

// A frame of 50 x 21 pixels shows the view of an image of 101 x 43, whose sides have another ratio.
TEST_F(DatasetVerb, BackgroundsMoveAlikeAtAllSizes) {
  ASSERT_EQ(
      run("dataset teapot --layout nss -o data --sequences 1 --frames 2 --size 101x43 --ratio 2 --reference none").code,
      0);
  const std::vector<Plane<float>> whole = pass("motion_gt", 1, {"R", "G"}), low = pass("x2/motion", 1, {"R", "G"});
  ASSERT_EQ(low[0].width(), 50);
  ASSERT_EQ(low[0].height(), 21);
  for (const auto& [x, y] : {std::pair(0.0, 0.0), {49.0, 0.0}, {0.0, 20.0}, {49.0, 20.0}}) {
    const double u = (x + 0.5) / 50 * 101 - 0.5, v = (y + 0.5) / 21 * 43 - 0.5;
    for (std::size_t c = 0; c < 2; ++c) {
      const double expected = bilinear(whole[c], u, v), found = bilinear(low[c], x, y);
      // Jitter of half a pixel, and half floats.
      EXPECT_NEAR(found, expected, 0.002 * std::abs(expected) + 5e-5) << x << ',' << y;
    }
  }
}

TEST_F(DatasetVerb, PassesTheHealthChecksOfTheGym) {
  ASSERT_EQ(
      run("dataset tiles sphere:triangles=3000 --layout nss -o data --sequences 2 --frames 6 --size 128x72 --reference "
          "converged:samples=64")
          .code,
      0);
  const nlohmann::json all = json("data/0001.json");
  for (int frame = 1; frame < 6; ++frame) {
    // Its DenseWarp reads at the pixel's position minus the motion, or minus the jitter, in pixels.
    const Plane<float> truth = pass("ground_truth", frame, {"R", "G", "B"})[1];
    const Plane<float> before = pass("ground_truth", frame - 1, {"R", "G", "B"})[1];
    const std::vector<Plane<float>> motion = pass("motion_gt", frame, {"R", "G"});
    double still = 0, warped = 0, backwards = 0;
    for (int y = 0; y < 72; ++y)
      for (int x = 0; x < 128; ++x) {
        const double expected = static_cast<double>(truth(x, y));
        const double mx = static_cast<double>(motion[0](x, y)) * 128, my = static_cast<double>(motion[1](x, y)) * 72;
        const double moved = bilinear(before, x - mx, y - my), opposite = bilinear(before, x + mx, y + my);
        backwards += std::pow(opposite - expected, 2);
        still += std::pow(static_cast<double>(before(x, y)) - expected, 2), warped += std::pow(moved - expected, 2);
      }
    EXPECT_LT(warped, still) << frame;
    EXPECT_LT(warped, 0.7 * backwards) << frame;

    const Plane<float> low = pass("x2/color", frame, {"R", "G", "B"}, "0001")[1];
    const Plane<float> sharp = pass("ground_truth", frame, {"R", "G", "B"}, "0001")[1];
    const nlohmann::json& jitter = all["Frames"][static_cast<std::size_t>(frame)]["Jitter"];
    const double jx = jitter["X"].get<double>(), jy = jitter["Y"].get<double>();
    double with = 0, without = 0, opposite = 0;
    for (int y = 1; y < 35; ++y)
      for (int x = 1; x < 63; ++x) {
        const auto t = [&](int i, int j) { return static_cast<double>(sharp(2 * x + i, 2 * y + j)); };
        const double expected = (t(0, 0) + t(1, 0) + t(0, 1) + t(1, 1)) / 4;
        without += std::pow(bilinear(low, x, y) - expected, 2);
        with += std::pow(bilinear(low, x - jx, y - jy) - expected, 2);
        opposite += std::pow(bilinear(low, x + jx, y + jy) - expected, 2);
      }
    EXPECT_LE(with, without) << frame;
    EXPECT_LE(with, opposite) << frame;
  }
}

TEST_F(DatasetVerb, ShardsAndRepetitionsMakeTheSameBytes) {
  const std::string usual =
      "dataset panning-wires stars --layout nss --sequences 3 --frames 2 --size 32x18 --reference ssaa:n=2";
  ASSERT_EQ(run(usual + " -o data").code, 0);
  ASSERT_EQ(run(usual + " -o parts --shard 1/2 --threads 1").code, 0);
  EXPECT_FALSE(std::filesystem::exists(place / "parts/0000.json"));
  ASSERT_EQ(run(usual + " -o parts --shard 0/2").code, 0);
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(place / "data")) {
    if (!entry.is_regular_file()) continue;
    ++files;
    EXPECT_EQ(text_of(entry), text_of(place / "parts" / std::filesystem::relative(entry, place / "data"))) << entry;
  }
  EXPECT_EQ(files, 3 * (2 * 5 + 1));
  EXPECT_NE(json("data/0000.json")["Frames"][0]["ViewProjection"],
            json("data/0002.json")["Frames"][0]["ViewProjection"]);
  // A complete sequence is left as it is, an incomplete one is made again, another one is not overwritten.
  std::filesystem::remove(place / "data/0001.json");
  std::filesystem::remove(place / "data/x2/color/0000/0000.exr");
  ASSERT_EQ(run(usual + " -o data").code, 0);
  EXPECT_TRUE(std::filesystem::exists(place / "data/0001.json"));
  EXPECT_FALSE(std::filesystem::exists(place / "data/x2/color/0000/0000.exr"));
  const ProgramAnswer other = run(usual + " -o data --seed 2");
  EXPECT_EQ(other.code, 4);
  EXPECT_TRUE(contains(other.out, "data/0000.json: is of a sequence with other settings")) << other.out;
}

/// FNV-1a over the bits of all channels of a pass's frames.
std::uint64_t hash_of(const std::vector<Plane<float>>& channels, std::uint64_t h) {
  for (const Plane<float>& plane : channels)
    for (const float value : plane.values())
      for (int byte = 0; byte < 4; ++byte)
        h = (h ^ (std::bit_cast<std::uint32_t>(value) >> (8 * byte) & 0xff)) * 0x100000001b3u;
  return h;
}

// The files themselves also depend on the compression library.
TEST_F(DatasetVerb, SequencesHaveTheHashesOfTheRepository) {
  std::istringstream list(
      text_of(std::filesystem::path(source_root) / "src/zoneplate/evaluate/dataset/nss_hashes.txt"));
  std::string line, options, made;
  int rows = 0;
  while (std::getline(list, line)) {
    if (line.starts_with("zoneplate dataset ")) {
      options = line.substr(std::string("zoneplate ").size());
      std::filesystem::remove_all(place / "data");
      ASSERT_EQ(run(options).code, 0) << line;
    }
    if (line.empty() || line[0] != ' ') continue;
    std::istringstream row(line);
    std::string sequence, name, hash;
    row >> sequence >> name >> hash;
    std::vector<std::string> channels{"R", "G"};
    if (name == "ground_truth" || name.ends_with("color")) channels.push_back("B");
    if (name.ends_with("depth")) channels = {"R"};
    std::uint64_t h = 0xcbf29ce484222325u;
    for (int frame = 0; frame < 2; ++frame) h = hash_of(pass(name, frame, channels, sequence.c_str()), h);
    EXPECT_EQ(fmt::format("{:016x}", h), hash) << options << ": " << sequence << ' ' << name;
    ++rows;
  }
  EXPECT_EQ(rows, 2 * 2 * 5);
}

// From the frames in files an upscaler makes the film that compare measures; its codes of 8 bits differ by rounding.
TEST_F(DatasetVerb, TheFramesOfCompareGiveItsPsnr) {
  for (const char* scene : {"teleport", "moving-texture"}) {  // an orthographic camera, and textures
    std::filesystem::remove_all(place / "data");
    const ProgramAnswer compared = run(fmt::format(
        "compare {} --frames 6 --size 80x60 --reference converged:samples=64 --metric psnr --aa taau:scale=2 -o films "
        "--force",
        scene));
    ASSERT_EQ(compared.code, 0) << compared.out;
    ASSERT_EQ(run(fmt::format("dataset {} --layout exr -o data --sequences 1 --frames 6 --rate 24 --size 80x60 --start "
                              "0 --camera own --reference converged:samples=64",
                              scene))
                  .code,
              0);
    const ProgramAnswer filtered =
        run("filter data/x2/color/0000 --depth data/x2/depth/0000 --motion data/x2/motion/0000 --jitter "
            "data/jitter/0000.txt --upscale taau:scale=2 -o out --force");
    ASSERT_EQ(filtered.code, 0) << filtered.out;
    const ProgramAnswer measured = run("metrics data/ground_truth/0000/####.exr out/####.exr --metric psnr --json");
    const double found =
        parsed_json(measured.out.substr(0, measured.out.find('\n')))["metrics"]["psnr"]["value"].get<double>();
    const nlohmann::json result = json("films/compare.json")["scenes"][0]["methods"][0]["metrics"];
    EXPECT_NEAR(found, result["psnr"]["value"].get<double>(), 0.03) << scene;
  }
}

TEST_F(DatasetVerb, ArraysHaveThePlanesOfTheImages) {
  const std::string usual =
      "dataset passing-fence --sequences 1 --frames 2 --size 40x30 --reference ssaa:n=2 --passes object-id,count ";
  ASSERT_EQ(run(usual + "--layout exr -o data").code, 0);
  ASSERT_EQ(run(usual + "--layout npy -o arrays").code, 0);
  EXPECT_EQ(json("data/0000.json")["Frames"], json("arrays/0000.json")["Frames"]);
  EXPECT_EQ(text_of(place / "data/jitter/0000.txt"), text_of(place / "arrays/jitter/0000.txt"));
  for (const auto& [name, channels] : {std::pair("ground_truth", std::vector<std::string>{"R", "G", "B"}),
                                       {"motion_gt", {"R", "G"}},
                                       {"object_id_gt", {"R"}},
                                       {"count_gt", {"R"}},
                                       {"x2/color", {"R", "G", "B"}},
                                       {"x2/depth", {"R"}},
                                       {"x2/motion", {"R", "G"}},
                                       {"x2/object_id", {"R"}},
                                       {"x2/count", {"R"}}}) {
    const std::string file = fmt::format("{}/0000/0001", name);
    const FileBytes image((place / "data" / (file + ".exr")).string());
    const std::vector<Plane<float>> planes = decode_exr_channels(image.bytes(), name, channels);
    const bool is_number = channels.size() == 1 && std::string_view(name).find("depth") == std::string_view::npos;
    std::vector<float> found;
    if (is_number)
      for (const std::uint32_t n : npy<std::uint32_t>("arrays/" + file + ".npy"))
        found.push_back(static_cast<float>(n));
    else
      found = npy<float>("arrays/" + file + ".npy");
    ASSERT_EQ(found.size(), channels.size() * planes[0].values().size()) << name;
    for (std::size_t i = 0; i < found.size(); ++i)
      ASSERT_EQ(found[i], planes[i % channels.size()].values()[i / channels.size()]) << name;
  }
}

TEST_F(DatasetVerb, CamerasKeepTheirProjectionButInTheGymsLayout) {
  const std::string usual = "dataset teleport teapot --sequences 2 --frames 2 --size 32x24 --reference none --layout ";
  ASSERT_EQ(run(usual + "npy -o data").code, 0);
  ASSERT_EQ(run(usual + "nss -o gym").code, 0);
  const nlohmann::json parallel = json("data/0000.json")["Frames"], perspective = json("data/0001.json")["Frames"];
  EXPECT_TRUE(parallel[0].contains("HalfHeight") && !parallel[0].contains("FovY"));
  EXPECT_NE(parallel[0]["HalfHeight"], parallel[1]["HalfHeight"]);
  EXPECT_NE(parallel[0]["WorldFromCamera"], parallel[1]["WorldFromCamera"]);
  EXPECT_TRUE(perspective[0].contains("FovY") && !perspective[0].contains("HalfHeight"));
  EXPECT_GT(json("gym/0000.json")["Frames"][0]["FovY"].get<double>(), 0);
}

TEST_F(DatasetVerb, CountsAreThoseOfSurfacesInView) {
  const std::string usual =
      "--layout npy --sequences 1 --frames 5 --size 64x48 --reference none --camera own --start 0 --passes "
      "was-visible,count";
  ASSERT_EQ(run("dataset tiles -o rest " + usual).code, 0);
  const auto at_rest = npy<std::uint32_t>("rest/count_gt/0000/0004.npy");
  const auto seen = npy<std::uint8_t>("rest/was_visible_gt/0000/0004.npy");
  for (std::size_t i = 0; i < at_rest.size(); ++i) ASSERT_EQ(at_rest[i], seen[i] != 0 ? 5u : 1u);
  EXPECT_GT(std::ranges::count(seen, std::uint8_t{1}), static_cast<std::ptrdiff_t>(seen.size() / 2));
  ASSERT_EQ(run("dataset disocclusion -o data " + usual).code, 0);
  const auto counts = npy<std::uint32_t>("data/x2/count/0000/0004.npy");
  const auto visible = npy<std::uint8_t>("data/x2/was_visible/0000/0004.npy");
  int hidden = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (visible[i] == 0) {
      ++hidden;
      ASSERT_EQ(counts[i], 1u);
    }
    ASSERT_LE(counts[i], 5u);
  }
  EXPECT_GT(hidden, 0);
  EXPECT_GT(std::ranges::count(counts, 5u), static_cast<std::ptrdiff_t>(counts.size() / 2));
}

TEST_F(DatasetVerb, ABiasOfMipLevelsChangesTexturedFramesAlone) {
  const std::string usual =
      " --layout npy --sequences 1 --frames 2 --size 64x48 --reference none --camera own --start 0 ";
  ASSERT_EQ(run("dataset moving-texture -o data" + usual).code, 0);
  ASSERT_EQ(run("dataset moving-texture -o sharp --bias -1" + usual).code, 0);
  const auto equals = [&](const std::string& file) {
    return text_of(place / "data" / file) == text_of(place / "sharp" / file);
  };
  EXPECT_FALSE(equals("x2/color/0000/0001.npy"));
  EXPECT_TRUE(equals("ground_truth/0000/0001.npy") && equals("x2/depth/0000/0001.npy"));
}

TEST_F(DatasetVerb, RefusesBeforeItRenders) {
  EXPECT_EQ(run("dataset --layout nss -o data --passes count").code, 2);

  EXPECT_EQ(run("dataset -o data").code, 2);
  EXPECT_TRUE(contains(run("dataset --layout nss -o data --ratio 1.77").out, "with one decimal"));
  EXPECT_EQ(run("dataset no-such.glb --layout nss -o data").code, 3);
  EXPECT_EQ(run("dataset --layout nss -o data --reference convergd").code, 2);
  EXPECT_FALSE(std::filesystem::exists(place / "data"));
}

TEST(Dataset, FoldersOfRatios) {
  EXPECT_EQ(folder_of_ratio(2), "x2");
  EXPECT_EQ(folder_of_ratio(1.7), "x1_7");
}

}  // namespace
}  // namespace zoneplate
