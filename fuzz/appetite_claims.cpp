// SPDX-License-Identifier: Apache-2.0
// glTF files whose numbers promise much and whose bytes hold little.
#include "appetite_gltf.h"

namespace zoneplate::appetite {
namespace {

using Json = Gltf::Json;

constexpr const char* one_pixel =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNgAAAAAgABSK+kcQAAAABJRU5ErkJggg==";
constexpr std::size_t max_zeros = std::size_t{1} << 22;  ///< elements without bytes that the reader accepts

/// A name is kept once for each instance, node, material or animation that has it, if it is copied.
void add_names(Collection& out) {
  Gltf placed;
  placed.root["meshes"][placed.zero_mesh(3)]["name"] = std::string(4000, 'n');
  placed.place_at_zero(0, 500000);
  out.add("names", "names-instances.gltf", placed.json(), within_limits, {{"size", "32x32"}});

  Gltf nodes;
  nodes.root["meshes"][nodes.zero_mesh(3)]["name"] = std::string(1 << 20, 'm');
  for (int i = 0; i < 600; ++i) nodes.add_root({{"mesh", 0}});
  out.add("names", "names-nodes.gltf", nodes.json(), within_limits, {{"size", "32x32"}});

  Gltf images;
  images.zero_mesh(3), images.add_root({{"mesh", 0}});
  images.append("images", {{"name", std::string(1 << 20, 'i')}, {"uri", one_pixel}});
  for (int i = 0; i < 400; ++i) {
    images.append("textures", {{"source", 0}});
    images.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
  }
  out.add("names", "names-images.gltf", images.json(), within_limits);
}

void add_instances(Collection& out) {
  const auto add = [&](const char* name, std::uint64_t vertices, std::uint64_t places) {
    Gltf file;
    file.place_at_zero(file.zero_mesh(vertices), places);
    out.add("instances", name, file.json(), within_limits, {{"size", "32x32"}});
  };
  add("instances-30k-10k.gltf", 30000, 10000);
  add("instances-300k-100k.gltf", 300000, 100000);
  add("instances-3-4m.gltf", 3, max_zeros);

  Gltf twice;  // all places of one node again for each of many nodes
  const std::size_t mesh = twice.zero_mesh(3), places = twice.zeros(100000, "VEC3");
  for (int i = 0; i < 500; ++i) twice.place(mesh, places);
  out.add("instances", "instances-500-100k.gltf", twice.json(), within_limits, {{"size", "32x32"}});
}

void add_nodes(Collection& out) {
  Gltf shared;
  shared.zero_mesh(9000);
  for (int i = 0; i < 20000; ++i) shared.add_root({{"mesh", 0}});
  out.add("nodes", "nodes-20k-9k.gltf", shared.json(), within_limits, {{"size", "32x32"}});

  Gltf empty;  // nothing but nodes
  for (int i = 0; i < 200000; ++i) empty.add_root(Json::object());
  out.add("nodes", "nodes-wide.gltf", empty.json(), within_limits);

  for (const int depth : {500, 100000}) {
    Gltf chain;
    chain.zero_mesh(3);
    for (int i = 0; i + 1 < depth; ++i) chain.append("nodes", {{"children", {i + 1}}});
    chain.append("nodes", {{"mesh", 0}});
    chain.root["scenes"][0]["nodes"] = {0};
    out.add("nodes", "nodes-chain-" + std::to_string(depth) + ".gltf", chain.json(), within_limits);
  }

  Gltf twice;  // each node names the next one a thousand times
  twice.zero_mesh(3);
  for (int i = 0; i < 9; ++i) twice.append("nodes", {{"children", std::vector<int>(1000, i + 1)}});
  twice.append("nodes", {{"mesh", 0}});
  twice.root["scenes"][0]["nodes"] = {0};
  out.add("nodes", "nodes-named-often.gltf", twice.json(), refused);
}

/// Without `scenes` every node must be looked at to find the roots, and before the list of nodes stand many members.
void add_roots(Collection& out) {
  for (const int count : {10000, 30000}) {
    Gltf file;
    file.root.erase("scene");
    for (int i = 0; i < count; ++i) file.root["a" + std::to_string(i)] = 0;
    file.zero_mesh(3);
    for (int i = 0; i < count; ++i) file.append("nodes", Json::object());
    out.add("roots", "roots-" + std::to_string(count / 1000) + "k.gltf", file.json(), within_limits,
            {{"size", "32x32"}});
  }
  Gltf meshes;
  meshes.root.erase("scene");
  meshes.zero_mesh(3);
  for (int i = 0; i < 150000; ++i) meshes.append("nodes", {{"mesh", 0}});
  out.add("roots", "roots-meshes.gltf", meshes.json(), within_limits, {{"size", "32x32"}});
}

void add_accessors(Collection& out) {
  Gltf many;
  Json primitives = Json::array();
  for (int i = 0; i < 1000; ++i) primitives.push_back({{"attributes", {{"POSITION", many.zeros(max_zeros, "VEC3")}}}});
  many.append("meshes", {{"primitives", primitives}});
  many.add_root({{"mesh", 0}});
  out.add("accessors", "accessors-1000.gltf", many.json(), within_limits);

  Gltf indexed;
  const std::size_t order = indexed.zeros(max_zeros, "SCALAR", 5125);
  indexed.mesh({{"POSITION", indexed.zeros(3, "VEC3")}, {"NORMAL", indexed.zeros(3, "VEC3")}}, {{"indices", order}});
  indexed.add_root({{"mesh", 0}});
  out.add("accessors", "accessors-indices.gltf", indexed.json(), within_limits);

  Gltf normals;  // every corner becomes a vertex where normals are missing
  normals.mesh({{"POSITION", normals.zeros(3, "VEC3")}}, {{"indices", normals.zeros(max_zeros, "SCALAR", 5125)}});
  normals.add_root({{"mesh", 0}});
  out.add("accessors", "accessors-flat-normals.gltf", normals.json(), within_limits);

  Gltf claim;
  claim.zero_mesh(std::uint64_t{1} << 52), claim.add_root({{"mesh", 0}});
  out.add("accessors", "accessors-2-52.gltf", claim.json(), refused);

  Gltf sparse;
  const std::size_t view = sparse.view(Bytes(64));
  const auto part = [&](int type) { return Json{{"bufferView", view}, {"componentType", type}}; };
  sparse.append("accessors",
                {{"componentType", 5126},
                 {"count", std::uint64_t{1} << 31},
                 {"type", "VEC3"},
                 {"sparse", {{"count", std::uint64_t{1} << 31}, {"indices", part(5125)}, {"values", part(5126)}}}});
  sparse.mesh({{"POSITION", 0}}), sparse.add_root({{"mesh", 0}});
  out.add("accessors", "accessors-sparse.glb", sparse.glb(), refused);
}

/// Points and lines are drawn as squares and bars: four vertices each.
void add_topologies(Collection& out) {
  for (const int mode : {0, 1, 6}) {
    Gltf file;
    file.mesh({{"POSITION", file.zeros(max_zeros, "VEC3")}}, {{"mode", mode}});
    file.add_root({{"mesh", 0}});
    out.add("topologies",
            std::string("topology-") +
                (mode == 0   ? "points"
                 : mode == 1 ? "lines"
                             : "fan") +
                ".gltf",
            file.json(), within_limits, {{"size", "64x64"}, {"aa", "msaa:n=8"}});
  }
}

void add_morphs(Collection& out) {
  Gltf targets;
  const std::size_t positions = targets.zeros(100000, "VEC3");
  const Json list(5000, Json{{"POSITION", positions}, {"NORMAL", positions}, {"TANGENT", positions}});
  targets.mesh({{"POSITION", positions}, {"NORMAL", positions}}, {{"targets", list}});
  targets.root["meshes"][0]["weights"] = std::vector<int>(5000, 1);
  targets.add_root({{"mesh", 0}});
  out.add("morphs", "morphs-5000-targets.gltf", targets.json(), within_limits);

  Gltf nodes;  // a node with weights of its own has a mesh of its own
  nodes.mesh({{"POSITION", nodes.zeros(100000, "VEC3")}}, {{"targets", {{{"POSITION", nodes.zeros(100000, "VEC3")}}}}});
  for (int i = 0; i < 5000; ++i) nodes.add_root({{"mesh", 0}, {"weights", {0.5}}});
  out.add("morphs", "morphs-5000-nodes.gltf", nodes.json(), within_limits);

  Gltf placed;
  placed.mesh({{"POSITION", placed.zeros(20000, "VEC3")}},
              {{"targets", {{{"POSITION", placed.zeros(20000, "VEC3")}}}}});
  placed.place_at_zero(0, 50000);
  placed.root["nodes"][0]["weights"] = {0.25};
  out.add("morphs", "morphs-placed.gltf", placed.json(), within_limits);
}

void add_skins(Collection& out) {
  const auto skinned = [](Gltf& file, std::uint64_t vertices, int joints) {
    file.mesh({{"POSITION", file.zeros(vertices, "VEC3")},
               {"JOINTS_0", file.zeros(vertices, "VEC4", 5123)},
               {"WEIGHTS_0", file.zeros(vertices, "VEC4")}});
    std::vector<int> numbers;
    for (int i = 0; i < joints; ++i) numbers.push_back(static_cast<int>(file.add_root(Json::object())));
    file.append("skins", {{"joints", numbers}, {"inverseBindMatrices", file.zeros(numbers.size(), "MAT4")}});
  };
  Gltf joints;
  skinned(joints, 3, 100000);
  for (int i = 0; i < 1000; ++i) joints.add_root({{"mesh", 0}, {"skin", 0}});
  out.add("skins", "skins-100k-joints.gltf", joints.json(), within_limits);

  Gltf nodes;  // a node with a skin has a mesh of its own
  skinned(nodes, 100000, 1);
  for (int i = 0; i < 2000; ++i) nodes.add_root({{"mesh", 0}, {"skin", 0}});
  out.add("skins", "skins-2000-nodes.gltf", nodes.json(), within_limits);

  Gltf lost;  // a joint outside the scene gives a warning
  lost.mesh({{"POSITION", lost.zeros(3, "VEC3")},
             {"JOINTS_0", lost.zeros(3, "VEC4", 5123)},
             {"WEIGHTS_0", lost.zeros(3, "VEC4")}});
  for (int i = 0; i < 2000; ++i) lost.add_root({{"mesh", 0}, {"skin", 0}});
  lost.append("nodes", Json::object());
  lost.append("skins", {{"joints", std::vector<int>(2000, 2000)}});
  out.add("skins", "skins-lost-joints.gltf", lost.json(), within_limits);
}

void add_animations(Collection& out) {
  std::vector<float> growing;
  for (int i = 0; i < 200000; ++i) growing.push_back(static_cast<float>(i) / 1024);
  Gltf keys;
  const std::size_t times = keys.floats("SCALAR", 1, growing), moves = keys.zeros(growing.size(), "VEC3");
  keys.zero_mesh(3), keys.add_root({{"mesh", 0}});
  for (int i = 0; i < 1000; ++i)
    keys.append("animations", {{"samplers", {{{"input", times}, {"output", moves}}}},
                               {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
  out.add("animations", "animations-1000.glb", keys.glb(), within_limits, {{"animation-time", "0.5"}});

  Gltf channels;
  channels.zero_mesh(3), channels.add_root({{"mesh", 0}});
  const std::size_t input = channels.floats("SCALAR", 1, growing), output = channels.zeros(growing.size(), "VEC4");
  const Json channel{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}};
  channels.append("animations", {{"name", std::string(1 << 20, 'a')},
                                 {"samplers", {{{"input", input}, {"output", output}}}},
                                 {"channels", Json(20000, channel)}});
  out.add("animations", "animations-20k-channels.glb", channels.glb(), within_limits, {{"animation-time", "1"}});

  Gltf weights;  // of an accessor, each key has one weight for each of many targets
  weights.mesh({{"POSITION", weights.zeros(3, "VEC3")}}, {{"targets", Json(20, Json{{"POSITION", 0}})}});
  weights.add_root({{"mesh", 0}});
  const std::size_t when = weights.floats("SCALAR", 1, growing), how = weights.zeros(4000000, "SCALAR");
  weights.append("animations", {{"samplers", Json(100, Json{{"input", when}, {"output", how}})},
                                {"channels", {{{"sampler", 99}, {"target", {{"node", 0}, {"path", "weights"}}}}}}});
  out.add("animations", "animations-weights.glb", weights.glb(), within_limits, {{"animation-time", "1"}});

  Gltf forever;
  forever.square(), forever.add_root({{"mesh", 0}});
  const std::size_t end = forever.floats("SCALAR", 1, {0, 1e30f}), way = forever.floats("VEC3", 3, {0, 0, 0, 1, 1, 1});
  forever.append("animations", {{"samplers", {{{"input", end}, {"output", way}}}},
                                {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
  out.add("animations", "animations-1e30.glb", forever.glb(), refused,
          {{"frame-start", "0"}, {"output", "animations-1e30.####.png"}, {"size", "32x32"}});
}

void add_variants(Collection& out) {
  Gltf file;
  std::vector<int> numbers;
  for (int i = 0; i < 100000; ++i) numbers.push_back(i);
  Json names = Json::array();
  for (const int i : numbers) names.push_back({{"name", "v" + std::to_string(i)}});
  file.root["extensions"]["KHR_materials_variants"]["variants"] = names;
  file.append("materials", Json::object());
  const Json mapping{{"material", 0}, {"variants", numbers}};
  file.append(
      "meshes",
      {{"primitives", Json(1, Json{{"attributes", {{"POSITION", file.zeros(3, "VEC3")}}},
                                   {"extensions", {{"KHR_materials_variants", {{"mappings", Json(3, mapping)}}}}}})}});
  for (int i = 0; i < 200; ++i) file.add_root({{"mesh", 0}, {"weights", {i}}});  // weights: read anew for each node
  out.add("variants", "variants-100k.gltf", file.json(), within_limits, {{"variant", "v99999"}});

  Gltf long_names;
  long_names.zero_mesh(3), long_names.add_root({{"mesh", 0}});
  long_names.root["extensions"]["KHR_materials_variants"]["variants"] = Json(300000, Json{{"name", "seven letters"}});
  out.add("variants", "variants-unknown.gltf", long_names.json(), not_there, {{"variant", "another"}});
}

void add_scene_lists(Collection& out) {
  Gltf cameras;
  cameras.zero_mesh(3), cameras.add_root({{"mesh", 0}});
  cameras.append(
      "cameras",
      {{"name", std::string(100000, 'c')}, {"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
  for (int i = 0; i < 50000; ++i) cameras.add_root({{"camera", 0}});
  out.add("cameras", "cameras-50k.gltf", cameras.json(), within_limits, {{"size", "32x32"}});

  Gltf materials;
  materials.append("images", {{"uri", one_pixel}});
  materials.append("textures", {{"source", 0}});
  materials.root["materials"] = Json(100000, Json{{"name", "a"}, {"emissiveFactor", {2, 2, 2}}});
  Json primitives = Json::array();
  const std::size_t positions = materials.zeros(3, "VEC3");
  for (int i = 0; i < 100000; ++i) primitives.push_back({{"material", i}, {"attributes", {{"POSITION", positions}}}});
  materials.append("meshes", {{"primitives", primitives}});
  materials.add_root({{"mesh", 0}});
  out.add("materials", "materials-100k.gltf", materials.json(), within_limits, {{"size", "32x32"}});
}

void add_json(Collection& out) {
  std::string keys = R"({"asset":{"version":"2.0"})";
  for (int i = 0; i < 1000000; ++i) keys += ",\"" + std::to_string(i) + "\":" + std::to_string(i % 10);
  out.add("json", "json-million-keys.gltf", keys + "}", within_limits);
  const std::string asset = R"({"asset":{"version":"2.0"},)";
  out.add("json", "json-nested.gltf", asset + "\"a\":" + std::string(1000000, '['), refused);
  out.add("json", "json-nested-objects.gltf", asset + repeated("\"a\":{", 300000) + std::string(300000, '}') + "}",
          refused);
  out.add("json", "json-empty-lists.gltf", asset + "\"extras\":[" + repeated("[]", 1500000, ",") + "]}", within_limits);
  out.add("json", "json-long-number.gltf", asset + "\"extras\":1" + std::string(4000000, '0') + "}", within_limits);
  out.add("json", "json-escapes.gltf", asset + "\"extras\":\"" + repeated("\\u0000", 700000) + "\"}", within_limits);
  out.add("json", "json-extensions.gltf",
          asset + "\"extensionsUsed\":[" + repeated("\"EXT_unknown\"", 200000, ",") + "]}", within_limits);
}

}  // namespace

void add_gltf_claims(Collection& out) {
  add_names(out);
  add_instances(out);
  add_nodes(out);
  add_roots(out);
  add_accessors(out);
  add_topologies(out);
  add_morphs(out);
  add_skins(out);
  add_animations(out);
  add_variants(out);
  add_scene_lists(out);
  add_json(out);
}

}  // namespace zoneplate::appetite
