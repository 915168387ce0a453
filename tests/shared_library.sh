#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# The shared library exports what the public headers declare and nothing else: names of namespace zoneplate, none of its
# internal classes, and the functions for C.
#
# Usage: shared_library.sh LIBRARY
set -eu
exported=$(nm --dynamic --defined-only --demangle "$1" | sed 's/^[0-9a-f]* [A-Za-z] //' | LC_ALL=C sort -u)
fail() {
  echo "$1" >&2
  exit 1
}
for name in 'zoneplate::Renderer::render(' 'zoneplate::load_scene(' 'zoneplate::save_image(' 'zoneplate::make_resolver(' \
  'zoneplate::make_cpu_backend(' 'zoneplate::antialias::methods(' 'zoneplate::metrics::metrics(' 'typeinfo for zoneplate::Error' zoneplate_render \
  zoneplate_scene_load; do
  case "$exported" in
  *"$name"*) ;;
  *) fail "$1 does not export $name" ;;
  esac
done
for name in 'zoneplate::rasterize(' 'zoneplate::load_gltf(' 'zoneplate::SurfaceShader' 'zoneplate::GltfModel' draco:: ; do
  case "$exported" in
  *"$name"*) fail "$1 exports $name" ;;
  esac
done
# The only other names are templates of the standard library that are instantiated for public types.
others=$(printf '%s\n' "$exported" | grep -v -E '(zoneplate|std)::|^zoneplate_[a-z0-9_]+$' || true)
[ -z "$others" ] || fail "$1 exports other names: $others"
