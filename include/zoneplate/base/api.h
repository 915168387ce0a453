// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks a namespace block whose declarations the shared library exports. The library is compiled with hidden
/// visibility, and every public header opens its namespace with this macro, so that exactly what the public headers
/// declare is exported.
#define ZONEPLATE_API [[gnu::visibility("default")]]

/// @namespace zoneplate
/// The renderer: scenes, cameras, antialiasing methods, frames, images and files.
