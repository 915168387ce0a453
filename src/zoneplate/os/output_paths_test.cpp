// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/output_paths.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "zoneplate/base/error.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

class OutputPaths : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "zoneplate_paths_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    place = name;
  }
  void TearDown() override { fs::remove_all(place); }
  void put(const std::string& name, const std::string& text) const { std::ofstream(place / name) << text; }
  std::string at(const std::string& name) const { return (place / name).string(); }

  // All files and folders below the place, including hidden ones; the value of a file is its text.
  std::map<std::string, std::string> all() const {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(place)) {
      std::string& text = out[fs::relative(entry.path(), place).string()];
      if (!entry.is_regular_file()) continue;
      const FileBytes file(entry.path().string());
      text.assign(file.bytes().begin(), file.bytes().end());
    }
    return out;
  }
  // The error message of `call` without the place; "" if there is none.
  std::string refusal(const std::function<void()>& call) const {
    try {
      call();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Output) << error.what();
      std::string text = error.what();
      for (std::size_t i; (i = text.find(place.string() + "/")) != std::string::npos;)
        text.erase(i, place.string().size() + 1);
      return text;
    }
    return "";
  }
  fs::path place;
};

const std::vector<OutputFile> two_files = {{"a.txt", bytes_of("one")}, {"deep/b.txt", bytes_of("two")}};
const std::map<std::string, std::string> whole = {
    {"out", ""}, {"out/a.txt", "one"}, {"out/deep", ""}, {"out/deep/b.txt", "two"}};

TEST_F(OutputPaths, AFolderIsMadeWhole) {
  save_folder(at("out/"), two_files);
  EXPECT_EQ(all(), whole);
}

TEST_F(OutputPaths, NothingThatWasThereIsReplacedOrRemoved) {
  // Names that an earlier version, or another process with this id, may have left behind.
  for (const std::string& name : {std::string(".out.tmp"), ".out." + std::to_string(::getpid()) + ".tmp"}) {
    fs::create_directory(place / name);
    put(name + "/notes.txt", "precious");
  }
  const auto before = all();
  save_folder(at("out"), two_files);
  auto after = before;
  after.insert(whole.begin(), whole.end());
  EXPECT_EQ(all(), after);
  // A second run that started before the folder existed fails, because the first one has created it.
  EXPECT_EQ(refusal([&] {
              save_folder(at("out"), std::vector<OutputFile>{{"c.txt", bytes_of("three")}});
            }),
            "out: is there already; give another folder or remove it");
  EXPECT_EQ(all(), after);
  put("file", "text");
  fs::create_directory(place / "empty");
  for (const char* taken : {"file", "empty"}) {
    EXPECT_EQ(refusal([&] { save_folder(at(taken), two_files); }),
              std::string(taken) + ": is there already; give another folder or remove it");
  }
  after["file"] = "text", after["empty"] = "";
  EXPECT_EQ(all(), after);
}

TEST_F(OutputPaths, AFolderOfEarlierFilesAloneIsReplaced) {
  const std::set<std::string> earlier{"a.txt", "deep", "deep/old.txt", "gone.txt"};
  fs::create_directories(place / "out" / "deep");
  put("out/deep/old.txt", "old");
  put("out/a.txt", "earlier");
  EXPECT_EQ(refusal([&] { check_output_folder(at("out/"), earlier); }), "");
  save_folder(at("out/"), two_files, earlier);
  EXPECT_EQ(all(), whole);
}

