// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/library.h"

#include <dlfcn.h>

#include "zoneplate/os/limited_child.h"
#include "zoneplate/sonames.h"

namespace zoneplate {
namespace {

struct Package {
  const char *file, *package;
};
/// In the order of Library: the versions whose headers the program was built with (cmake/sonames.cmake), and the
/// packages of Debian 12 that contain them.
constexpr Package packages[] = {{soname_assimp, "libassimp5"},
                                {soname_avif, "libavif15"},
                                {soname_jxl, "libjxl0.7"},
                                {soname_meshoptimizer, "libmeshoptimizer2d"},
                                {soname_openexrcore, "libopenexr-3-1-30"},
                                {soname_tiff, "libtiff6"},
                                {soname_zstd, "libzstd1"},
                                {soname_lcms2, "liblcms2-2"}};

const Package& package_of(Library library) { return packages[static_cast<int>(library)]; }

}  // namespace

bool open_library(Library library) { return ::dlopen(package_of(library).file, RTLD_NOW | RTLD_LOCAL) != nullptr; }

SharedLibrary::SharedLibrary(Library library, const std::string& place) : library_(library), place_(place) {
  const Package& package = package_of(library);
  const std::string message =
      place + ": needs the library " + package.file + " (package " + package.package + "), which is not installed";
  if (::dlopen(package.file, RTLD_NOW | RTLD_LOCAL | RTLD_NOLOAD)) return;
  if (is_limited_child()) throw LibraryNeeded(library, message);
  if (!open_library(library)) throw Error(ErrorKind::Input, message);
}

SharedLibrary::Found SharedLibrary::find(const char* symbol) const {
  const char* const file = package_of(library_).file;
  // The library is open already: RTLD_NOLOAD returns its handle.
  if (void* const address = ::dlsym(::dlopen(file, RTLD_NOW | RTLD_LOCAL | RTLD_NOLOAD), symbol))
    return Found(reinterpret_cast<void (*)()>(address));
  throw Error(ErrorKind::Input, place_ + ": the library " + file + " has no function " + symbol);
}

}  // namespace zoneplate
