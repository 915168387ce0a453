// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/file.h"

#include <cstring>
#include <filesystem>
#include <string_view>

#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/import/model_path.h"
#include "zoneplate/formats/meshopt/meshopt.h"

namespace zoneplate {
namespace {

constexpr std::uint32_t glb_magic = 0x46546c67;     // "glTF"
constexpr std::uint32_t json_chunk = 0x4e4f534a;    // "JSON"
constexpr std::uint32_t binary_chunk = 0x004e4942;  // "BIN"

std::uint32_t read_u32(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16 | static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

std::string bytes_text(std::uint64_t n) { return std::to_string(n) + (n == 1 ? " byte" : " bytes"); }

/// Splits a data: URI at its comma.
std::pair<std::string_view, std::string_view> split_data_uri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) return {uri, {}};
  return {uri.substr(0, comma), uri.substr(comma + 1)};
}

/// The maximum number of elements of all accessors without a buffer view together.
constexpr std::uint64_t max_zeros_in_all = std::uint64_t{1} << 23;

}  // namespace

bool is_binary_gltf(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 4 && read_u32(bytes, 0) == glb_magic;
}

GltfFile::GltfFile(const std::string& path, const LoadLimits& limits)
    : path_(path),
      budget_(path, limits),
      finder_(std::filesystem::path(path).parent_path().string(), budget_.limits().allowed_paths),
      file_(std::in_place, path, limits.memory) {
  read(file_->bytes());
}

GltfFile::GltfFile(const std::string& path, const LoadLimits& limits, std::span<const std::uint8_t> bytes)
    : path_(path),
      budget_(path, limits),
      finder_(std::filesystem::path(path).parent_path().string(), budget_.limits().allowed_paths) {
  read(bytes);
}

void GltfFile::read(std::span<const std::uint8_t> bytes) {
  if (is_binary_gltf(bytes))
    read_chunks(bytes);
  else
    json_bytes_ = bytes;
  json_ = parse_json(json_bytes_, budget_);
  root_.emplace(json_, path_ + ":");
  check_asset();
}

void GltfFile::read_chunks(std::span<const std::uint8_t> bytes) {
  const auto fail = [&](const std::string& cause) { throw Error(ErrorKind::Input, path_ + ": " + cause); };
  if (bytes.size() < 20) fail("GLB of " + bytes_text(bytes.size()) + ", expected at least 20");
  const std::uint32_t version = read_u32(bytes, 4);
  if (version == 1) throw Gltf1Error(ErrorKind::Input, path_ + ": GLB version 1, expected 2");
  if (version != 2) fail("GLB version " + std::to_string(version) + ", expected 2");
  const std::uint32_t length = read_u32(bytes, 8);
  if (length > bytes.size())
    fail("GLB header states " + bytes_text(length) + ", the file has " + std::to_string(bytes.size()));
  if (length < bytes.size()) warn(path_ + ": bytes after the end of the GLB are ignored");

  bool has_json = false;
  for (std::size_t at = 12; at + 8 <= length;) {
    const std::uint32_t size = read_u32(bytes, at), kind = read_u32(bytes, at + 4);
    if (size > length - at - 8)
      fail("GLB chunk at byte " + std::to_string(at) + " states " + bytes_text(size) + ", but " +
           std::to_string(length - at - 8) + " are left");
    const auto chunk = bytes.subspan(at + 8, size);
    if (!has_json && kind != json_chunk) fail("the first GLB chunk is not JSON");
    if (!has_json) {
      json_bytes_ = chunk;
    } else if (kind == binary_chunk && !has_binary_) {
      binary_ = chunk;
      has_binary_ = true;
    }
    has_json = true;
    at += 8 + std::size_t{size};
  }
  if (!has_json) fail("GLB without a JSON chunk");
}

void GltfFile::leave_out(const Error& error) {
  if (error.kind() != ErrorKind::Input || budget_.limits().is_strict || zeros_ > max_zeros_in_all) throw error;
  budget_.take(0);  // exceeding the memory budget or the deadline is an error nevertheless
  budget_.check_time();
  if (!first_loss_) first_loss_ = error;
  warn(std::string(error.what()) + "; left out");
}

void GltfFile::check_asset() {
  const auto major = [](const std::string& version) { return version.substr(0, version.find('.')); };
  const JsonView asset = root_->object("asset");
  const bool is_number = asset.is_number("version");
  const std::string version = is_number ? std::to_string(asset.number("version")) : asset.text("version");
  if (major(version) == "1")
    throw Gltf1Error(ErrorKind::Input, asset.place() + ": version is " + quoted(version) + ", expected 2.0");
  if (is_number) budget_.warn_of_flaw(warnings_, asset.place() + ": version is a number, expected a string");
  const std::string least = asset.text("minVersion", "2.0");
  if (version.empty()) asset.fail("version is missing: not a glTF 2 file");
  if (major(version) != "2") asset.fail("version is " + quoted(version) + ", expected 2.0");
  if (least != "2.0") asset.fail("minVersion is " + quoted(least) + ", 2.0 is supported");
}

