// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/run_program.h"
#include "zoneplate/report/json_for_test.h"

namespace zoneplate::cli {

using Words = std::vector<std::string>;

/// Fixture that runs subcommands of `signal` in this process, in a temporary folder, and reads their output.
class SignalVerb : public testing::Test {
 protected:
  SignalVerb() : folder_(std::filesystem::temp_directory_path() / ("zoneplate_signal_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~SignalVerb() override { std::filesystem::remove_all(folder_); }

  std::string at(const std::string& name) const { return (folder_ / name).string(); }

  void save(const std::string& name, const std::string& text) const {
    save_bytes(at(name), {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  Rgba8Image picture(const std::string& name) const { return decode_png(FileBytes(at(name)).bytes(), name).pixels; }
  std::string text(const std::string& name) const {
    const FileBytes file(at(name));
    return {file.bytes().begin(), file.bytes().end()};
  }

  /// The output of the subcommand on stdout.
  template <class Run>
  static std::string out(Run run, const Words& words) {
    testing::internal::CaptureStdout();
    try {
      run(std::span<const std::string>(words));
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
    return testing::internal::GetCapturedStdout();
  }
  template <class Run>
  static nlohmann::json json(Run run, Words words) {
    words.emplace_back("--json");
    return parsed_json(out(run, words));
  }
  /// The message of the thrown error, which must be of this kind.
  template <class Run>
  static std::string refusal(Run run, const Words& words, ErrorKind kind = ErrorKind::Usage) {
    try {
      out(run, words);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      return error.what();
    }
    return "no error";
  }
  static bool has_gnuplot() {
    try {
      return run_child("gnuplot", {"--version"}, "").code == 0;
    } catch (const Error&) {
      return false;
    }
  }
  static bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

 private:
  std::filesystem::path folder_;
};

}  // namespace zoneplate::cli
