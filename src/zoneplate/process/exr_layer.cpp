// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/process/exr_layer.h"

#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/codec/exr/exr_layer.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/os/mapped_file_guard.h"

namespace zoneplate {

ExrArea area_for(const std::string& output, bool keeps_size) {
  return keeps_size && extension_of(output) == ".exr" ? ExrArea::Whole : ExrArea::Display;
}

void tell_layer(const metrics::ImageFile& file, Delivery& out) {
  const std::string& wanted = file.exr.layer;
  if (!is_exr(file.bytes)) {
    if (wanted.empty()) return;
    throw Error(ErrorKind::Usage, fmt::format("{}: is no EXR image, whose layers --layer chooses", file.name));
  }
  const std::vector<ExrPart> parts = read_exr_parts(file.bytes);
  if (parts.empty()) return;  // the decoder says so
  const ExrLayer layer = choose_exr_layer(parts, wanted, file.name);
  if (!wanted.empty() || layer.is_main()) return;
  out.warn(fmt::format("{}: reads layer {}; --layer chooses one of {}", file.name, printable(layer.name),
                       listed_exr_layers(exr_layers(parts))));
}

std::vector<std::string> save_light(const std::string& path, const LinearImage& image,
                                    const metrics::ImageFile& original, const ExrStorage& storage, Delivery& out) {
  if (extension_of(path) == ".pfm") {
    out.save(path, encode_image(path, image));
    return {};
  }
  if (!is_exr(original.bytes)) {
    std::vector<ExrChannel> channels = rgba_channels(image);
    for (ExrChannel& channel : channels) channel.type = ExrType::Float;
    out.save(path, encode_exr(image.width(), image.height(), std::move(channels)));
    return {};
  }
  const MappedFileWatch watch;
  ExrReplacement file = replace_exr_layer(original.bytes, original.name, original.exr, image, storage);
  watch.check(original.name);
  out.save(path, file.bytes);
  return std::move(file.left_out);
}

void warn_of_left_out(const std::string& path, const std::string& original, const std::vector<std::string>& left_out,
                      Delivery& out) {
  if (left_out.empty()) return;
  constexpr std::size_t most = 20;
  std::string names;
  for (std::size_t i = 0; i < std::min(most, left_out.size()); ++i)
    names += (i == 0 ? "" : ", ") + printable(left_out[i]);
  if (left_out.size() > most) names += fmt::format(" and {} more", left_out.size() - most);
  out.warn(fmt::format("{}: lacks what {} has beside the layer: {}", path, original, names));
}

}  // namespace zoneplate
