// SPDX-License-Identifier: Apache-2.0
// The built program where the system refuses parts of the sandbox, has no /proc, or few descriptors: it draws the same
// image and names what is missing in one warning.
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <vector>

#include "zoneplate/base/utf8.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/os/sandbox.h"

namespace zoneplate {
namespace {

struct RefusedCall {
  long number;
  int error;
};

class RestrictedSystem : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("tri.obj", "mtllib tri.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("tri.mtl", "newmtl red\nKd 1 0 0\n");
    write("tri.gltf", R"({"asset":{"version":"2.0"},"scene":0,
      "scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
      "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"tri.bin"}]})");
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    write("tri.bin", {reinterpret_cast<const char*>(corners), sizeof corners});
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(place / name, std::ios::binary) << text;
  }

  static std::string arguments(const std::string& model, const std::string& image) {
    return model + " --size 40x30 --progress none -o " + image;
  }
  std::string picture(const std::string& model) const {
    EXPECT_EQ(run(arguments(model, "expected.png")).code, 0);
    return text_of(place / "expected.png");
  }

  /// Renders in a process to which a filter of its own, as that of a container, refuses these system calls.
  ProgramAnswer render_refusing(const std::vector<RefusedCall>& calls) const {
    const std::string output = (place / "output").string();
    const pid_t child = ::fork();
    if (child == 0) {
      std::vector<sock_filter> filter{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
      for (const RefusedCall& call : calls) {
        filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<__u32>(call.number), 0, 1));
        filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | static_cast<__u32>(call.error)));
      }
      filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
      const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
      const int out = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      ::dup2(out, STDOUT_FILENO), ::dup2(out, STDERR_FILENO);
      if (::chdir(place.c_str()) != 0 || ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
          ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0)
        ::_exit(99);
      ::execl(program_file, program_file, "tri.obj", "--size", "40x30", "--progress", "none", "-o", "a.png", nullptr);
      ::_exit(98);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(output)};
  }

  /// Checks that there is one line about it, with these words, and an image that is the expected one.
  void expect_one_warning(const ProgramAnswer& answer, const std::vector<std::string>& words,
                          const std::string& model = "tri.obj") const {
    EXPECT_EQ(answer.code, 0) << answer.out;
    std::size_t warnings = 0;
    for (std::size_t at = 0; (at = answer.out.find("warning: ", at)) != std::string::npos; ++at) ++warnings;
    EXPECT_EQ(warnings, 1u) << answer.out;
    for (const std::string& word : words) EXPECT_TRUE(contains(answer.out, word)) << answer.out;
    EXPECT_EQ(text_of(place / "a.png"), picture(model));
  }
};

TEST_F(RestrictedSystem, ARefusedFilterIsAWarning) {
  if (!sandbox_lacks().filter.empty()) GTEST_SKIP() << "no seccomp here: " << sandbox_lacks().filter;
  const ProgramAnswer answer = render_refusing({{SYS_seccomp, EPERM}});
  expect_one_warning(answer, {"seccomp: Operation not permitted", "--no-sandbox"});
  EXPECT_EQ(contains(answer.out, "Landlock"), !sandbox_lacks().files.empty());
}

TEST_F(RestrictedSystem, ARefusedConfinementToFilesIsAWarning) {
  if (!sandbox_lacks().filter.empty()) GTEST_SKIP() << "no seccomp here: " << sandbox_lacks().filter;
  expect_one_warning(render_refusing({{SYS_landlock_create_ruleset, ENOSYS}}),
                     {"Landlock: Function not implemented", "--no-sandbox"});
  expect_one_warning(render_refusing({{SYS_landlock_restrict_self, E2BIG}, {SYS_seccomp, EPERM}}),
                     {"seccomp: Operation not permitted", "Landlock: ", "--no-sandbox"});
}

TEST_F(RestrictedSystem, NoSandboxGivesNoWarning) {
  const ProgramAnswer answer = run(arguments("tri.obj", "a.png") + " --no-sandbox");
  EXPECT_EQ(answer.code, 0);
  EXPECT_FALSE(contains(answer.out, "warning")) << answer.out;
}

TEST_F(RestrictedSystem, ImagesAreWrittenWhereLinksAreForbidden) {
  for (const char* before : {"", "an earlier image"}) {
    if (*before != 0) write("a.png", before);
    const ProgramAnswer answer = render_refusing({{SYS_linkat, EPERM}});
    EXPECT_EQ(answer.code, 0) << answer.out;
    EXPECT_EQ(text_of(place / "a.png"), picture("tri.obj"));
  }
  for (const auto& entry : std::filesystem::directory_iterator(place))
    EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
}

TEST_F(RestrictedSystem, FewDescriptorsAreAWarning) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer looks at memory through pipes";
#endif
  const ProgramAnswer answer =
      run(arguments("plain.obj", "a.png"), "sh -c 'exec 3>&- 4>&-; ulimit -n 5; exec \"$@\"' sh");
  expect_one_warning(answer, {"Too many open files", "--no-sandbox"}, "plain.obj");
}

