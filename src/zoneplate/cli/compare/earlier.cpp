// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/compare/earlier.h"

#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/json/json.h"
#include "zoneplate/os/file.h"
#include "zoneplate/process/packed.h"

namespace zoneplate::cli {
namespace {

constexpr const char* report_name = "compare.json";

/// The names that follow from a report. Reports of every version have these members.
std::set<std::string> names_in(const JsonView& report) {
  if (report.text("format") != "zoneplate-compare") report.fail("is no report of a comparison");
  std::set<std::string> names{"compare.txt", "compare.csv", "compare.md", report_name, "cost.svg"};
  for (std::size_t i = 0; i < report.count("scenes"); ++i) {
    const JsonView scene = report.element("scenes", i, "scene");
    const std::string folder = scene.text("folder");
    names.insert(folder);
    for (const char* file :
         {"/reference.png", "/reference.film.png", "/reference.slice.png", "/crops.png", "/cost.svg"})
      names.insert(folder + file);
    for (std::size_t m = 0; m < scene.count("methods"); ++m) {
      const std::string image = scene.element("methods", m, "method").text("image");
      if (!image.ends_with(".png")) continue;
      const std::string stem = image.substr(0, image.size() - 4);
      for (const char* ending : {".png", ".error.png", ".worst.png", ".film.png", ".slice.png", ".difference.png"})
        names.insert(stem + ending);
    }
  }
  return names;
}

std::set<std::string> read_names(const std::string& path, const LoadLimits& limits) {
  const FileBytes file(path, limits.memory);
  ImportBudget budget(path, limits);
  const JsonValue value = parse_json(file.bytes(), budget);
  return names_in(JsonView(value, path));
}

}  // namespace

std::optional<std::set<std::string>> earlier_files(const std::string& folder, const ReadingLimits& limits) {
  std::error_code ignored;
  if (!std::filesystem::exists(std::filesystem::symlink_status(folder, ignored))) return std::nullopt;
  const std::string report = folder + '/' + report_name;
  try {
    const ConfinedRun run{.name = report, .limits = limits, .readable = {report}, .outputs = {}};
    const std::vector<std::uint8_t> bytes = run_confined(run, [&](Delivery& out) {
      std::set<std::string> names;
      out.read(report, [&] { names = read_names(report, out.limits()); });
      Packer packer;
      packer.value(std::uint64_t{names.size()});
      for (const std::string& name : names) packer.text(name);
      out.set_result(std::move(packer).bytes());
    });
    Unpacker unpacker(bytes);
    std::set<std::string> names;
    for (auto n = unpacker.value<std::uint64_t>(); n > 0; --n) names.insert(unpacker.text());
    return names;
  } catch (const Error& error) {
    throw Error(ErrorKind::Output, folder +
                                       ": is there already, and is not the output of a comparison, so that it is "
                                       "not replaced (" +
                                       error.what() + ")");
  }
}

}  // namespace zoneplate::cli
