// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/evaluate/compare/trial.h"
#include "zoneplate/report/html_page.h"

namespace zoneplate {

/// The comparison as a page for a browser (report/html_page.h).
class ComparisonPage {
 public:
  /// Adds a scene; its images are encoded here and may be freed afterwards.
  void add(const SceneTrials& scene);

  /// The page of the scenes that were added.
  std::string text(const std::vector<SceneTrials>& scenes);

 private:
  Json::Array frames_of(const std::vector<Rgba8Image>& film, const Rgba8Image& picture);
  Json image_of(const Trial& trial, const SceneTrials& scene);
  std::size_t add(PagePicture picture);

  Json::Array scenes_;
  std::vector<PagePicture> pictures_;
};

}  // namespace zoneplate
