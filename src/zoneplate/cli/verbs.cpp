// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/verbs.h"

namespace zoneplate::cli {
namespace {

constexpr Verb verbs[] = {
    {"render", "render a model or a built-in scene to an image (the verb is optional)", run_render},
    {"contact-sheet", "render many models into one image, with their names", run_contact_sheet},
    {"plan", "estimate the time, disk and memory of a batch, and divide it into tasks", run_plan},
    {"verify", "check the files of a batch, and name those that must be made again", run_verify},
    {"list", "list antialiasing methods, built-in scenes and file formats", run_list},
    {"info", "print the contents of a model", run_info},
    {"metrics", "measure the difference between images and a reference", run_metrics},
    {"filter", "antialias and upscale existing images, and frames of any renderer", run_filter},
    {"compare", "compare antialiasing methods on scenes against a reference", run_compare},
    {"dataset", "render sequences with ground truth, to train and measure upscalers", run_dataset},
    {"fidelity", "compare renderings with those of other renderers", run_fidelity},
    {"bench", "measure frame times, stage by stage", run_bench},
    {"demo", "make captioned images that explain aliasing and antialiasing", run_demo},
    {"signal", "analyse and filter images: spectra, convolution, resampling", run_signal, signal_verbs},
    {"texture", "make mip levels and normal maps of images", run_texture, texture_verbs},
    {"sdf", "draw shapes and text from signed distance fields", run_sdf, sdf_verbs},
    {"completions", "print the tab completions of a shell", run_completions},
    {"man", "print the manual page", run_man}};

}  // namespace

std::span<const Verb> all_verbs() { return verbs; }

}  // namespace zoneplate::cli
