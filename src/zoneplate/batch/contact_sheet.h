// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "zoneplate/batch/item.h"
#include "zoneplate/report/figure.h"

namespace zoneplate {

/// A sheet of the images of many models.
struct ContactSheet {
  std::string output, title;
  int columns = 0;  ///< 0: the number with which the aspect ratio is closest to 4:3
};

/// Prepares the studio, once for the processes of all models, and caches it.
void use_studio(BatchItem& cell);

/// The image of a model.
struct SheetCell {
  Panel panel;
  std::string failure;  ///< the cause, if the model's image is missing
  std::string error;    ///< the same as a message about the model
};

/// The image of a model with its name, rendered in a process of its own, or the error message in its place.
SheetCell render_cell(const BatchItem& cell, const std::string& name,
                      const std::function<void(const std::string&)>& warn);

/// The sheet of these images, which have the size of `cell`.
Figure lay_out(const ContactSheet& sheet, const BatchItem& cell, std::vector<Panel> panels);

/// Checks the memory of all images, the sheet and its encoding, before anything is rendered.
///
/// Errors    ErrorKind::Failed if that is more than the limit of a cell.
void check_memory(const ContactSheet& sheet, const BatchItem& cell, std::size_t count);

}  // namespace zoneplate