TEST_F(OutputPaths, AFolderWithAnythingElseIsNotReplaced) {
  const std::set<std::string> earlier{"a.txt", "deep", "deep/old.txt"};
  const auto expect_refused = [&](const std::string& why) {
    const auto before = all();
    EXPECT_EQ(refusal([&] { check_output_folder(at("out"), earlier); }), "out: " + why);
    EXPECT_EQ(refusal([&] { save_folder(at("out"), two_files, earlier); }), "out: " + why);
    EXPECT_EQ(all(), before);
  };
  const auto other = [](const std::string& name) {
    return "is not replaced, because it has " + name + ", which is not of the earlier output";
  };
  put("out", "text");
  expect_refused("is there already; give another folder or remove it");
  fs::remove(place / "out");
  fs::create_directories(place / "out" / "deep");
  put("out/a.txt", "earlier");
  put("out/thesis.tex", "precious");
  expect_refused(other("thesis.tex"));
  fs::rename(place / "out/thesis.tex", place / "out/deep/notes.txt");
  expect_refused(other("deep/notes.txt"));
  fs::remove(place / "out/deep/notes.txt");
  fs::create_directories(place / "out/mine");
  put("out/mine/x", "precious");
  expect_refused(other("mine"));
  fs::remove_all(place / "out/mine");
  put("precious", "mine");
  fs::create_symlink("../../precious", place / "out/deep/old.txt");  // a name of an earlier file, but a link
  expect_refused(other("deep/old.txt"));
  fs::remove(place / "out/deep/old.txt");
  save_folder(at("out"), two_files, earlier);
  EXPECT_EQ(all().at("precious"), "mine");
}

TEST_F(OutputPaths, NoFileIsWrittenBesideTheFolder) {
  for (const char* name : {"../a", "/a", "a/../b", "a/b/c", "a/", "..", "", "a/.."})
    EXPECT_THROW(save_folder(at("out"), std::vector<OutputFile>{{name, {}}}), Error) << name;
  EXPECT_TRUE(all().empty());
}

TEST_F(OutputPaths, AfterAnErrorNothingStays) {
  const std::vector<OutputFile> files = {{"a.txt", {}}, {"deep/b.txt", {}}, {"deep/" + std::string(300, 'n'), {}}};
  EXPECT_NE(refusal([&] { save_folder(at("out"), files); }).find("File name too long"), std::string::npos);
  EXPECT_TRUE(all().empty());
}

TEST_F(OutputPaths, ASignalEndsTheWritingAndNothingStays) {
  sigset_t set, before;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &set, &before);
  ::raise(SIGTERM);  // arrives while save_folder writes the folder
  EXPECT_EQ(refusal([&] { save_folder(at("out"), two_files); }), "out: is not made: a signal ended the run");
  int signal = 0;
  EXPECT_EQ(::sigwait(&set, &signal), 0);
  EXPECT_EQ(signal, SIGTERM);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  EXPECT_TRUE(all().empty());
}

TEST_F(OutputPaths, FoldersAreRefusedBeforeTheWork) {
  const auto folder = [&](const std::string& name) { return refusal([&] { check_output_folder(at(name)); }); };
  put("file", "text");
  fs::create_directory(place / "there");
  fs::create_symlink("nowhere", place / "link");
  EXPECT_EQ(folder("new"), "");
  EXPECT_EQ(folder("new/"), "");
  for (const char* taken : {"file", "there", "there/", "link"}) {
    EXPECT_NE(folder(taken).find(": is there already; give another folder or remove it"), std::string::npos) << taken;
  }
  EXPECT_EQ(folder("none/out"), "none/out: no directory none");
  EXPECT_EQ(folder("file/out"), "file/out: file is not a directory");
  EXPECT_EQ(folder(std::string(256, 'n')), std::string(256, 'n') + ": cannot be made: File name too long");
}

TEST_F(OutputPaths, FilesAreRefusedBeforeTheWork) {
  const auto file = [&](const std::string& name) { return refusal([&] { check_savable(at(name)); }); };
  put("file", "text");
  fs::create_directory(place / "there");
  EXPECT_EQ(file("new.png"), "");
  EXPECT_EQ(file("file"), "");  // an existing file can be replaced
  EXPECT_EQ(file("there"), "there: cannot be written: it is a directory");
  EXPECT_EQ(file("none/new.png"), "none/new.png: cannot be written: no directory none");
  EXPECT_EQ(file("file/new.png"), "file/new.png: cannot be written: Not a directory");
  EXPECT_EQ(file(std::string(256, 'n')), std::string(256, 'n') + ": cannot be written: File name too long");
}

}  // namespace
}  // namespace zoneplate
