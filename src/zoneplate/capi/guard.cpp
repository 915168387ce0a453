// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/capi/guard.h"

#include <cstdio>

#include "zoneplate/version.h"

namespace zoneplate::capi {
namespace {

thread_local char error_text[1024] = "";  // an array: storing the text of a failed allocation must not allocate

}  // namespace

zoneplate_status fail(zoneplate_status status, const char* text) noexcept {
  std::snprintf(error_text, sizeof error_text, "%s", text);
  return status;
}

}  // namespace zoneplate::capi

const char* zoneplate_error_text(void) { return zoneplate::capi::error_text; }
uint32_t zoneplate_abi_version(void) { return ZONEPLATE_ABI_VERSION; }
const char* zoneplate_version(void) { return zoneplate::version; }
