// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/process/item_error.h"

namespace zoneplate {

std::string_view cause_name(const Error& error) {
  if (const auto* item = dynamic_cast<const ItemError*>(&error); item != nullptr && item->cause() != ItemCause::Other)
    return item->cause() == ItemCause::Memory ? "memory" : item->cause() == ItemCause::Time ? "time" : "killed";
  switch (error.kind()) {
    case ErrorKind::Usage:
      return "usage";
    case ErrorKind::Input:
      return "input";
    case ErrorKind::Output:
      return "output";
    case ErrorKind::Failed:
      break;
  }
  return "failed";
}

}  // namespace zoneplate
