// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/contact_sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/size_text.h"
#include "zoneplate/batch/items.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/job/environment_file.h"
#include "zoneplate/job/import_time.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/job/resolve.h"
#include "zoneplate/process/item_process.h"
#include "zoneplate/render/metering/metering.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {
namespace {

// The image in place of a model that failed: a frame with its diagonals.
Rgba8Image placeholder(int width, int height) {
  Rgba8Image image(width, height, {250, 250, 250, 255});
  constexpr Rgba8 grey = {190, 190, 190, 255};
  const auto draw_line = [&](int x0, int y0, int x1, int y1) {
    const int steps = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
    for (int i = 0; i <= steps; ++i)
      image(x0 + (x1 - x0) * i / std::max(steps, 1), y0 + (y1 - y0) * i / std::max(steps, 1)) = grey;
  };
  const int right = width - 1, bottom = height - 1;
  draw_line(0, 0, right, 0), draw_line(0, bottom, right, bottom);
  draw_line(0, 0, 0, bottom), draw_line(right, 0, right, bottom);
  draw_line(0, 0, right, bottom), draw_line(0, bottom, right, 0);
  return image;
}

// Runs in the item's process: renders the model's image, as RGBA values.
std::vector<std::uint8_t> cell_codes(BatchItem render, ItemSender& sender) {
  Scene scene;
  Environments environments;
  if (!render.hdri_file.empty())
    complete_environments(
        environments, render, [&](std::uint64_t key, auto bytes) { sender.environment(key, bytes); }, sender);
  within_import_time(render.input, render.load.limits, [&] { scene = load_scene(render.input, render.load); });
  sender.has_read();
  convert_materials(render, scene);
  const LitStill still = light_still(render, PreparedScene(std::move(scene), render.mips), false);
  if (!still.warning.empty()) sender.text(TextKind::Warning, still.warning);
  Renderer renderer(still.scene, upscale::make_method(render.method));
  const Rgba8Image picture = renderer.render_still(still.camera, settings_of(still.job, "")).display;
  const auto* first = reinterpret_cast<const std::uint8_t*>(picture.values().data());
  return {first, first + picture.values().size_bytes()};
}

int columns_for(const ContactSheet& sheet, const BatchItem& cell, std::size_t count) {
  if (sheet.columns > 0) return sheet.columns;
  const double shape = static_cast<double>(cell.options.height + 40) / (cell.options.width + 16);
  int columns = 1;
  while (static_cast<double>(columns) / (static_cast<double>(count) / columns * shape) < 4.0 / 3) ++columns;
  return std::min<int>(columns, static_cast<int>(count));
}

}  // namespace

void use_studio(BatchItem& render) {
  render.lighting.studio = prepared_studio(render.cache);
  if (render.is_in_studio) render.lighting.environment->map = render.lighting.studio();
}

SheetCell render_cell(const BatchItem& render, const std::string& name,
                      const std::function<void(const std::string&)>& warn) {
  const std::string& input = render.input;
  try {
    ItemProcess process({.name = input,
                         .load = render.load.limits,
                         .seconds = render.max_seconds,
                         .is_sandboxed = uses_sandbox(render.is_sandboxed, warn),
                         .readable = item_readable_paths(render)},
                        1, [&](std::size_t, ItemSender& sender) { return cell_codes(render, sender); });
    ItemEvents events;
    events.text = [&](TextKind, const std::string& warning) { warn(warning); };
    events.environment = environment_storer(render);
    const std::vector<std::uint8_t> codes = process.next(events);
    Rgba8Image image(render.options.width, render.options.height);
    if (codes.size() != image.values().size_bytes())
      throw Error(ErrorKind::Failed, input + ": an image of a wrong size");
    std::memcpy(image.values().data(), codes.data(), codes.size());
    return {{std::move(image), name}, {}, {}};
  } catch (const std::exception& error) {
    const bool is_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
    std::string cause = error.what();
    if (cause.starts_with(input + ": ")) cause = cause.substr(input.size() + 2);
    return {{placeholder(render.options.width, render.options.height), name + "\n" + cause},
            cause,
            is_memory ? input + ": out of memory" : error.what()};
  }
}

Figure lay_out(const ContactSheet& sheet, const BatchItem& cell, std::vector<Panel> panels) {
  Figure figure{.title = sheet.title};
  const auto columns = static_cast<std::size_t>(columns_for(sheet, cell, panels.size()));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    if (i % columns == 0) figure.rows.emplace_back();
    figure.rows.back().push_back(std::move(panels[i]));
  }
  return figure;
}

void check_memory(const ContactSheet& sheet, const BatchItem& cell, std::size_t count) {
  const std::uint64_t width = static_cast<std::uint64_t>(cell.options.width),
                      height = static_cast<std::uint64_t>(cell.options.height);
  const std::uint64_t columns = static_cast<std::uint64_t>(columns_for(sheet, cell, count));
  const std::uint64_t places = columns * ((count + columns - 1) / columns);
  constexpr std::uint64_t copies = 3;  // of the sheet: the sheet, its filtered rows, and their compression
  const std::uint64_t need = (count + copies * places) * width * height * sizeof(Rgba8);
  const std::uint64_t limit = cell.load.limits.memory;
  if (need > limit)
    throw Error(ErrorKind::Failed,
                fmt::format("{}: a sheet of {} images of {}x{} needs {} of memory, --max-memory allows {}",
                            sheet.output, count, width, height, size_text(need), size_text(limit)));
}

}  // namespace zoneplate
