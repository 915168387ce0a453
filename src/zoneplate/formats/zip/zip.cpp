// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/zip/zip.h"

#include <fmt/format.h>
#include <minizip/unzip.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "zoneplate/base/error.h"
#include "zoneplate/base/size_text.h"
#include "zoneplate/base/utf8.h"

namespace zoneplate {
namespace {

/// The archive as a file of minizip.
struct Stream {
  std::span<const std::uint8_t> bytes;
  std::uint64_t at = 0;
  /// Zeros follow the archive: where minizip does not know the packed size, it reads whole buffers.
  bool has_zeros = false;

  static Stream& of(void* data) { return *static_cast<Stream*>(data); }
  static uLong read(void* data, void*, void* out, uLong size) {
    Stream& s = of(data);
    const uLong count = std::min<uLong>(size, s.bytes.size() - s.at);
    std::copy_n(s.bytes.begin() + static_cast<std::ptrdiff_t>(s.at), count, static_cast<std::uint8_t*>(out));
    s.at += count;
    if (!s.has_zeros) return count;
    std::memset(static_cast<std::uint8_t*>(out) + count, 0, size - count);
    return size;
  }
  static ZPOS64_T tell(void* data, void*) { return of(data).at; }
  static long seek(void* data, void*, ZPOS64_T offset, int origin) {
    Stream& s = of(data);
    const std::uint64_t from = origin == ZLIB_FILEFUNC_SEEK_SET   ? 0
                               : origin == ZLIB_FILEFUNC_SEEK_CUR ? s.at
                                                                  : s.bytes.size();
    // A negative offset is a large unsigned number; the sum wraps around to the intended one.
    if (from + offset > s.bytes.size()) return -1;
    s.at = from + offset;
    return 0;
  }
};

/// The size of an unpacked file. That of ZIP64 is in an extra field, where minizip 1.1 does not find it.
std::uint64_t size_of(const unz_file_info64& info, std::span<const std::uint8_t> extra) {
  constexpr std::uint64_t elsewhere = 0xffffffff;
  constexpr std::size_t of_a_header = 4;
  const auto number = [&](std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = size; i-- > 0;) value = value << 8 | extra[at + i];
    return value;
  };
  std::size_t at = 0;
  while (info.uncompressed_size == elsewhere && extra.size() - at >= of_a_header + 8) {
    const std::uint64_t kind = number(at, 2), length = number(at + 2, 2);
    if (kind == 1) return number(at + of_a_header, 8);
    at = std::min<std::size_t>(extra.size(), at + of_a_header + length);
  }
  return info.uncompressed_size;
}

}  // namespace

bool is_zip(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint8_t, 4> front = {'P', 'K', 3, 4};
  return bytes.size() >= front.size() && std::equal(front.begin(), front.end(), bytes.begin());
}

struct ZipArchive::State {
  Stream stream;
  ImportBudget& budget;
  unzFile file = nullptr;
  std::vector<unz64_file_pos> places{};
  std::uint64_t unpacked = 0;

  State(std::span<const std::uint8_t> bytes, ImportBudget& the_budget) : stream{bytes}, budget(the_budget) {
    zlib_filefunc64_def functions{};
    functions.zopen64_file = [](void* data, const void*, int) { return data; };
    functions.zread_file = Stream::read;
    functions.ztell64_file = Stream::tell;
    functions.zseek64_file = Stream::seek;
    functions.zclose_file = [](void*, void*) { return 0; };
    functions.zerror_file = [](void*, void*) { return 0; };
    functions.opaque = &stream;
    file = ::unzOpen2_64("", &functions);
    if (file == nullptr) throw Error(ErrorKind::Input, budget.file() + ": is no ZIP archive, or cut off");
  }
  ~State() { ::unzClose(file); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

ZipArchive::ZipArchive(std::span<const std::uint8_t> bytes, ImportBudget& budget)
    : state_(std::make_unique<State>(bytes, budget)) {
  State& s = *state_;
  constexpr std::size_t files_per_check = 1024;
  std::string name(0x10000, '\0');  // a length has 16 bits
  for (int status = ::unzGoToFirstFile(s.file); status == UNZ_OK; status = ::unzGoToNextFile(s.file)) {
    unz_file_info64 info{};
    unz64_file_pos place{};
    if (::unzGetCurrentFileInfo64(s.file, &info, name.data(), name.size(), nullptr, 0, nullptr, 0) != UNZ_OK) break;
    if (::unzGetFilePos64(s.file, &place) != UNZ_OK) break;
    if (names_.size() % files_per_check == 0) budget.check_time();
    const std::size_t length = std::min<std::size_t>(info.size_filename, name.size());
    budget.take(2 * (sizeof(std::string) + sizeof place) + length);
    names_.emplace_back(name.data(), length);
    s.places.push_back(place);
  }
}

ZipArchive::~ZipArchive() = default;

bool ZipArchive::read(std::size_t file, const std::function<void(std::span<const std::uint8_t>)>& sink) {
  State& s = *state_;
  const auto wrong = [&](std::string_view cause) {
    return Error(ErrorKind::Input, fmt::format("{}: {}: {}", s.budget.file(), printable(names_[file]), cause));
  };
  unz_file_info64 info{};
  s.stream.has_zeros = false;
  std::vector<std::uint8_t> extra(0x10000);  // a length has 16 bits
  if (::unzGoToFilePos64(s.file, &s.places[file]) != UNZ_OK ||
      ::unzGetCurrentFileInfo64(s.file, &info, nullptr, 0, extra.data(), extra.size(), nullptr, 0) != UNZ_OK)
    throw wrong("its entry is damaged");
  if ((info.flag & 1) != 0) throw wrong("is encrypted");
  if (info.compression_method != 0 && info.compression_method != Z_DEFLATED)
    throw wrong(fmt::format("is packed by method {}, expected stored or deflated", info.compression_method));
  if (::unzOpenCurrentFile(s.file) != UNZ_OK) throw wrong("its header is damaged");
  struct Close {
    unzFile file;
    ~Close() { ::unzCloseCurrentFile(file); }
  } const close{s.file};

  extra.resize(std::min<std::size_t>(extra.size(), info.size_file_extra));
  std::uint64_t left = size_of(info, extra);
  s.stream.has_zeros = left != info.uncompressed_size;
  uLong checksum = ::crc32_z(0, nullptr, 0);
  std::vector<std::uint8_t> piece(std::size_t{1} << 16);
  while (left > 0) {
    s.budget.check_time();
    const auto wanted = static_cast<unsigned>(std::min<std::uint64_t>(left, piece.size()));
    const int count = ::unzReadCurrentFile(s.file, piece.data(), wanted);
    if (count < 0) throw wrong("its packed bytes are damaged");
    if (count == 0) throw wrong("is cut off");
    left -= static_cast<std::uint64_t>(count);
    s.unpacked += static_cast<std::uint64_t>(count);
    if (s.unpacked > s.budget.limits().memory)
      throw wrong("the archive unpacks to more than the limit of " + size_text(s.budget.limits().memory) +
                  " (--max-memory)");
    checksum = ::crc32_z(checksum, piece.data(), static_cast<std::size_t>(count));
    sink(std::span(piece).first(static_cast<std::size_t>(count)));
  }
  return checksum == info.crc;
}

}  // namespace zoneplate
