// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/metrics/judgement_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "zoneplate/base/utf8.h"
#include "zoneplate/report/report_version.h"

namespace zoneplate {
namespace {

/// The size of all images, if it is the same.
std::string common_size(const Judgement& judgement) {
  const JudgedItem* first = nullptr;
  for (const JudgedItem& item : judgement.items) {
    if (item.width == 0) continue;
    if (first == nullptr) first = &item;
    if (item.width != first->width || item.height != first->height) return "different sizes";
  }
  return first ? fmt::format("{} × {}", first->width, first->height) : "no size";
}

std::string name_of_worst(const Judgement& judgement, const PooledResult& pooled) {
  const auto window = static_cast<std::size_t>(pooled.metric->frames);
  if (pooled.items.empty()) return fmt::format("frames from {}", std::max(pooled.worst_image + 1, window) - window + 1);
  return judgement.items[pooled.items[pooled.worst]].name;
}

/// JSON does not support infinities; they become the strings "inf" and "-inf".
Json json_number(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return value;
}

Json::Array json_numbers(const std::vector<double>& values) {
  Json::Array out;
  for (const double value : values) out.push_back(json_number(value));
  return out;
}

void add_figures_and_curves(const metrics::Score& score, Json::Object& row) {
  Json::Object figures, curves;
  for (const metrics::Figure& figure : score.more) figures.emplace_back(figure.name, json_number(figure.value));
  for (const metrics::Curve& curve : score.curves) {
    curves.emplace_back(curve.name, Json::Object{{"x_label", curve.x_label},
                                                 {"y_label", curve.y_label},
                                                 {"x", json_numbers(curve.x)},
                                                 {"y", json_numbers(curve.y)}});
  }
  if (!figures.empty()) row.emplace_back("figures", std::move(figures));
  if (!curves.empty()) row.emplace_back("curves", std::move(curves));
}

Json json_of(const Judgement& judgement, const PooledResult& pooled) {
  Json::Object row{{"value", json_number(pooled.value)},
                   {"unit", pooled.metric->unit},
                   {"better", pooled.metric->better == metrics::Better::Lower ? "lower" : "higher"}};
  if (pooled.values.size() > 1) {
    row.emplace_back("values", json_numbers(pooled.values));
    row.emplace_back("worst", static_cast<std::uint64_t>(pooled.worst));
    row.emplace_back("worst_name", name_of_worst(judgement, pooled));
  }
  add_figures_and_curves(pooled.score, row);
  return row;
}

Json json_texts(const std::vector<std::string>& texts) {
  Json::Array out;
  for (const std::string& text : texts) out.emplace_back(text);
  return out;
}

/// The number of pixels by channel.
Json json_of(const std::vector<metrics::ChannelCount>& counts) {
  Json::Object out;
  for (const metrics::ChannelCount& count : counts)
    out.emplace_back(count.channel, static_cast<std::uint64_t>(count.pixels));
  return out;
}

Json json_of(const JudgedItem& item) {
  Json::Object values;
  for (const metrics::Result& result : item.results)
    values.emplace_back(result.metric->name, json_number(result.value));
  Json::Object row{{"name", item.name}, {"outcome", name_of(item.outcome)}, {"passed", item.passed()}};
  if (!item.message.empty()) row.emplace_back("message", item.message);
  if (item.width > 0) {
    row.emplace_back("width", item.width);
    row.emplace_back("height", item.height);
    row.emplace_back("identical", item.is_identical());
    row.emplace_back("different", json_of(item.stored.differing));
    row.emplace_back("equal_layers", json_texts(item.stored.equal_layers));
    row.emplace_back("not_finite", Json::Object{{"reference", json_of(item.stored.reference.channels)},
                                                {"test", json_of(item.stored.test.channels)}});
    row.emplace_back("notes", json_texts(item.stored.notes));
  }
  if (!values.empty()) row.emplace_back("metrics", std::move(values));
  return row;
}

}  // namespace

std::string_view name_of(PairOutcome outcome) {
  constexpr std::array<std::string_view, 6> names = {"passed", "failed",     "missing",
                                                     "new",    "unreadable", "not rendered"};
  return names[static_cast<std::size_t>(outcome)];
}

std::string joined(const std::vector<std::string>& texts) {
  std::string out;
  for (const std::string& text : texts) out += (out.empty() ? "" : ", ") + text;
  return out;
}

std::vector<std::string> remarks_of(const JudgedItem& item) {
  const metrics::StoredDifference& stored = item.stored;
  std::vector<std::string> out;
  if (!stored.differing.empty()) out.push_back("stored values differ: " + text_of(stored.differing));
  if (!stored.reference.channels.empty())
    out.push_back("not finite in the reference: " + text_of(stored.reference.channels));
  if (!stored.test.channels.empty()) out.push_back("not finite in the test image: " + text_of(stored.test.channels));
  if (!stored.equal_layers.empty())
    out.push_back(fmt::format("compared for equality only, and equal: {}", joined(stored.equal_layers)));
  out.insert(out.end(), stored.notes.begin(), stored.notes.end());
  return out;
}

std::string text_of(const Judgement& judgement) {
  const std::size_t count = judgement.items.size();
  std::string text = fmt::format("{} {}, {}{}\n", count, count == 1 ? "image" : "images", common_size(judgement),
                                 judgement.is_identical() ? ", identical" : "");
  for (const PooledResult& pooled : judgement.pooled) {
    text += fmt::format("  {:<14}{:>12} {:<13}", pooled.metric->name, number_text(pooled.value), pooled.metric->unit);
    std::string more;
    if (pooled.values.size() > 1)
      more = fmt::format("worst {} in {}", number_text(pooled.values[pooled.worst]),
                         printable(name_of_worst(judgement, pooled)));
    for (const metrics::Figure& figure : pooled.score.more)
      more += fmt::format("{}{} {}", more.empty() ? "" : ", ", figure.name, number_text(figure.value));
    text += (more.empty() ? "" : " " + more);
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  if (!judgement.ignored.empty()) text += fmt::format("ignored: {}\n", printable(joined(judgement.ignored)));
  if (!judgement.not_compared.empty())
    text += fmt::format("not compared: {}\n", printable(joined(judgement.not_compared)));
  for (const JudgedItem& item : judgement.items) {
    const std::vector<std::string> remarks = remarks_of(item);
    const bool is_listed = count > 1 && (!item.message.empty() || item.stored.has_news());
    if (is_listed)
      text += fmt::format("{:<13}{}{}{}\n", name_of(item.outcome), printable(item.name),
                          item.message.empty() ? "" : ": ", printable(item.message));
    if (is_listed || count == 1)
      for (const std::string& remark : remarks) text += fmt::format("  {}\n", printable(remark));
  }
  return text;
}

Json json_of(const Judgement& judgement, const ComparedPaths& paths) {
  Json::Object rows;
  for (const PooledResult& pooled : judgement.pooled)
    rows.emplace_back(pooled.metric->name, json_of(judgement, pooled));
  Json::Array items;
  for (const JudgedItem& item : judgement.items) items.push_back(json_of(item));
  Json::Object out{{"format", "zoneplate-metrics"},
                   {"version", report_version},
                   {"reference", paths.reference},
                   {"test", paths.test},
                   {"images", static_cast<std::uint64_t>(judgement.items.size())}};
  for (auto item = judgement.items.rbegin(); item != judgement.items.rend(); ++item)
    if (item->width > 0) {
      out.emplace_back("width", item->width);
      out.emplace_back("height", item->height);
      break;
    }
  out.emplace_back("identical", judgement.is_identical());
  out.emplace_back("passed", judgement.passed());
  out.emplace_back("failed", static_cast<std::uint64_t>(judgement.failures()));
  if (!judgement.ignored.empty()) out.emplace_back("ignored", json_texts(judgement.ignored));
  if (!judgement.not_compared.empty()) out.emplace_back("not_compared", json_texts(judgement.not_compared));
  out.emplace_back("metrics", std::move(rows));
  out.emplace_back("items", std::move(items));
  return out;
}

std::string failure_of(const Judgement& judgement) {
  if (judgement.passed()) return {};
  const std::size_t failures = judgement.failures(), count = judgement.items.size();
  std::string text;
  if (count == 1) {
    text = judgement.items[0].message;
  } else if (failures > 0) {
    text = fmt::format("{} of {} images failed", failures, count);
  }
  if (judgement.pooled_message.empty()) return text;
  return text + (text.empty() ? "" : "; ") + judgement.pooled_message;
}

}  // namespace zoneplate
