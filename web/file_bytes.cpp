// SPDX-License-Identifier: Apache-2.0
// Files of a WebAssembly module: they are read into memory, and written in place.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/os/file.h"

namespace zoneplate {

namespace {

/// The contents of an open file, which is closed.
std::span<const std::uint8_t> contents_of(std::FILE* file, const std::string& path, std::uint64_t limit) {
  if (file == nullptr) throw Error(ErrorKind::Input, path + ": no such file");
  std::fseek(file, 0, SEEK_END);
  const auto size = static_cast<std::size_t>(std::ftell(file));
  std::rewind(file);
  if (size > limit) {
    std::fclose(file);
    throw Error(ErrorKind::Input, fmt::format("{}: {} bytes, at most {} are allowed", path, size, limit));
  }
  auto* const memory = new std::uint8_t[size];
  const std::size_t read = std::fread(memory, 1, size, file);
  std::fclose(file);
  return {memory, read};
}

/// The module opens no name of /proc/self/fd, which is a link there.
std::FILE* open_by_name(const std::string& path) {
  std::error_code failure;
  const std::string linked =
      path.starts_with("/proc/self/fd/") ? std::filesystem::read_symlink(path, failure).string() : path;
  return std::fopen(linked.c_str(), "rb");
}

}  // namespace

FileBytes::FileBytes(const std::string& path, std::uint64_t limit)
    : bytes_(contents_of(open_by_name(path), path, limit)) {}
FileBytes::FileBytes(int descriptor, const std::string& path, std::uint64_t limit)
    : bytes_(contents_of(::fdopen(::dup(descriptor), "rb"), path, limit)) {}
FileBytes FileBytes::reclaimable(int descriptor, const std::string& path) {
  return FileBytes(descriptor, path, ~std::uint64_t{0});
}
FileBytes::~FileBytes() { delete[] bytes_.data(); }
FileBytes::FileBytes(FileBytes&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
FileBytes& FileBytes::operator=(FileBytes&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  return *this;
}
void FileBytes::forget(const void*, std::size_t) const {}

int write_fully(int file, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return 0;
}

void check_savable(const std::string&) {}

void save_bytes(const std::string& path, std::span<const std::uint8_t> bytes) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  const int trouble = file < 0 ? errno : write_fully(file, bytes);
  if (file >= 0) ::close(file);
  if (trouble != 0) throw Error(ErrorKind::Output, fmt::format("{}: {}", path, std::strerror(trouble)));
}

}  // namespace zoneplate
