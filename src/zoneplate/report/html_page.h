// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/report/json.h"
#include "zoneplate/report/table.h"

namespace zoneplate {

/// A picture of a page, and what its values mean.
struct PagePicture {
  enum class Values {
    Codes,   ///< sRGB codes of 8 or 16 bits with straight alpha
    Halves,  ///< the bits of half floats: scene-linear light with premultiplied alpha
    Errors,  ///< errors in [0, 1] as codes of 8 bits, displayed in the colours of an error map
  };
  std::vector<std::uint8_t> png;
  Values values = Values::Codes;
  bool is_rounded = false;  ///< the image has a finer precision than the picture
};

PagePicture page_picture(const Rgba8Image& image);
/// 8 bits a channel if these are exact, otherwise 16.
PagePicture page_picture(const DisplayImage& image);
/// Half floats.
PagePicture page_picture(const LinearImage& image);
PagePicture page_errors(const Plane<float>& errors);

/// A table of the page. `targets` has an entry for each row: the object that the row selects (as in `html_page`), or
/// null.
Json page_table(const Table& table, std::string_view title, Json::Array targets = {});

/// A page of images that works without a network: the viewer of web/report, with its pictures and data inside. The
/// viewer and the data are packed: 18 kB without data, 21 kB with a table, a plot and error maps. Images are displayed
/// side by side, alternately or by a slider, at 1 to 64 times their size, with their differences from a reference,
/// error maps, values of pixels, tables, a plot, and frames.
///
/// `content` is an object. Its members (all but `scenes` may be absent):
///   title, text        the heading, and a paragraph below it
///   scenes             an array of objects:
///     name, title, text  the name in the list of scenes, a heading and a description
///     failed           true marks the name
///     images           an array of { name, text, frames, errors, is_reference }: frames and errors are arrays of
///     indices
///                      into `pictures`, with one entry, or one for each frame of a sequence; -1: no picture
///     chosen           the indices of the images that are displayed first
///     region           { x, y, size, text }, which the viewer can enlarge
///     fps, frame       frames per second; the frame that is displayed first
///     tables, plot     as those of the page
///   tables             page_table()
///   plot               { title, x, y, is_linear, points }: labels of the axes, true for a linear axis of y, and
///                      { name, x, y, is_on_front, target } for each point, y perhaps null
///   error_name         the metric of the error maps
/// A target is { scene, image, frame }: indices, of which any may be absent.
///
/// Exact     the same bytes for equal arguments.
std::string html_page(std::string_view title, const Json& content, std::span<const PagePicture> pictures);

/// Bytes as UTF-8 that an HTML element can contain unchanged, 8/7 as large: a character holds 7 bits. The four that
/// HTML does not keep, NUL, LF, CR and <, are characters of two bytes, which hold the next 7 bits as well.
std::string text_of_bytes(std::span<const std::uint8_t> bytes);

/// The page with the marks {{title}} and {{content}} for what is added, and the viewer that it unpacks; made by CMake
/// from web/report. The modules of tables and plots come before the script, in pages that have them.
extern const std::string_view viewer_page, viewer_style, viewer_table, viewer_plot, viewer_script;

}  // namespace zoneplate
