// SPDX-License-Identifier: Apache-2.0
// What readers and writers need of libraries that the package does not contain, and of programs.
#include <meshoptimizer.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "../../web/no_system.h"
#include "zoneplate/codec/system/in_child.h"
#include "zoneplate/os/library.h"
#include "zoneplate/os/run_program.h"

namespace zoneplate {

const std::string_view this_door = "this package";

namespace {

/// What needs a library, in the order of Library.
constexpr std::string_view contents[] = {"models of this format are read by",    "AVIF images are read by",
                                         "JPEG XL images are read by",           "",
                                         "OpenEXR images are read by",           "TIFF images are read by",
                                         "data packed by Zstandard are read by", "colour profiles are read by"};

}  // namespace

bool open_library(Library library) { return library == Library::Meshoptimizer; }

SharedLibrary::SharedLibrary(Library library, const std::string& place) : library_(library), place_(place) {
  if (library != Library::Meshoptimizer) refuse(place, contents[static_cast<std::size_t>(library)]);
}

SharedLibrary::Found SharedLibrary::find(const char* symbol) const {
  using Decoder = int (*)(void*, std::size_t, std::size_t, const unsigned char*, std::size_t);
  using Filter = void (*)(void*, std::size_t, std::size_t);
  using AnyFunction = void (*)();
  const auto decoder = [](Decoder function) { return reinterpret_cast<AnyFunction>(function); };
  const auto filter = [](Filter function) { return reinterpret_cast<AnyFunction>(function); };
  const std::pair<std::string_view, AnyFunction> functions[] = {
      {"meshopt_decodeVertexBuffer", decoder(meshopt_decodeVertexBuffer)},
      {"meshopt_decodeIndexBuffer", decoder(meshopt_decodeIndexBuffer)},
      {"meshopt_decodeIndexSequence", decoder(meshopt_decodeIndexSequence)},
      {"meshopt_decodeFilterOct", filter(meshopt_decodeFilterOct)},
      {"meshopt_decodeFilterQuat", filter(meshopt_decodeFilterQuat)},
      {"meshopt_decodeFilterExp", filter(meshopt_decodeFilterExp)}};
  const auto* const found = std::ranges::find_if(functions, [&](const auto& f) { return f.first == symbol; });
  return Found(found == std::end(functions) ? nullptr : found->second);
}

StoredImage decode_in_child(const std::string& place, Library library, std::uint64_t, std::uint64_t,
                            const std::function<StoredImage()>& decode) {
  const SharedLibrary open(library, place);
  return decode();
}

class RunningProgram::Process {};
RunningProgram::RunningProgram(const std::string& program, const std::vector<std::string>&, const ProgramLimits&) {
  refuse(program, "films of this format are encoded by");
}
RunningProgram::~RunningProgram() = default;
void RunningProgram::write(std::span<const std::uint8_t>) {}
ProgramResult RunningProgram::finish() { return {}; }

}  // namespace zoneplate
