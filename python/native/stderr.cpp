// SPDX-License-Identifier: Apache-2.0
// Debian's static libraries can become part of a shared object but for one thing: libpng, libjpeg and libwebp address
// `stderr` as a variable of the program itself. This is that variable, hidden, with the value of the C library's.
#include <dlfcn.h>

struct _IO_FILE;
extern "C" {
[[gnu::visibility("hidden")]] _IO_FILE* stderr = nullptr;
}

namespace {

[[gnu::constructor]] void find_stderr() { stderr = *static_cast<_IO_FILE**>(dlsym(RTLD_DEFAULT, "stderr")); }

}  // namespace
