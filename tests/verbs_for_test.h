// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace zoneplate {

/// A command that opens a file from outside. Its words have IN in place of the file and OUT in place of the output.
struct FileCommand {
  std::string name;
  std::vector<std::string> words;
  bool writes_always = false;  ///< an error message in place of the image, exit code 5

  std::vector<std::string> with(const std::string& in, const std::string& out) const {
    std::vector<std::string> all;
    for (const std::string& word : words) all.push_back(word == "IN" ? in : word == "OUT" ? out : word);
    return all;
  }
};

/// Every verb that reads an image.
inline const std::vector<FileCommand>& image_commands() {
  static const std::vector<FileCommand> all{
      {"metrics", {"metrics", "IN", "IN", "--junit", "OUT"}},
      {"filter", {"filter", "IN", "--aa", "smaa", "-o", "OUT"}},
      {"upscaler", {"filter", "IN", "--upscale", "bilinear:scale=1", "-o", "OUT"}},
      {"spectrum", {"signal", "spectrum", "IN", "-o", "OUT"}},
      {"signal filter", {"signal", "filter", "IN", "--low-pass", "0.1", "-o", "OUT"}},
      {"convolve", {"signal", "convolve", "IN", "-o", "OUT"}},
      {"resample", {"signal", "resample", "IN", "--size", "50%", "-o", "OUT"}},
      {"decimate", {"signal", "decimate", "IN", "-o", "OUT"}},
      {"levels", {"texture", "levels", "IN", "-o", "OUT"}},
      {"normal", {"texture", "normal-from-height", "IN", "-o", "OUT"}},
      {"from-mask", {"sdf", "from-mask", "IN", "-o", "OUT"}},
      {"reference", {"compare", "triangles", "--size", "24x20", "--aa", "none", "--reference", "IN", "-o", "OUT"}},
      {"hdri-file", {"render", "triangles", "--size", "24x20", "--no-cache", "--hdri-file", "IN", "-o", "OUT"}}};
  return all;
}

/// Every verb that reads a model, beside `render`.
inline const std::vector<FileCommand>& model_commands() {
  static const std::vector<FileCommand> all{
      {"info", {"info", "IN"}},
      {"contact-sheet", {"contact-sheet", "IN", "--size", "48x36", "-o", "OUT"}, true},
      {"compare",
       {"compare", "IN", "--aa", "none", "--reference", "ssaa:n=2", "--turns", "1", "--size", "48x36", "-o", "OUT"}},
      {"dataset",
       {"dataset", "IN", "--layout", "nss", "--sequences", "1", "--frames", "2", "--size", "32x18", "--reference",
        "ssaa:n=2", "-o", "OUT"}}};
  return all;
}

/// Every verb that reads a file of text.
inline const std::vector<FileCommand>& text_commands() {
  static const std::vector<FileCommand> all{{"draw", {"sdf", "draw", "IN", "-o", "OUT"}},
                                            {"field", {"sdf", "field", "IN", "-o", "OUT"}},
                                            {"fidelity", {"fidelity", "IN", "-o", "OUT"}}};
  return all;
}

}  // namespace zoneplate
