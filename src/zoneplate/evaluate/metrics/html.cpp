// SPDX-License-Identifier: Apache-2.0
// The report as a page for a browser: a table of all images, and the images of failed pairs or of a sequence.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "zoneplate/evaluate/metrics/judgement_text.h"
#include "zoneplate/report/html_page.h"

namespace zoneplate {
namespace {

/// A text in which the operands and the files in them have no folders of this machine.
std::string without_folders(std::string text, const ComparedPaths& paths) {
  for (const std::string& operand : {paths.reference, paths.test}) {
    const std::filesystem::path whole(operand);
    if (!whole.is_absolute()) continue;
    const std::string folder = (whole.parent_path() / "").string();
    for (std::size_t at = 0; (at = text.find(folder, at)) != std::string::npos;) text.erase(at, folder.size());
  }
  return text;
}

std::string head_of(const metrics::Metric& metric) {
  return metric.unit.empty() ? std::string(metric.name) : fmt::format("{}, {}", metric.name, metric.unit);
}

std::string value_text(const JudgedItem& item, const metrics::Metric* metric) {
  const auto found = std::ranges::find(item.results, metric, &metrics::Result::metric);
  return found == item.results.end() ? "–" : number_text(found->value);
}

/// Why an item failed, and what the metrics do not say of it.
std::string reason_of(const JudgedItem& item) {
  std::string text = item.message;
  for (const std::string& remark : remarks_of(item)) text += (text.empty() ? "" : "; ") + remark;
  return text + (item.evidence.is_left_out ? " (its images are left out: the page has its greatest size)" : "");
}

/// The images of items and their places in the page.
class JudgementPage {
 public:
  JudgementPage(const Judgement& judgement, const ComparedPaths& paths) : judgement_(judgement), paths_(paths) {}

  Json::Object content(const std::string& title) {
    if (judgement_.is_sequence)
      add_sequence();
    else
      for (const JudgedItem& item : judgement_.items) add_pair(item);
    std::string text = fmt::format("Test images: {}. References: {}.", shown(paths_.test), shown(paths_.reference));
    if (!judgement_.ignored.empty()) text += fmt::format(" Ignored: {}.", shown(joined(judgement_.ignored)));
    if (!judgement_.not_compared.empty()) text += fmt::format(" Not compared: {}.", joined(judgement_.not_compared));
    if (!judgement_.pooled_message.empty()) text += fmt::format(" All images: {}.", judgement_.pooled_message);
    Json::Array tables;
    if (judgement_.items.size() > 1) tables.emplace_back(pooled_table());
    tables.emplace_back(items_table());
    return {{"title", title},
            {"text", text},
            {"error_name", error_name()},
            {"tables", std::move(tables)},
            {"scenes", std::move(scenes_)}};
  }

  const std::vector<PagePicture>& pictures() const { return pictures_; }

 private:
  std::string shown(const std::string& text) const { return without_folders(text, paths_); }

  Json add(const PagePicture& picture) {
    if (picture.png.empty()) return -1;
    pictures_.push_back(picture);
    return std::uint64_t{pictures_.size() - 1};
  }

  static Json::Array images_of(Json::Array reference, Json::Array test, Json::Array errors, const std::string& facts) {
    return {
        Json::Object{{"name", "reference"}, {"frames", std::move(reference)}, {"is_reference", true}},
        Json::Object{{"name", "test"}, {"facts", facts}, {"frames", std::move(test)}, {"errors", std::move(errors)}}};
  }

  /// The images of a pair that exist.
  Json::Array images_of(const Evidence& evidence) {
    Json::Array both =
        images_of({add(evidence.reference)}, {add(evidence.test)}, {add(evidence.errors)}, evidence.error_text);
    if (evidence.test.png.empty()) both.pop_back();
    if (evidence.reference.png.empty()) both.erase(both.begin());
    return both;
  }

  void add_pair(const JudgedItem& item) {
    const auto scene = static_cast<std::uint64_t>(scenes_.size());
    targets_.emplace_back(Json());
    const Evidence& evidence = item.evidence;
    if (evidence.test.png.empty() && evidence.reference.png.empty()) return;
    targets_.back() = Json::Object{{"scene", scene}, {"failed", !item.passed()}};
    scenes_.emplace_back(Json::Object{{"name", shown(item.name)},
                                      {"text", shown(reason_of(item))},
                                      {"failed", !item.passed()},
                                      {"images", images_of(evidence)}});
  }

  void add_sequence() {
    Json::Array reference, test, errors;
    for (const JudgedItem& item : judgement_.items) {
      targets_.emplace_back(Json::Object{{"frame", std::uint64_t{test.size()}}, {"failed", !item.passed()}});
      reference.push_back(add(item.evidence.reference));
      test.push_back(add(item.evidence.test));
      errors.push_back(add(item.evidence.errors));
    }
    scenes_.emplace_back(Json::Object{
        {"name", "sequence"}, {"images", images_of(std::move(reference), std::move(test), std::move(errors), "")}});
  }

  Json pooled_table() const {
    Table table{{"metric", "all images", "unit"}, {}};
    for (const PooledResult& pooled : judgement_.pooled)
      table.rows.push_back(
          {std::string(pooled.metric->name), number_text(pooled.value), std::string(pooled.metric->unit)});
    return page_table(table, "All images");
  }

  /// A row for each item, the failed ones first.
  Json items_table() const {
    Table table{{"image", "outcome"}, {}};
    std::vector<const metrics::Metric*> columns;
    for (const PooledResult& pooled : judgement_.pooled)
      if (!pooled.items.empty()) columns.push_back(pooled.metric), table.head.push_back(head_of(*pooled.metric));
    table.head.emplace_back("reason");
    Json::Array targets;
    for (const bool passed : {false, true})
      for (std::size_t i = 0; i < judgement_.items.size(); ++i) {
        const JudgedItem& item = judgement_.items[i];
        if (item.passed() != passed) continue;
        std::vector<std::string> row{shown(item.name), std::string(name_of(item.outcome))};
        for (const metrics::Metric* metric : columns) row.push_back(value_text(item, metric));
        row.push_back(shown(reason_of(item)));
        table.rows.push_back(std::move(row));
        targets.push_back(targets_[i]);
      }
    return page_table(table, "Images", std::move(targets));
  }

  std::string error_name() const {
    for (const JudgedItem& item : judgement_.items)
      if (!item.evidence.error_name.empty()) return item.evidence.error_name;
    return "error map";
  }

  const Judgement& judgement_;
  const ComparedPaths& paths_;
  std::vector<PagePicture> pictures_;
  Json::Array scenes_, targets_;
};

}  // namespace

std::string html_of(const Judgement& judgement, const ComparedPaths& paths) {
  const std::size_t count = judgement.items.size(), failures = judgement.failures();
  const std::string title =
      count == 1 ? fmt::format("{}: {}", without_folders(paths.test, paths), name_of(judgement.items[0].outcome))
                 : fmt::format("{} of {} images failed", failures, count);
  JudgementPage page(judgement, paths);
  const Json::Object content = page.content(title);
  return html_page(title, content, page.pictures());
}

}  // namespace zoneplate
