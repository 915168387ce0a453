// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/job/job.h"

namespace zoneplate {

/// Checks the options of a job for its output, and completes them: the upscaler joins the method, an .exr is
/// transparent, a time without an animation chooses the first one.
///
/// Requires  `output`, whose ending is that of a file that can be written, and `frame_place`.
/// Errors    ErrorKind::Usage naming the options that exclude or require each other.
void check_job(Job& job);

/// Checks the options of the environment, and completes `job.lighting` and `job.options` by them. Part of check_job.
///
/// Errors    ErrorKind::Usage.
void check_environment(Job& job);

/// Refuses options that change nothing for this kind of output.
///
/// Errors    ErrorKind::Usage naming the option.
void check_effects(const Job& job);

/// True for the endings of images that can be written: ".png" and others.
bool is_picture_ending(const std::string& extension);

/// Checks that a file of this name can be written in principle: that it is no folder, that its ending is that of an
/// image or a video, and that the library of its format is there.
///
/// Errors    ErrorKind::Usage, ErrorKind::Output.
void check_output_name(const std::string& output);

/// Errors    ErrorKind::Usage for a name whose ending is not that of an image that can be written.
void check_picture_ending(const std::string& output);

}  // namespace zoneplate
