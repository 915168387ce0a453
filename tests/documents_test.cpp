// SPDX-License-Identifier: Apache-2.0
// README.md and docs/ agree with the program: images are those of their commands, lists are whole, tables are
// tables, and links lead to files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/report/json_for_test.h"
#include "zoneplate/upscale/upscaler.h"
#include "zoneplate/version.h"

namespace {

namespace fs = std::filesystem;
const fs::path root = zoneplate::source_root;

std::vector<fs::path> documents() {
  std::vector<fs::path> out;
  for (const fs::path& folder : {root, root / "docs"})
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".md") out.push_back(entry.path());
  EXPECT_GT(out.size(), 20u);
  return out;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

/// The lines of a document outside its fenced code, the others empty.
std::vector<std::string> prose_lines(const fs::path& document) {
  std::vector<std::string> lines = lines_of(zoneplate::text_of(document));
  bool is_code = false;
  for (std::string& line : lines) {
    const bool is_fence = line.starts_with("```");
    if (is_code || is_fence) line.clear();
    if (is_fence) is_code = !is_code;
  }
  return lines;
}

/// The cells of a row of a table: a bar after a backslash does not divide.
std::ptrdiff_t cells_of(const std::string& row) {
  std::ptrdiff_t bars = 0;
  for (std::size_t i = 0; i < row.size(); ++i) bars += row[i] == '|' && (i == 0 || row[i - 1] != '\\');
  return bars - 1;
}

TEST(Documents, RowsOfTablesFollowTheirHeads) {
  for (const fs::path& document : documents()) {
    const std::vector<std::string> lines = prose_lines(document);
    std::ptrdiff_t columns = 0;  // of the table that the previous line belongs to
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const bool is_row = lines[i].starts_with('|');
      if (is_row && columns == 0) {
        ASSERT_LT(i + 1, lines.size());
        EXPECT_TRUE(std::regex_match(lines[i + 1], std::regex("\\|([ :]*-+[ :]*\\|)+")))
            << document << ':' << i + 1 << ": no table begins with this row: " << lines[i];
      }
      if (is_row && columns != 0) {
        EXPECT_EQ(cells_of(lines[i]), columns) << document << ":" << i + 1;
      }
      columns = is_row ? cells_of(lines[i]) : 0;
    }
  }
}

TEST(Documents, LinksLeadToFiles) {
  const std::regex link("\\]\\(([^)#: ]+)(#[^)]*)?\\)");
  int links = 0;
  for (const fs::path& document : documents())
    for (const std::string& line : prose_lines(document))
      for (std::sregex_iterator at(line.begin(), line.end(), link), end; at != end; ++at, ++links)
        EXPECT_TRUE(fs::exists(document.parent_path() / (*at)[1].str())) << document << ": " << (*at)[1];
  EXPECT_GT(links, 50);
}

TEST(Documents, TheReadmeNamesEveryVerbLessonMethodAndUpscaler) {
  const std::string readme = zoneplate::text_of(root / "README.md");
  const auto expect_named = [&](std::string_view name) {
    EXPECT_NE(readme.find('`' + std::string(name) + '`'), std::string::npos) << name;
  };
  for (const zoneplate::cli::Verb& verb : zoneplate::cli::all_verbs())
    EXPECT_NE(readme.find("zoneplate " + std::string(verb.name)), std::string::npos) << verb.name;
  for (const zoneplate::lessons::Demo& lesson : zoneplate::lessons::demos()) expect_named(lesson.name);
  for (const zoneplate::Method& method : zoneplate::antialias::methods()) expect_named(method.name);
  for (const zoneplate::Upscaler& upscaler : zoneplate::upscale::upscalers()) expect_named(upscaler.name);
  EXPECT_EQ(readme.find("Not supported yet"), std::string::npos);
}

using DocumentImages = zoneplate::ProgramTest;

/// The images that documents display, by their paths from the root.
std::set<fs::path> displayed_images() {
  const std::regex image("!\\[[^\\]]*\\]\\(([^)]*\\.png)\\)");
  std::set<fs::path> images;
  for (const fs::path& document : documents()) {
    const std::string text = zoneplate::text_of(document);
    for (std::sregex_iterator at(text.begin(), text.end(), image), end; at != end; ++at)
      images.insert((document.parent_path() / (*at)[1].str()).lexically_relative(root));
  }
  return images;
}

/// The arguments of the first command of a document that writes an image of this name, here into the current folder.
std::string command_of(const std::string& name) {
  const std::regex command("\\./zoneplate (.* -o )docs/" + name + "( .*)?");
  std::smatch match;
  for (const fs::path& document : documents())
    for (const std::string& line : lines_of(zoneplate::text_of(document)))
      if (std::regex_match(line, match, command)) return match[1].str() + name + match[2].str();
  return {};
}

