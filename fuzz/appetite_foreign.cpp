// SPDX-License-Identifier: Apache-2.0
// Files of the formats that the library assimp reads.
#include <fmt/format.h>

#include "appetite.h"

namespace zoneplate::appetite {
namespace {

void append(Bytes& out, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

void append(Bytes& out, std::string_view text) { out.insert(out.end(), text.begin(), text.end()); }

/// Each node has the one before it ten times.
std::string nodes_dae(int levels) {
  std::string nodes = R"(<node id="n0"><instance_geometry url="#g"/></node>)";
  for (int i = 1; i <= levels; ++i)
    nodes += fmt::format(R"(<node id="n{}">{}</node>)", i,
                         repeated(fmt::format(R"(<instance_node url="#n{}"/>)", i - 1), 10));
  return fmt::format(
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_nodes>{}</library_nodes><library_visual_scenes><visual_scene id="s"><node><instance_node url="#n{}"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)",
      nodes, levels);
}

/// Each block has the one before it ten times.
std::string blocks_dxf(int levels) {
  const auto line = [](const char* code, const std::string& value) { return fmt::format("{}\n{}\n", code, value); };
  std::string text = line("0", "SECTION") + line("2", "BLOCKS");
  for (int i = 0; i < levels; ++i) {
    text += line("0", "BLOCK") + line("2", "b" + std::to_string(i));
    text += i == 0 ? line("0", "3DFACE") + line("10", "0") + line("20", "0") + line("30", "0") + line("11", "1") +
                         line("21", "0") + line("31", "0") + line("12", "0") + line("22", "1") + line("32", "0") +
                         line("13", "0") + line("23", "1") + line("33", "0")
                   : repeated(line("0", "INSERT") + line("2", "b" + std::to_string(i - 1)), 10);
    text += line("0", "ENDBLK");
  }
  text += line("0", "ENDSEC") + line("0", "SECTION") + line("2", "ENTITIES");
  text += line("0", "INSERT") + line("2", "b" + std::to_string(levels - 1));
  return text + line("0", "ENDSEC") + line("0", "EOF");
}

void add_exponential(Collection& out) {
  out.add("dae", "foreign-nodes.dae", nodes_dae(9), within_limits);
  out.add("dxf", "foreign-blocks.dxf", blocks_dxf(9), within_limits);
  out.add(
      "nff", "foreign-sphere.nff",
      "v\nfrom 0 0 9\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 9 9\nf 1 1 1 1 0 0 0 0\ntess 14\ns 0 0 0 1\n",
      within_limits);
  out.add("nff", "foreign-cone.nff", "f 1 1 1 1 0 0 0 0\ntess 1000000000\nc 0 0 0 1 0 1 0 1\n", within_limits);
}

void add_unended(Collection& out) {
  const std::string head = "version 1\nnodes\n0 \"root\" -1\nend\n";
  out.add("smd", "foreign-nodes.smd", "version 1\nnodes\n0 \"root\" -1\n", within_limits);
  out.add("smd", "foreign-skeleton.smd", head + "skeleton\ntime 0\n0 0 0 0 0 0 0\n", within_limits);
  out.add("smd", "foreign-triangles.smd",
          head + "skeleton\ntime 0\n0 0 0 0 0 0 0\nend\ntriangles\nmaterial\n0 0 0 0 0 0 1 0 0\n", within_limits);
  out.add("smd", "foreign-bone.smd", head + "skeleton\ntime 0\n4000000000 0 0 0 0 0 0\nend\n", within_limits);
}

void add_foreign_claims(Collection& out) {
  const auto add = [&](const char* kind, const char* name, std::string_view text) {
    out.add(kind, name, text, within_limits);
  };
  add("off", "foreign-claim.off", "OFF\n4000000000 4000000000 0\n0 0 0\n");
  add("off", "foreign-vertices.off", "OFF\n100000000 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  add("off", "foreign-face.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n");
  add("x", "foreign-claim.x", "xof 0303txt 0032\nMesh m {\n 1000000000;\n 0;0;0;,\n}\n");
  add("x", "foreign-frames.x", "xof 0303txt 0032\n" + repeated("Frame f {\n", 200000) + repeated("}\n", 200000));
  const std::string fbx = "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n FBXVersion: 7400\n}\n";
  add("fbx", "foreign-array.fbx",
      fbx +
          "Objects:  {\n Geometry: 1, \"Geometry::\", \"Mesh\" {\n Vertices: *2000000000 {\n a: 0,0,0\n}\n "
          "PolygonVertexIndex: *3 {\n a: 0,1,-3\n}\n}\n}\n");
  add("fbx", "foreign-nested.fbx", fbx + repeated("a: {\n", 300000) + repeated("}\n", 300000));
  const std::string ac = "AC3Db\nMATERIAL \"\" rgb 1 1 1 amb 1 1 1 emis 0 0 0 spec 0 0 0 shi 10 trans 0\n";
  add("ac", "foreign-kids.ac", ac + "OBJECT world\nkids 1000000000\n");
  add("ac", "foreign-nested.ac", ac + repeated("OBJECT group\nkids 1\n", 200000) + "OBJECT poly\nkids 0\n");
  add("ac", "foreign-vertices.ac", ac + "OBJECT poly\nnumvert 1000000000\n0 0 0\nkids 0\n");
  add("ac", "foreign-subdivided.ac",
      ac + "OBJECT poly\nsubdiv 14\nnumvert 3\n0 0 0\n1 0 0\n0 1 0\nnumsurf 1\nSURF 0x30\nmat 0\nrefs 3\n0 0 0\n1 0 "
           "0\n2 0 0\nkids 0\n");
  add("ase", "foreign-claim.ase",
      "*3DSMAX_ASCIIEXPORT 200\n*GEOMOBJECT {\n*MESH {\n*MESH_NUMVERTEX 1000000000\n*MESH_NUMFACES "
      "1000000000\n*MESH_VERTEX_LIST {\n*MESH_VERTEX 999999999 0 0 0\n}\n}\n}\n");
  add("md5", "foreign-claim.md5mesh",
      "MD5Version 10\ncommandline \"\"\nnumJoints 1\nnumMeshes 1\njoints {\n\"a\" -1 ( 0 0 0 ) ( 0 0 0 )\n}\nmesh "
      "{\nshader \"a\"\nnumverts 1000000000\nvert 999999999 ( 0 0 ) 0 1\nnumtris 1000000000\nnumweights "
      "1000000000\n}\n");
  add("x3d", "foreign-nested.x3d",
      "<?xml version=\"1.0\"?><X3D><Scene>" + repeated("<Group>", 200000) + repeated("</Group>", 200000) +
          "</Scene></X3D>");
  add("x3d", "foreign-sphere.x3d",
      "<?xml version=\"1.0\"?><X3D><Scene>" + repeated("<Shape><Sphere radius='1'/></Shape>", 100000) +
          "</Scene></X3D>");
  add("cob", "foreign-claim.cob",
      "Caligari V00.01ALH             \nPolH V0.06 Id 1 Parent 0 Size 00000100\nName a\ncenter 0 0 0\nWorld Vertices "
      "1000000000\n0 0 0\n");
}

/// A header of MD2 or MD3 whose counts are the greatest that are taken for possible.
void add_binary_claims(Collection& out) {
  Bytes md3;
  append(md3, "IDP3"), append(md3, 15, 4), md3.resize(md3.size() + 64);
  for (const std::uint32_t v : {0u, 1u, 0u, 1000000u, 0u, 108u, 108u, 108u, 108u}) append(md3, v, 4);
  md3.resize(md3.size() + 500);
  out.add("md3", "foreign-surfaces.md3", md3, within_limits);
  Bytes tds;  // a chunk in a chunk in a chunk
  constexpr std::uint64_t depth = 100000;
  append(tds, 0x4d4d, 2), append(tds, 6 * depth, 4);
  for (std::uint64_t i = 1; i < depth; ++i) append(tds, i == 1 ? 0x3d3d : 0x4000, 2), append(tds, 6 * (depth - i), 4);
  out.add("3ds", "foreign-chunks.3ds", tds, within_limits);
  Bytes ms3d;
  append(ms3d, "MS3D000000"), append(ms3d, 4, 4), append(ms3d, 65535, 2), ms3d.resize(ms3d.size() + 100);
  out.add("ms3d", "foreign-claim.ms3d", ms3d, within_limits);
  Bytes b3d;  // nodes in nodes
  constexpr std::uint64_t levels = 50000;
  append(b3d, "BB3D"), append(b3d, 4 + levels * 49, 4), append(b3d, 1, 4);
  for (std::uint64_t i = levels; i > 0; --i)
    append(b3d, "NODE"), append(b3d, i * 49 - 8, 4), b3d.resize(b3d.size() + 41);
  out.add("b3d", "foreign-nodes.b3d", b3d, within_limits);
}

}  // namespace

void add_foreign(Collection& out) {
  add_exponential(out);
  add_unended(out);
  add_foreign_claims(out);
  add_binary_claims(out);
}

}  // namespace zoneplate::appetite
