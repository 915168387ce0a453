// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/parts/render_parts.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>
#include <cmath>
#include <filesystem>
#include <map>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/base/ranks/ranks_for_test.h"
#include "zoneplate/job/check.h"
#include "zoneplate/job/option_values.h"
#include "zoneplate/job/parts/scene_of_files.h"
#include "zoneplate/job/render_job.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

using Files = std::map<int, std::vector<std::uint8_t>>;  // by layer

class CollectedFiles : public JobSink {
 public:
  void file(int, int layer, std::span<const std::uint8_t> bytes) override {
    files[layer] = {bytes.begin(), bytes.end()};
  }
  void film_frame(const Rgba8Image&) override {}
  Files files;
};

/// Six blended spheres, one in the other, as OBJ files with one MTL file.
class ShellFiles : public ::testing::Test {
 protected:
  ShellFiles() : folder_(std::filesystem::temp_directory_path() / fmt::format("zoneplate-shells-{}", ::getpid())) {
    std::filesystem::create_directories(folder_);
    std::string materials;
    for (int s = 0; s < 6; ++s) {
      materials += fmt::format("newmtl glass{}\nKd {} {} 0.5\nd 0.35\n", s, 0.2 + 0.1 * s, 0.9 - 0.1 * s);
      names.push_back(folder_ / fmt::format("shell{}.obj", s));
      save(names.back(), shell(s));
    }
    save(folder_ / "shells.mtl", materials);
  }
  ~ShellFiles() override { std::filesystem::remove_all(folder_); }

  std::vector<std::string> names;

 private:
  static void save(const std::string& path, const std::string& text) {
    save_bytes(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  static std::string shell(int s) {
    constexpr int rows = 8, columns = 16;
    std::string text = fmt::format("mtllib shells.mtl\nusemtl glass{}\n", s);
    for (int i = 0; i <= rows; ++i)
      for (int j = 0; j <= columns; ++j) {
        const double a = 3.14159 * i / rows, b = 6.28318 * j / columns, r = 0.4 + 0.1 * s;
        text += fmt::format("v {:.5f} {:.5f} {:.5f}\n", r * std::sin(a) * std::cos(b) + 0.05 * s, r * std::cos(a),
                            r * std::sin(a) * std::sin(b));
      }
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) {
        const int k = i * (columns + 1) + j + 1;
        text += fmt::format("f {} {} {} {}\n", k, k + columns + 1, k + columns + 2, k + 1);
      }
    return text;
  }
  std::filesystem::path folder_;
};

Job job_of(const std::string& input) {
  Job job;
  job.input = input, job.output = "out.png";
  job.options.width = 120, job.options.height = 90;
  job.method = "msaa:n=8";
  job.aovs = parse_aovs("depth,object-id,primitive-id");
  return job;
}

Files render(const Job& job, const std::vector<std::string>& inputs, int count,
             Partition partition = Partition::Index) {
  Files files;
  ThreadRanks(count).run([&](Ranks& ranks) {
    with_threads(1, [&] {
      CollectedFiles out;
      PartTimes times;
      Job own = job;
      check_job(own);
      render_parts(
          {own, inputs, partition}, ranks, [](const std::function<void()>& body) { body(); }, out, times);
      EXPECT_EQ(out.files.empty(), ranks.rank() != 0);
      if (ranks.rank() == 0) files = std::move(out.files);
    });
  });
  return files;
}

TEST(RenderParts, OneModelHasTheFilesOfOneProcess) {
  Job job = job_of("teapot");
  check_job(job);
  CollectedFiles whole;
  RenderJobs().run(job, whole);
  ASSERT_EQ(whole.files.size(), 4u);
  for (const int count : {1, 3})
    for (const Partition partition : {Partition::Node, Partition::Interleaved})
      EXPECT_EQ(render(job_of("teapot"), {"teapot"}, count, partition), whole.files) << count;
}

TEST_F(ShellFiles, OfSeveralRanksGiveTheImageOfOne) {
  const Files whole = render(job_of(names.front()), names, 1);
  ASSERT_EQ(whole.size(), 4u);
  for (const int count : {2, 3, 5, 8}) EXPECT_EQ(render(job_of(names.front()), names, count), whole) << count;
  const std::vector<std::string> fewer(names.begin(), names.begin() + 5);
  EXPECT_NE(render(job_of(names.front()), fewer, 2), whole);
}

TEST_F(ShellFiles, AreJoinedWithTheIdsOfTheWhole) {
  ThreadRanks(4).run([&](Ranks& ranks) {
    std::vector<Scene> own(names.size());
    for (std::size_t i = 0; i < names.size(); ++i)
      if (rank_of_file(i, names.size(), 4) == ranks.rank()) own[i] = load_scene(names[i], {});
    const SceneOfFiles joined = join_files(names, std::move(own), ranks);
    ASSERT_EQ(joined.scene.instances.size(), 6u);
    ASSERT_EQ(joined.scene.materials.size(), 6u);
    EXPECT_EQ(joined.bounds.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
      const Mesh& mesh = joined.scene.meshes[static_cast<std::size_t>(joined.scene.instances[i].mesh)];
      const bool is_own = rank_of_file(i, 6, 4) == ranks.rank();
      EXPECT_EQ(mesh.material, static_cast<int>(i));
      EXPECT_EQ(joined.scene.materials[i].alpha_mode, AlphaMode::Blend);
      EXPECT_EQ(mesh.primitives(), is_own ? 256u : 0u);
      EXPECT_EQ(joined.elsewhere[i], is_own ? 0u : 256u);
    }
  });
}

TEST_F(ShellFiles, RefuseWhatNeedsAllOfThem) {
  Job job = job_of(names.front());
  job.options.shadows.method = ShadowMethod::Hard;
  EXPECT_THROW(render(job, names, 1), Error);
  job = job_of(names.front());
  job.method = "analytic";
  EXPECT_THROW(render(job, names, 1), Error);
  job = job_of(names.front());
  job.meters_exposure = true;
  EXPECT_THROW(render(job, names, 1), Error);
  job = job_of(names.front());
  job.section.planes.emplace_back();
  EXPECT_THROW(render(job, names, 1), Error);
}

}  // namespace
}  // namespace zoneplate