std::span<const std::uint8_t> GltfFile::buffer(std::size_t i) {
  if (const auto found = buffers_.find(i); found != buffers_.end()) return found->second.bytes;
  budget_.check_time();
  const JsonView json = root_->element("buffers", i, "buffer");
  const std::uint64_t expected = json.whole("byteLength");
  GltfBytes data;
  if (json.has("uri"))
    data = load_uri(json, json.text("uri"));
  else if (i == 0 && has_binary_)
    data.bytes = binary_;
  else
    json.fail("uri is missing" + std::string(i == 0 ? ", and so is the GLB's binary chunk" : ""));
  if (data.bytes.size() < expected)
    json.fail("holds " + bytes_text(data.bytes.size()) + ", expected " + std::to_string(expected));
  data.bytes = data.bytes.first(static_cast<std::size_t>(expected));
  return (buffers_[i] = std::move(data)).bytes;
}

std::span<const std::uint8_t> GltfFile::part_of_buffer(const JsonView& json) {
  const std::span<const std::uint8_t> all = buffer(json.index("buffer", count("buffers")));
  const std::uint64_t offset = json.whole("byteOffset", 0), size = json.whole("byteLength");
  // What needs the bytes that are missing finds out itself.
  if (offset <= all.size() && size > all.size() - offset && !budget_.limits().is_strict) {
    warn(json.place() + ": ends at byte " + std::to_string(offset + size) + " of a buffer of " +
         bytes_text(all.size()) + ", cut there");
    return all.subspan(static_cast<std::size_t>(offset));
  }
  if (offset > all.size() || size > all.size() - offset)
    json.fail("ends at byte " + std::to_string(offset + size) + " of a buffer of " + bytes_text(all.size()));
  return all.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(size));
}

std::span<const std::uint8_t> GltfFile::view(std::size_t i) {
  const JsonView json = root_->element("bufferViews", i, "bufferView");
  auto packed = json.extension("KHR_meshopt_compression");
  if (!packed) packed = json.extension("EXT_meshopt_compression");
  if (!packed) return part_of_buffer(json);
  if (const auto found = unpacked_.find(i); found != unpacked_.end()) return found->second;
  return unpacked_[i] = decode_meshopt(*packed, part_of_buffer(*packed), budget_);
}

std::uint64_t GltfFile::view_stride(std::size_t i) const {
  const JsonView json = root_->element("bufferViews", i, "bufferView");
  const std::uint64_t stride = json.whole("byteStride", 0, 65536);
  if (json.has("byteStride") && (stride < 4 || stride > 252))
    json.fail("byteStride is " + std::to_string(stride) + ", expected 4 to 252");
  return stride;
}

GltfBytes GltfFile::load_uri(const JsonView& owner, const std::string& uri) {
  GltfBytes out;
  if (uri.starts_with("data:")) {
    const auto [head, body] = split_data_uri(uri);
    if (body.data() == nullptr) owner.fail("its data: URI has no comma");
    // Decoding may need a temporary copy in addition to the result.
    budget_.take(2 * body.size());
    if (head.ends_with(";base64")) {
      auto decoded = decode_base64(body.find('%') == std::string_view::npos ? body : decode_percent(body));
      if (!decoded) owner.fail("its data: URI is not base64");
      out.decoded = std::move(*decoded);
    } else {
      const std::string text = decode_percent(body);
      out.decoded.assign(text.begin(), text.end());
    }
    budget_.give_back(body.size());
    out.bytes = out.decoded;
    return out;
  }
  if (has_scheme(uri)) owner.fail("uri is " + quoted(uri) + ", expected a relative path or a data: URI");

  const auto path = finder_.find(uri);
  if (!path) owner.fail("uri " + quoted(uri) + " leads out of the model's folder (--allow-path PATH permits more)");
  if (is_stream(*path)) owner.fail("uri " + quoted(uri) + " is not a regular file");
  try {
    const std::string folder = std::filesystem::path(path_).parent_path().string();
    const auto limit = file_ ? std::optional(budget_.memory_left()) : std::nullopt;
    out.file.emplace(open_found(folder, *path, budget_.limits().allowed_paths, limit));
  } catch (const Error& e) {
    owner.fail(e.what());
  }
  out.bytes = out.file->bytes();
  return out;
}

void GltfFile::forget() const {
  for (const auto& [number, buffer] : buffers_)
    if (buffer.file) buffer.file->forget(buffer.bytes.data(), buffer.bytes.size());
}

void GltfFile::take_zeros(const JsonView& accessor, std::uint64_t count) {
  zeros_ += count;
  if (zeros_ > max_zeros_in_all)
    accessor.fail("has no bufferView, as other accessors of " + std::to_string(zeros_) + " elements in all, at most " +
                  std::to_string(max_zeros_in_all) + " may be zero");
}

void GltfFile::warn(const std::string& text) {
  constexpr std::size_t max_warnings = 1000;
  if (warnings_.size() > max_warnings || !warned_.insert(text).second) return;
  budget_.take(2 * text.size());
  warnings_.push_back(warnings_.size() < max_warnings ? text : path_ + ": more of this kind is not listed");
}

}  // namespace zoneplate