TEST_F(RestrictedSystem, FilesBesideTheModelAreReadWithoutProc) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer needs /proc";
#endif
  const std::string command = "unshare -m sh -c 'umount -l /proc && exec \"$@\"' sh";
  if (std::system((command + " true 2>/dev/null").c_str()) != 0) GTEST_SKIP() << "/proc cannot be unmounted here";
  for (const std::string model : {"tri.obj", "tri.gltf"}) {
    const ProgramAnswer answer = run(arguments(model, "a.png"), command);
    EXPECT_EQ(answer.code, 0) << answer.out;
    EXPECT_FALSE(contains(answer.out, "warning")) << answer.out;
    EXPECT_EQ(text_of(place / "a.png"), picture(model)) << model;
  }
  // A link that leads out of the folder is refused here too.
  write("outside.bin", text_of(place / "tri.bin"));
  std::filesystem::create_directory(place / "inside");
  std::filesystem::rename(place / "tri.gltf", place / "inside/tri.gltf");
  std::filesystem::create_symlink(place / "outside.bin", place / "inside/tri.bin");
  EXPECT_EQ(run(arguments("inside/tri.gltf", "b.png"), command).code, 3);
}

TEST_F(RestrictedSystem, LimitsOfTheSessionAreNamed) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer needs more address space";
#endif
  const ProgramAnswer answer =
      run("teapot --size 8000x8000 --progress none -o a.png", "sh -c 'ulimit -v 300000; exec \"$@\"' sh");
  EXPECT_NE(answer.code, 0);
  EXPECT_TRUE(contains(answer.out, "(ulimit -v)")) << answer.out;
  EXPECT_FALSE(contains(answer.out, "--max-memory")) << answer.out;
}

TEST_F(RestrictedSystem, MessagesNameTheFileAndTheLimit) {
  write("sky.hdr", "");
  ASSERT_EQ(::truncate((place / "sky.hdr").c_str(), 100 << 20), 0);
  const ProgramAnswer environment = run("teapot --hdri-file sky.hdr --max-memory 60M --progress none -o a.png");
  EXPECT_EQ(environment.code, 3);
  EXPECT_TRUE(contains(environment.out, "error: sky.hdr: cannot be read: larger than the limit of 60 MB"))
      << environment.out;
  const ProgramAnswer little = run("teapot --max-memory 1 --size 800x600 --progress none -o a.png");
  EXPECT_TRUE(contains(little.out, "--max-memory allows 1 byte") ||
              contains(little.out, "more memory than the limit of 1 byte (--max-memory)"))
      << little.out;
  write("tri.mtl", "newmtl red\nKd 1 0 0\nmap_Kd big.pfm\n");
  write("tri.obj", "mtllib tri.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
  write("big.pfm", "Pf\n2 1\n-1\n12345678");
  const ProgramAnswer strict = run(arguments("tri.obj", "a.png") + " --strict --max-pixels 1");
  EXPECT_EQ(strict.code, 3);
  EXPECT_TRUE(contains(strict.out, "error: tri.obj: texture big.pfm")) << strict.out;
}

TEST_F(RestrictedSystem, NamesOutOfFilesArePrintedWithoutControlCharacters) {
  const std::string name = R"(\u001b]0;title\u0007\u001b[31m\nline\u009b1m\u007f)";
  write("names.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
    "nodes":[{"mesh":0,"name":")" +
                          name + R"("},{"camera":0,"name":")" + name + R"("}],
    "cameras":[{"name":")" +
                          name + R"(","type":"perspective","perspective":{"yfov":1,"znear":0.1}}],
    "materials":[{"name":")" +
                          name + R"("}],
    "meshes":[{"name":")" +
                          name + R"(","primitives":[{"material":0,"attributes":{"POSITION":0}}]}],
    "animations":[{"name":")" +
                          name + R"(","channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],
      "samplers":[{"input":1,"output":2}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
      {"bufferView":0,"byteOffset":8,"componentType":5126,"count":1,"type":"SCALAR","min":[0],"max":[0]},
      {"bufferView":0,"componentType":5126,"count":1,"type":"VEC3"}],
    "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"tri.bin"}]})");
  for (const char* const command : {"info names.gltf", "info names.gltf --json"}) {
    const ProgramAnswer answer = run(command);
    EXPECT_EQ(answer.code, 0) << answer.out;
    EXPECT_TRUE(contains(answer.out, "title")) << answer.out;
    EXPECT_EQ(printable_lines(answer.out), answer.out) << command;
    EXPECT_EQ(std::count(answer.out.begin(), answer.out.end(), '\n'), contains(command, "json") ? 1 : 12) << answer.out;
  }
}

}  // namespace
}  // namespace zoneplate