/// True if a document has a command that photographs a page as this image, which web/test/report.test.mjs repeats.
bool is_photograph(const std::string& name) {
  const std::regex command("node web/test/photograph.mjs .* docs/" + name + " .*");
  for (const fs::path& document : documents())
    for (const std::string& line : lines_of(zoneplate::text_of(document)))
      if (std::regex_match(line, command)) return true;
  return false;
}

TEST_F(DocumentImages, DISABLED_AreThoseOfTheCommandsOfTheDocuments) {
  int images = 0;
  for (const fs::path& image : displayed_images()) {
    const std::string name = image.filename().string();
    if (is_photograph(name)) continue;
    const std::string command = command_of(name);
    ASSERT_FALSE(command.empty()) << "no document has a command that makes " << image;
    const zoneplate::ProgramAnswer answer = run(command);
    ASSERT_EQ(answer.code, 0) << command << '\n' << answer.out;
    EXPECT_TRUE(zoneplate::text_of(place / name) == zoneplate::text_of(root / image))
        << image << " is not what the command makes: " << command;
    ++images;
  }
  EXPECT_GE(images, 15);
}

/// A marked table of a document: an HTML comment above it names the metrics of its figures.
///   <!-- figures psnr -->            a column for each scene of the last `compare` command before it
///   <!-- figures mean psnr flip*1000 -->  a column for each metric: the mean over the scenes
struct FigureTable {
  fs::path document;
  std::size_t line = 0;  ///< of its head
  std::string command;   ///< the arguments of the program
  bool is_mean = false;
  std::vector<std::pair<std::string, double>> metrics;  ///< and their factors
  std::vector<std::vector<std::string>> rows;           ///< the head and the rows, without emphasis
};

std::vector<std::string> trimmed_cells(const std::string& row) {
  std::vector<std::string> cells;
  const std::regex cell("\\|([^|]*)(?=\\|)");
  for (std::sregex_iterator at(row.begin(), row.end(), cell), end; at != end; ++at)
    cells.push_back(std::regex_replace((*at)[1].str(), std::regex("^ +| +$|\\*\\*"), ""));
  return cells;
}

std::vector<FigureTable> figure_tables() {
  std::vector<FigureTable> tables;
  for (const fs::path& document : documents()) {
    const std::vector<std::string> lines = lines_of(zoneplate::text_of(document));
    std::string command;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (lines[i].starts_with("./zoneplate compare ")) {
        command = lines[i].substr(std::string_view("./zoneplate ").size());
        for (; command.ends_with('\\'); ++i) command = command.substr(0, command.size() - 1) + lines[i + 1];
      }
      std::smatch marker;
      if (!std::regex_match(lines[i], marker, std::regex("<!-- figures (mean )?(.*) -->"))) continue;
      FigureTable table{document, i + 1, command, marker[1].matched, {}, {}};
      std::istringstream words(marker[2].str());
      for (std::string word; words >> word;) {
        const std::size_t star = word.find('*');
        table.metrics.emplace_back(word.substr(0, star), star == word.npos ? 1 : std::stod(word.substr(star + 1)));
      }
      for (std::size_t k = i + 1; k < lines.size() && lines[k].starts_with('|'); ++k)
        if (k != i + 2) table.rows.push_back(trimmed_cells(lines[k]));
      tables.push_back(std::move(table));
    }
  }
  return tables;
}

/// The name of a method without the scale of its upscaler, which tables leave out.
std::string without_scale(const std::string& method) {
  return std::regex_replace(std::regex_replace(method, std::regex("scale=2,"), ""), std::regex(":scale=2$"), "");
}

/// What `compare` measured: figures by metric, scene and method.
class Comparison {
 public:
  explicit Comparison(const nlohmann::json& report) : report_(report) {}

  std::vector<double> figures(const std::string& metric, const std::string& method) const {
    std::vector<double> out;
    for (const auto& scene : report_["scenes"])
      for (const auto& row : scene["methods"])
        if (without_scale(row["method"]) == method) out.push_back(row["metrics"][metric]["value"]);
    return out;
  }
  /// The index of a scene whose name is in a head, as "`wires`, dB"; else of the column.
  std::size_t scene_of(const std::string& head, std::size_t column) const {
    for (std::size_t i = 0; i < report_["scenes"].size(); ++i)
      if (head.find('`' + report_["scenes"][i]["scene"].get<std::string>() + '`') != head.npos) return i;
    return column;
  }

 private:
  nlohmann::json report_;
};

