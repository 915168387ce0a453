// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/gltf/maker_for_test.h"

namespace zoneplate {

/// Loads the scene of a generated file.
inline Scene load(const GltfMaker& m, const LoadLimits& limits = {}) {
  const TestFolder folder;
  return load_gltf(folder.write("f.glb", m.glb()), limits);
}

/// The error message of loading that file strictly, without the file's name; "no error" if there is none.
inline std::string error_of(const GltfMaker& m, LoadLimits limits = {}) {
  limits.is_strict = true;
  try {
    load(m, limits);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::Input);
    const std::string text = e.what();
    return text.substr(text.find("f.glb: ") + 7);
  }
  return "no error";
}

}  // namespace zoneplate
