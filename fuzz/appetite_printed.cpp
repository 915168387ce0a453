// SPDX-License-Identifier: Apache-2.0
// 3MF and AMF.
#include <fmt/format.h>

#include "appetite.h"
#include "zoneplate/formats/3mf/maker_for_test.h"

namespace zoneplate::appetite {
namespace {

using namespace maker_3mf;

const std::string triangle = R"(<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>)"
                             R"(<vertex x="0" y="1" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/>)"
                             R"(</triangles></mesh>)";

std::string components(int id, int count) {
  return "<components>" + repeated(fmt::format(R"(<component objectid="{}"/>)", id), static_cast<std::size_t>(count)) +
         "</components>";
}

/// Each object has the one before it `count` times.
Bytes nested(const std::string& mesh, int levels, int count, const std::string& type = "model") {
  std::string objects = fmt::format(R"(<object id="1" type="{}">{}</object>)", type, mesh);
  for (int i = 2; i <= levels; ++i) objects += object(i, components(i - 1, count));
  return package(model(objects, item(levels)));
}

/// `count` texts of the numbers from 0 on.
template <class Make>
std::string numbered(int count, const Make& make) {
  std::string text;
  for (int i = 0; i < count; ++i) text += make(i);
  return text;
}

void add_3mf(Collection& out) {
  const auto add = [&](const char* name, const Bytes& bytes) { out.add("3mf", name, bytes, within_limits); };
  add("3mf-components.3mf", nested(triangle, 9, 10));
  add("3mf-components-4.3mf", nested(triangle, 5, 10));
  add("3mf-nothing.3mf", nested("<mesh><vertices/></mesh>", 60, 10));
  add("3mf-other.3mf", nested(triangle, 60, 10, "other"));
  add("3mf-deep.3mf", nested(triangle, 100000, 1));
  add("3mf-items.3mf", package(model(object(1, triangle), repeated(item(1), 1000000))));
  add("3mf-ring.3mf", package(model(object(1, components(2, 1000)) + object(2, components(1, 1000)), item(1))));
  add("3mf-objects.3mf", package(model(numbered(100000, [](int i) { return object(i, triangle); }),
                                       numbered(100000, [](int i) { return item(i); }))));
  add("3mf-paths.3mf",
      package(model("", numbered(300000, [](int i) { return item(1, fmt::format(R"(p:path="/{}.model")", i)); }))));
}

void add_bombs(Collection& out) {
  const std::string much(std::size_t{256} << 20, ' ');
  const auto add = [&](const char* name, const Bytes& bytes) { out.add("3mf-bomb", name, bytes, refused); };
  add("3mf-spaces.3mf", package(model(object(1, triangle) + much, item(1))));
  add("3mf-relationships.3mf", zip_of({{"_rels/.rels", "<Relationships>" + much + "</Relationships>", true}}));
  add("3mf-attribute.3mf", package(model(object(1, triangle, "name=\"" + much + "\""), item(1))));
  const std::string groups = R"(<m:texture2d id="4" path="/t.png"/><m:texture2dgroup id="5" texid="4">)"
                             R"(<m:tex2coord u="0" v="0"/></m:texture2dgroup>)";
  out.add("3mf-bomb", "3mf-texture.3mf",
          package(model(groups + object(1, triangle, R"(pid="5" pindex="0")"), item(1)), {{"t.png", much, true}}),
          within_limits);
  add("3mf-tags.3mf", package(repeated("<aaaaaaaaaaaaaaaa>", 3000000)));
  add("3mf-names.3mf",
      package("<model>" + numbered(1500000, [](int i) { return fmt::format("<n{} a{}='1'/>", i, i); })));
  add("3mf-spaces-in-spaces.3mf", package(repeated("<a:b xmlns:c='d'>", 1000000)));
  add("3mf-entities.3mf",
      package("<!DOCTYPE a [<!ENTITY b 'bbbbbbbbbb'>" +
              numbered(20, [](int i) { return fmt::format("<!ENTITY c{} '&c{};&c{};&c{};'>", i + 1, i, i, i); }) +
              "]><model>&c20;</model>"));
}

void add_properties(Collection& out) {
  const auto add = [&](const char* name, const std::string& resources, const std::string& mesh = triangle) {
    out.add("3mf-properties", name, package(model(resources + object(1, mesh, R"(pid="2" pindex="0")"), item(1))),
            within_limits);
  };
  const std::string base = R"(<basematerials id="2"><base name="a" displaycolor="#112233"/></basematerials>)";
  add("3mf-composites.3mf", base + R"(<m:compositematerials id="3" matid="2" matindices=")" + repeated("0 ", 1000000) +
                                "\">" + repeated(R"(<m:composite values=""/>)", 100000) + "</m:compositematerials>");
  add("3mf-layers.3mf", base + R"(<m:multiproperties id="3" pids=")" + repeated("2 ", 1000000) + "\">" +
                            repeated(R"(<m:multi pindices=""/>)", 1000000) + "</m:multiproperties>");
  std::string mesh = triangle;
  mesh.insert(mesh.find("</triangles>"), numbered(200000, [](int i) {
                return fmt::format(R"(<triangle v1="0" v2="1" v3="2" pid="2" p1="{}"/>)", i);
              }));
  add("3mf-materials.3mf",
      R"(<basematerials id="2">)" + repeated(R"(<base name="a" displaycolor="#112233"/>)", 200000) + "</basematerials>",
      mesh);
  mesh = triangle;
  mesh.insert(mesh.find("</triangles>"), numbered(300000, [](int i) {
                return fmt::format(R"(<triangle v1="0" v2="1" v3="2" pid="2" p1="{}"/>)", i);
              }));
  add("3mf-colors.3mf",
      R"(<m:colorgroup id="2">)" + repeated(R"(<m:color color="#112233"/>)", 300000) + "</m:colorgroup>", mesh);
  mesh = triangle;
  mesh.insert(mesh.find("</triangles>"), repeated(R"(<triangle v1="0" v2="9" v3="2" p1="7"/>)", 1000000));
  add("3mf-flaws.3mf", base, mesh);
}

void add_archives(Collection& out) {
  std::vector<ZipMember> members(65535);
  for (std::size_t i = 0; i < members.size(); ++i) members[i].name = std::to_string(i);
  out.add("3mf-archive", "3mf-parts.3mf", zip_of(members), refused);
  Bytes claims = plain();
  for (std::size_t i = claims.size() - 14; i < claims.size() - 10; ++i) claims[i] = 0xff;
  out.add("3mf-archive", "3mf-claims.3mf", claims, within_limits);
}

void add_amf(Collection& out) {
  const auto add = [&](const char* name, const std::string& content) {
    out.add("amf", name, "<?xml version=\"1.0\"?><amf>" + content + "</amf>", within_limits);
  };
  add("amf-objects.amf", repeated("<object id=\"1\"><mesh><vertices/></mesh></object>", 60000));
  add("amf-colors.amf", "<object id=\"1\">" + repeated("<color><r>1</r></color>", 1000000) + "</object>");
  add("amf-text.amf",
      "<object id=\"1\"><metadata type=\"name\">" + std::string(50 << 20, 'x') + "</metadata></object>");
  std::string levels =
      "<object id=\"0\"><mesh><vertices>" +
      repeated("<vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex>", 3) +
      "</vertices><volume><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh></object>";
  for (int i = 1; i < 10; ++i)
    levels += fmt::format("<constellation id=\"{}\">{}</constellation>", i,
                          repeated(fmt::format("<instance objectid=\"{}\"/>", i - 1), 10));
  add("amf-constellations.amf", levels);
}

}  // namespace

void add_printed(Collection& out) {
  add_3mf(out);
  add_bombs(out);
  add_properties(out);
  add_archives(out);
  add_amf(out);
}

}  // namespace zoneplate::appetite