/// Compares a printed figure with a value, to the digits that are printed.
void expect_printed(const std::string& text, double value, const std::string& where) {
  ASSERT_TRUE(std::regex_match(text, std::regex("(−)?[0-9]+(\\.[0-9]+)?"))) << where << ": " << text;
  const std::string digits = std::regex_replace(text, std::regex("−"), "-");
  const std::size_t point = digits.find('.');
  const double half_step = 0.5 * std::pow(0.1, point == digits.npos ? 0 : digits.size() - 1 - point);
  EXPECT_NEAR(std::stod(digits), value, half_step * 1.001) << where;
}

using DocumentFigures = zoneplate::ProgramTest;

// A marked figure is what its command gives.
TEST_F(DocumentFigures, DISABLED_AreThoseOfTheCommandsOfTheDocuments) {
  std::map<std::string, Comparison> comparisons;
  std::size_t figures = 0;
  for (const FigureTable& table : figure_tables()) {
    ASSERT_FALSE(table.command.empty()) << table.document << ':' << table.line << ": no command is above the table";
    if (!comparisons.contains(table.command)) {
      const std::string folder = std::to_string(comparisons.size());
      const std::string command = std::regex_replace(table.command, std::regex(" -o [^ ]+"), " -o " + folder);
      const zoneplate::ProgramAnswer answer = run(command);
      ASSERT_EQ(answer.code, 0) << command << '\n' << answer.out;
      comparisons.emplace(table.command,
                          Comparison(zoneplate::parsed_json(zoneplate::text_of(place / folder / "compare.json"))));
    }
    const Comparison& found = comparisons.at(table.command);
    for (std::size_t r = 1; r < table.rows.size(); ++r) {
      const std::vector<std::string>& row = table.rows[r];
      const std::string method = without_scale(std::regex_replace(row[0], std::regex("`"), ""));
      for (std::size_t column = 1; column < row.size(); ++column, ++figures) {
        const auto& [metric, factor] = table.metrics.at(table.is_mean ? column - 1 : 0);
        const std::vector<double> values = found.figures(metric, method);
        const std::string where = table.document.filename().string() + ": " + method + ", " + table.rows[0][column];
        ASSERT_FALSE(values.empty()) << where << ": the command has no such method";
        const double value =
            table.is_mean ? std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size())
                          : values.at(found.scene_of(table.rows[0][column], column - 1));
        expect_printed(row[column], factor * value, where);
      }
    }
  }
  EXPECT_GT(figures, 100u);
}

TEST(Documents, EveryImageIsDisplayed) {
  const std::set<fs::path> images = displayed_images();
  for (const auto& entry : fs::directory_iterator(root / "docs"))
    if (entry.path().extension() == ".png") {
      EXPECT_TRUE(images.contains(fs::path("docs") / entry.path().filename())) << entry.path();
    }
}

TEST(Documents, LinesHaveAtMost120Characters) {
  std::vector<fs::path> files = {root / "README.md", root / "CHANGELOG.md"};
  for (const auto& entry : fs::directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") files.push_back(entry.path());
  for (const fs::path& file : files) {
    const std::vector<std::string> lines = lines_of(zoneplate::text_of(file));
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto characters =
          std::count_if(lines[i].begin(), lines[i].end(), [](char c) { return (c & 0xc0) != 0x80; });
      EXPECT_LE(characters, 120) << file << ':' << i + 1;
    }
  }
}

// CMakeLists.txt states the version of the project; the headers, the command, Python's and Node's packages take it from
// there. Files that no program makes have to be changed with it.
TEST(Documents, StateTheVersionOfTheProject) {
  const std::string version = zoneplate::version, minor = version.substr(0, version.rfind('.'));
  const struct {
    const char *file, *before;
    std::string version;
  } places[] = {{"CMakeLists.txt", "project\\(Zoneplate VERSION ", version},
                {"CITATION.cff", "\nversion: ", version},
                {".pre-commit-hooks.yaml", "rev: v", version},
                {"examples/ci/gitlab.yml", "VERSION: v", version},
                {"docs/ci.md", "zoneplate@v", version},
                {"docs/node.md", "zoneplate-(?=.*\\.tgz)", version},
                {"include/zoneplate/zoneplate.h", "such as \"", version},
                {"examples/CMakeLists.txt", "find_package\\(Zoneplate ", minor}};
  for (const auto& place : places) {
    const std::string text = zoneplate::text_of(root / place.file);
    const std::regex stated(std::string(place.before) + "([0-9]+(?:\\.[0-9]+)+)");
    std::size_t count = 0;
    for (std::sregex_iterator i(text.begin(), text.end(), stated), end; i != end; ++i, ++count)
      EXPECT_EQ((*i)[1], place.version) << place.file;
    EXPECT_GT(count, 0u) << place.file;
  }
}

}  // namespace
