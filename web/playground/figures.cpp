// SPDX-License-Identifier: Apache-2.0
// The lessons of `zoneplate demo`, for the page: their images as the program draws them. The page sets texts and tables
// and draws plots itself, so that what draws these in the program is empty here.
#include "figures.h"

#include <emscripten/emscripten.h>

#include <algorithm>
#include <string>
#include <vector>

#include "answer.h"
#include "zoneplate/base/error.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/report/plot.h"
#include "zoneplate/report/typeface.h"

namespace zoneplate {

Typeface::Typeface(Weight, int px) : px_(px) {}
void Typeface::Close::operator()(FT_LibraryRec_*) const {}
void Typeface::Close::operator()(FT_FaceRec_*) const {}
int Typeface::leading() const { return px_; }
double Typeface::width(std::string_view) const { return 0; }
void Typeface::draw(Rgba8Image&, int, int, std::string_view, Rgba8) const {}

Rgba8Image table_picture(const Table&, const FigureStyle&, int) { return {}; }
Rgba8Image plot_picture(const Plot&, const PlotSize&, int) { return {}; }

Json::Array figure_rows() {
  Json::Array out;
  for (const lessons::Demo& demo : lessons::demos())
    out.push_back(Json::Object{{"name", demo.name}, {"summary", demo.summary}, {"params", params_of(demo.params)}});
  return out;
}

namespace {

/// The images of the figure that was drawn last.
std::vector<Rgba8Image>& drawn() {
  static std::vector<Rgba8Image> images;
  return images;
}

/// The scene of the lesson (lessons/demo.h), and its images as places in the module's memory, four bytes per pixel.
Json::Object draw(const std::string& text, int panel) {
  const std::string name = text.substr(0, text.find(':'));
  const auto demo = std::ranges::find(lessons::demos(), name, &lessons::Demo::name);
  if (demo == lessons::demos().end()) throw Error(ErrorKind::Usage, name + ": no lesson of this name");
  const Settings settings("lesson", demo->params, text);
  drawn().clear();
  Json scene = lessons::page_scene({name, demo->make({panel}, settings)}, [](const Rgba8Image& image) {
    drawn().push_back(image);
    return drawn().size() - 1;
  });
  Json::Array images;
  for (const Rgba8Image& image : drawn())
    images.push_back(Json::Object{{"at", std::uint64_t{reinterpret_cast<std::uintptr_t>(image.values().data())}},
                                  {"width", image.width()},
                                  {"height", image.height()}});
  return {{"scene", std::move(scene)}, {"images", std::move(images)}};
}

}  // namespace
}  // namespace zoneplate

/// The lesson `text`, name:parameter=value,..., with panels of this many pixels; its images are valid until the next.
extern "C" EMSCRIPTEN_KEEPALIVE const char* draw_figure(void*, const char* text, int panel) {
  return zoneplate::answer([&] { return zoneplate::draw(text, panel); });
}
