// SPDX-License-Identifier: Apache-2.0
// Writes inputs of a small file and a large appetite into a folder, with a list of them: what a service that draws
// files of strangers must refuse, or draw within its limits.
//
// Every file is made by arithmetic alone, so that it has the same bytes everywhere. tests/appetite_test.cpp runs the
// program on each.
#include "appetite.h"

#include <iostream>

namespace zoneplate::appetite {

Collection::Collection(std::filesystem::path folder, bool has_one_of_each_kind)
    : folder_(std::move(folder)), has_one_of_each_kind_(has_one_of_each_kind) {
  std::filesystem::create_directories(folder_);
  index_.open(folder_ / "index.jsonl");
}

bool Collection::is_needed(std::string_view kind) { return kinds_.emplace(kind).second || !has_one_of_each_kind_; }

void Collection::write(const std::string& name, const Bytes& bytes) const {
  std::ofstream file(folder_ / name, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw std::filesystem::filesystem_error("cannot be written", folder_ / name, std::error_code());
}

void Collection::list(std::string_view kind, const std::string& name, std::size_t bytes, const char* codes,
                      const Options& options) {
  index_ << R"({"name":")" << name << R"(","kind":")" << kind << R"(","exit":)" << codes << R"(,"bytes":)" << bytes
         << R"(,"options":{)";
  for (const auto& [option, value] : options)
    index_ << (option == options.front().first ? "" : ",") << '"' << option << R"(":")" << value << '"';
  index_ << "}}" << std::endl;
}

void Collection::add(std::string_view kind, const std::string& name, const Bytes& bytes, const char* codes,
                     const Options& options, std::size_t more) {
  if (!is_needed(kind)) return;
  write(name, bytes);
  list(kind, name, bytes.size() + more, codes, options);
}

void Collection::add_builtin(std::string_view kind, const std::string& scene, const char* codes,
                             const Options& options) {
  if (is_needed(kind)) list(kind, scene, 0, codes, options);
}

void Collection::add_picture(std::string_view kind, const std::string& name, const std::string& extension,
                             const Bytes& picture, const char* codes, const Options& options) {
  const std::string material = "newmtl a\nKd 1 1 1\nmap_Kd " + name + extension + "\n";
  const std::string square = "mtllib " + name +
                             ".mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                             "usemtl a\nf 1/1 2/2 3/3 4/4\n";
  if (!is_needed(kind)) return;
  write(name + extension, picture);
  write(name + ".mtl", Bytes(material.begin(), material.end()));
  write(name + ".obj", Bytes(square.begin(), square.end()));
  list(kind, name + ".obj", square.size() + material.size() + picture.size(), codes, options);
}

void Collection::add_environment(std::string_view kind, const std::string& name, const std::string& extension,
                                 const Bytes& picture, const char* codes) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", image = name + ".obj" + extension;
  if (!is_needed(kind)) return;
  write(image, picture);
  write(name + ".obj", Bytes(triangle.begin(), triangle.end()));
  list(kind, name + ".obj", triangle.size() + picture.size(), codes,
       {{"hdri-file", (folder_.filename() / image).string()}});
}

std::string repeated(std::string_view text, std::size_t count, std::string_view between) {
  std::string out;
  out.reserve(count * (text.size() + between.size()));
  for (std::size_t i = 0; i < count; ++i) {
    if (i != 0) out += between;
    out += text;
  }
  return out;
}

}  // namespace zoneplate::appetite

int main(int count, char** arguments) {
  using namespace zoneplate::appetite;
  const bool has_choice = count == 3 && std::string_view(arguments[2]) == "--one-of-each-kind";
  if (count != 2 && !has_choice) {
    std::cerr << "usage: fuzz_appetite FOLDER [--one-of-each-kind]\n";
    return 2;
  }
  try {
    Collection out(arguments[1], has_choice);
    for (const auto add : {add_gltf_claims, add_gltf_packed, add_crowds, add_png, add_pictures, add_exr, add_obj,
                           add_ply_and_stl, add_printed, add_foreign})
      add(out);
  } catch (const std::exception& error) {
    std::cerr << "fuzz_appetite: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
