// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/kernel.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/os/file.h"
#include "zoneplate/signal/filter/convolve.h"
#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate {
namespace {

// Kernels are small compared with images; a larger one is most likely an error, and would take hours in space.
constexpr int max_kernel_side = 4097;
constexpr std::uint64_t max_file = 1 << 24;

double parse_fraction(const std::string& text) {
  const std::size_t slash = text.find('/');
  const double above = parse_number(text.substr(0, slash), -1e12, 1e12);
  if (slash == std::string::npos) return above;
  const double below = parse_number(text.substr(slash + 1), -1e12, 1e12);
  if (below == 0) throw Error(ErrorKind::Usage, fmt::format("'{}' divides by zero", text));
  return above / below;
}

std::vector<double> parse_row(const std::string& text) {
  std::vector<double> row;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t start = text.find_first_not_of(" \t\r,", at);
    if (start == std::string::npos) break;
    at = std::min(text.size(), text.find_first_of(" \t\r,", start));
    row.push_back(parse_fraction(text.substr(start, at - start)));
  }
  return row;
}

bool starts_a_number(const std::string& text) {
  return !text.empty() && std::string_view("0123456789+-. \t;").find(text[0]) != std::string_view::npos;
}

std::string without_comments(std::string text) {
  for (std::size_t hash; (hash = text.find('#')) != std::string::npos;)
    text.erase(hash, std::min(text.size(), text.find('\n', hash)) - hash);
  return text;
}

KernelChoice of_numbers(const std::string& name, const std::string& text) {
  const Plane<double> rows = parse_number_rows(text);
  KernelChoice choice{name, {}, Plane<float>(rows.width(), rows.height())};
  std::transform(rows.values().begin(), rows.values().end(), choice.weights.values().begin(),
                 [](double v) { return static_cast<float>(v); });
  return choice;
}

}  // namespace

double KernelChoice::sum() const {
  double sum = 0;
  for (const float w : weights.values()) sum += static_cast<double>(w);
  return sum;
}

Plane<double> parse_number_rows(const std::string& text) {
  std::vector<std::vector<double>> rows;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.size(), text.find_first_of(";\n", at));
    if (auto row = parse_row(text.substr(at, end - at)); !row.empty()) rows.push_back(std::move(row));
    at = end + 1;
  }
  if (rows.empty()) throw Error(ErrorKind::Usage, "there are no numbers");
  const std::size_t width = rows[0].size();
  Plane<double> out(static_cast<int>(width), static_cast<int>(rows.size()));
  for (std::size_t y = 0; y < rows.size(); ++y) {
    if (rows[y].size() != width)
      throw Error(ErrorKind::Usage,
                  fmt::format("row {} has {} numbers, the first has {}", y + 1, rows[y].size(), width));
    std::copy(rows[y].begin(), rows[y].end(), out.row(static_cast<int>(y)).begin());
  }
  return out;
}

bool is_kernel_file(const std::string& text) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(text, ignored);
}

KernelChoice parse_kernel_choice(const std::string& text) {
  KernelChoice choice;
  if (is_kernel_file(text)) {
    const FileBytes file(text, max_file);
    try {
      choice = of_numbers(text, without_comments({file.bytes().begin(), file.bytes().end()}));
    } catch (const Error& error) {
      throw Error(ErrorKind::Input, fmt::format("{}: {}", text, error.what()));
    }
  } else if (starts_a_number(text)) {
    choice = of_numbers(text, text);
  } else {
    const std::vector<double> taps = sampled(make_kernel(text));
    choice = {text, taps, outer_product(taps, taps)};
  }
  if (choice.weights.width() > max_kernel_side || choice.weights.height() > max_kernel_side)
    throw Error(ErrorKind::Usage, fmt::format("{}: a kernel of {} × {} weights is too large, expected {} at most", text,
                                              choice.weights.width(), choice.weights.height(), max_kernel_side));
  return choice;
}

}  // namespace zoneplate
