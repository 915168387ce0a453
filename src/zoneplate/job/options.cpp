// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/spec.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/job/look/edge_args.h"
#include "zoneplate/job/look/shadow_args.h"
#include "zoneplate/job/look/solid_texture.h"
#include "zoneplate/job/option/lens_args.h"
#include "zoneplate/job/option/section_args.h"
#include "zoneplate/job/option/tone_args.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/job/option/view_args.h"
#include "zoneplate/job/option_values.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {
namespace {

/// The options of a level of --quality: 0 fast, 1 default, 2 best.
void set_quality(Job& a, int level) {
  const Job usual;
  a.method = level == 0 ? "msaa:n=4" : level == 1 ? usual.method : "msaa:n=16,alpha=samples";
  if (level == 1) a.anisotropy.reset();
  if (level != 1) a.anisotropy = level == 0 ? 1 : 16;
  a.options.shadows = level == 2 ? parse_shadows("soft:samples=64,spacing=8") : usual.options.shadows;
  a.options.occlusion = level == 2 ? parse_occlusion("rays:samples=64,spacing=8") : usual.options.occlusion;
  a.options.ground = level == 2 ? GroundKind::Shadow : usual.options.ground;
  a.options.specular_aa = level == 2 ? SpecularAntialiasing::Full : usual.options.specular_aa;
  constexpr float4 paper{0xe8 / 255.0f, 0xe6 / 255.0f, 0xe0 / 255.0f, 1};  // #e8e6e0, on which a shadow shows
  a.quality_background = level == 2 ? std::optional(paper) : std::nullopt;
}

std::vector<Option> input_options(Job& a) {
  const std::string group = "Input";
  return {
      {"--format", "NAME", "Read IN as this format, for example stl or glb; required if IN is -", group, false,
       [&](auto& text) { a.load.format = text; }},
      {"--scene", "N", "Index of the scene of a glTF file, from 0; default: the file's default scene", group, false,
       whole(0, 1 << 20, [&](int n) { a.load.choice.scene = n; })},
      {"--variant", "NAME", "Material variant of a glTF file, by name (KHR_materials_variants)", group, false,
       [&](auto& text) { a.load.choice.variant = text; }},
      {"--animation-index", "N",
       "Animation of a glTF file: its index from 0, its name, or all; default 0 for sequences, none for stills", group,
       false,
       [&](auto& text) {
         const bool is_index = !text.empty() && text.find_first_not_of("+0123456789") == text.npos;
         SceneChoice& choice = a.load.choice;
         choice.animation_name = is_index || text == "all" ? "" : text;
         choice.animation = is_index        ? std::optional(parse_whole(text, 0, 1 << 20))
                            : text == "all" ? std::optional(SceneChoice::all_animations)
                                            : std::nullopt;
       }},
      {"--animation-time", "S", "Time in the animation, in seconds; for a sequence, the time of frame 0", group, false,
       number(0, 1e6,
              [&](double x) {
                a.load.choice.time = x;
                a.has_animation_time = true;
              })},
  };
}

std::vector<Option> sequence_options(Job& a) {
  const std::string group = "Sequences";
  return {
      {"--turntable", "N", "Render N frames while the camera makes one turn around the scene", group, false,
       whole(1, 100'000, [&](int n) { a.sequence.turntable = n; })},
      {"--views", "LIST",
       "Render one frame from each of these directions: front, right, back, left, top, bottom or iso; the animation "
       "rests at --animation-time",
       group, false, [&](auto& text) { a.sequence.views = parse_views(text); }, view_names()},
      {"--camera-path", "FILE",
       "Move the camera through the keys of a JSON file: {\"keys\": [{\"time\": 0, \"position\": [X,Y,Z], "
       "\"focal_point\": [X,Y,Z]}, ...]}, with view_up and view_angle where they are given; on smooth curves between "
       "them",
       group, false, [&](auto& text) { a.sequence.camera_path = read_camera_path(text); }},
      {"--frames", "N", "Number of frames; default: to the end of the animation or turn", group, false,
       whole(1, 100'000, [&](int n) { a.sequence.count = n; })},
      {"--frame-start,-s", "F", "First frame; default 0", group, false,
       whole(-1'000'000, 1'000'000, [&](int n) { a.sequence.first = n; })},
      {"--frame-end,-e", "F", "Last frame", group, false,
       whole(-1'000'000, 1'000'000, [&](int n) { a.sequence.last = n; })},
      {"--frame-jump,-j", "N", "Step between frames; default 1", group, false,
       whole(1, 1'000'000, [&](int n) { a.sequence.jump = n; })},
      {"--frame-rate", "FPS", "Frames per second; default 24", group, false,
       number(0.001, 65535, [&](double x) { a.sequence.rate = x; })},
      {"--shutter", "DEG", "Motion blur: shutter angle in degrees; 360 is the whole frame interval", group, false,
       number(0.001, 360, [&](double x) { a.sequence.shutter = x; })},
      {"--shutter-samples", "N", "Motion blur: number of samples in time; default 16", group, false,
       whole(1, 1024, [&](int n) { a.sequence.shutter_samples = n; })},
      {"--shutter-filter", "FILTER",
       "Motion blur: weight of the moments: box, triangle or gaussian, of the shutter's width at half their height",
       group, false, [&](auto& text) { a.sequence.shutter_filter = parse_shutter_filter(text); }},
      {"--warm-up", "N",
       "Frames before the first that are rendered but not written, for methods that average frames; default 0", group,
       false, whole(0, 100'000, [&](int n) { a.sequence.warm_up = n; })},
  };
}

std::vector<Option> picture_options(Job& a) {
  const std::string group = "Image";
  return {
      {"--resolution,--size", "W,H", "Size in pixels, 800,600 or 800x600, or 512 for a square; default 800,600", group,
       true,
       [&](auto& text) {
         const int2 size = parse_size(text, max_side);
         a.options.width = size.x, a.options.height = size.y;
       }},
      {"--quality", "LEVEL",
       "Sets several options, which other options change: fast is --aa msaa:n=4 --anisotropy 1; default; best is --aa "
       "msaa:n=16,alpha=samples --anisotropy 16 --shadows soft:samples=64,spacing=8 --ambient-occlusion "
       "rays:samples=64,spacing=8 --ground shadow --specular-aa full, on the background #e8e6e0; "
       "the compression of files is --jpeg-quality and --webp-quality",
       group, true, [&](auto& text) { set_quality(a, parse_quality(text)); }, Choices{"fast", "default", "best"}},
      {"--anti-aliasing,--aa", "METHOD",
       "Method with its parameters, for example ssaa:n=4 (zoneplate list methods); default msaa:n=8,alpha=samples",
       group, true, [&](auto& text) { a.method = text, a.has_method = true; }, method_names()},
      {"--upscale", "METHOD",
       "Render a smaller frame and upscale it, for example fsr1 or lanczos:lobes=2 (zoneplate list upscalers); "
       "textures are filtered for the pixels of the image",
       group, true, [&](auto& text) { a.upscaler = text; }, upscaler_names()},
      {"--render-scale", "RATIO",
       "Image size over frame size per axis, from 1 to 4, or ultra-quality (1.3), quality (1.5), balanced (1.7), "
       "performance (2), ultra-performance (3); default 1.5",
       group, true, [&](auto& text) { a.render_scale = parse_render_scale(text); },
       Choices{"ultra-quality", "quality", "balanced", "performance", "ultra-performance"}},
      {"--background-color,--background", "COLOR",
       "Background colour, or environment: the light's image; default #333333", group, true,
       [&](auto& text) {
         if (text == "environment")
           a.options.background.emplace();
         else
           a.background = parse_color(text);
       }},
      {"--background-blur", "AMOUNT", "Blur of --background environment, from 0 to 1; default 0", group, false,
       number(0, 1, [&](double x) { a.background_blur = static_cast<float>(x); })},
      {"--no-background", "", "Transparent background: the default of .exr", group, true,
       [&](auto&) { a.display.is_transparent = true; }},
      {"--opaque-glass", "",
       "With a transparent background, transmissive surfaces are opaque and transmit black where nothing is behind "
       "them, "
       "as in Babylon.js and Khronos' sample viewer; otherwise their alpha is 1 - the part of light that passes",
       group, true, [&](auto&) { a.options.opaque_glass = true; }},
      tone_mapping_option(a.tone_mapping, "default neutral in the studio that a scene without lights gets, else none",
                          group),
      {"--exposure", "STOPS",
       "Exposure in stops: each stop doubles the brightness, negative ones halve it; or auto: 95 % of the surfaces' "
       "pixels have no channel above 0.8, in a sequence those of frame 0; default 0",
       group, false,
       [&](auto& text) {
         const std::optional<float> factor = parse_exposure(text);
         a.meters_exposure = !factor, a.has_own_brightness = true;
         a.display.exposure = factor.value_or(1);
       },
       Choices{"auto"}},
      choice_option("--bit-depth", "BITS", "Bits per channel of .png and .rgba: 8 or 16; default 8", group, false,
                    {"8", "16"}, [&](std::size_t i) { a.bit_depth = i == 1 ? 16 : 8; }),
      {"--jpeg-quality", "N", "Quality of .jpg, 1 to 100: smaller files below, fewer artifacts above; default 92",
       group, false, whole(1, 100, [&](int n) { a.file.jpeg_quality = n; })},
      {"--webp-quality", "N", "Quality of .webp, still or animated, 0 to 100, with loss; default: lossless", group,
       false, whole(0, 100, [&](int n) { a.file.webp_quality = n; })},
      choice_option("--png-compression", "KIND",
                    "Compression of .png: fast, or small: some 30 % smaller, several "
                    "times slower; default fast",
                    group, false, {"fast", "small"}, [&](std::size_t i) { a.file.is_small_png = i == 1; }),
      choice_option(
          "--exr-compression", "KIND",
          "Compression of .exr: zip, in blocks of 16 rows, zips, row by row, or none; default zip", group, false,
          {"zip", "zips", "none"},
          [&](std::size_t i) {
            constexpr ExrCompression kinds[] = {ExrCompression::Zip, ExrCompression::Zips, ExrCompression::None};
            a.file.exr_compression = kinds[i];
          }),
      {"--dither", "", "Ordered dithering of 8-bit images, against banding", group, false,
       [&](auto&) { a.dithers = true; }},
      {"--crop", "X,Y,W,H", "Render only this rectangle, with the same bits as in the whole image", group, false,
       [&](auto& text) { a.options.crop = parse_crop(text); }},
      {"--aov", "NAMES",
       "Data passes to write as well: depth, normal, position, albedo, uv, motion, flow, object-id, material-id, "
       "primitive-id, crypto-object, crypto-material, mip-level, anisotropy, coverage, error; diffuse, specular, "
       "transmission and emission, or light for these four, which are rendered one after the other; all for the passes "
       "that a still of any method has, without light; layers of the image if it is an .exr",
       group, false, [&](auto& text) { a.aovs = parse_aovs(text); }, aov_names()},
      choice_option("--color-management", "MODE",
                    "srgb, or raw: neither sRGB decoding of textures nor encoding of the image; default srgb", group,
                    false, {"srgb", "raw"}, [&](std::size_t i) { a.display.raw = a.mips.raw_colors = i == 1; }),
  };
}

std::vector<Option> camera_options(Job& a) {
  const std::string group = "Camera";
  return {
      {"--camera-azimuth-angle", "DEG", "Angle about the up axis, from the front to the right; default 30", group, true,
       angle(-360, 360, [&](float x) { a.view.azimuth = x; })},
      {"--camera-elevation-angle", "DEG", "Angle above the horizon; default 20", group, true,
       angle(-90, 90, [&](float x) { a.view.elevation = x; })},
      {"--camera-position", "X,Y,Z", "Position of the camera", group, false,
       [&](auto& text) { a.view.position = parse_triple(text); }},
      {"--camera-focal-point", "X,Y,Z", "Point at which the camera looks; default: the centre of the scene", group,
       false, [&](auto& text) { a.view.focal_point = parse_triple(text); }},
      {"--camera-view-up", "X,Y,Z", "Upward direction of the image; default: the up axis", group, false,
       [&](auto& text) { a.view.view_up = narrowed(parse_triple(text)); }},
      {"--camera-view-angle", "DEG", "Vertical angle of view; default 30", group, false,
       angle(0.01, 179, [&](float x) { a.view.view_angle = x; })},
      {"--camera-intrinsics", "FX,FY,CX,CY",
       "Focal lengths and principal point in pixels, as of OpenCV: (0, 0) is the centre of the top-left pixel; instead "
       "of a view angle",
       group, false, [&](auto& text) { a.lens.intrinsics = parse_intrinsics(text); }},
      {"--camera-distortion", "LIST", "Distortion of the lens as of OpenCV: K1,K2,P1,P2[,K3[,K4,K5,K6]]", group, false,
       [&](auto& text) { a.lens.distortion = parse_distortion(text); }},
      {"--camera-calibration", "FILE",
       "Intrinsics and distortion of a JSON file by OpenCV's FileStorage: camera_matrix, distortion_coefficients, "
       "image_width and image_height",
       group, false, [&](auto& text) { a.lens.calibrated = read_calibration(text); }},
      {"--camera-orthographic", "", "Orthographic projection", group, false,
       [&](auto&) { a.view.is_orthographic = true; }},
      {"--camera-index", "N", "Index of a camera of the scene, from 0", group, false,
       whole(0, 1 << 20, [&](int n) { a.view.index = n; })},
      {"--up", "AXIS", "Up axis of the scene: +Y, +Z, ...; default +Z for STL, 3MF and AMF, else +Y or the file's",
       group, false, [&](auto& text) { a.up = parse_up(text); }},
  };
}

std::vector<Option> scene_options(Job& a) {
  const std::string group = "Materials and lights";
  return {
      {"--color", "COLOR", "Colour of surfaces without a material, as in STL files; multiplies colours of vertices",
       group, false,
       [&](auto& text) {
         const float3 light = linear_color(text);
         a.default_material.color = float4{light.x, light.y, light.z, parse_color(text).w};
       }},
      {"--texture", "FILE",
       "Image for surfaces without a material: .png, .jpg, .webp, .hdr, .exr or .ktx2; times --color, if given", group,
       false, [&](auto& text) { a.default_material.texture = text; }},
      {"--normal-map", "FILE", "Normal map in tangent space for surfaces without a material", group, false,
       [&](auto& text) { a.default_material.normal_map = text; }},
      {"--height-map", "FILE",
       "Height map for surfaces without a material: bumps, or geometry with --displacement; white is --height-scale "
       "above black",
       group, false, [&](auto& text) { a.default_material.height_map = text; }},
      {"--height-scale", "H", "Height of white above black of --height-map; default a hundredth of the longest side",
       group, false, number(-1e9, 1e9, [&](double x) { a.default_material.height_scale = static_cast<float>(x); })},
      {"--metallic", "M", "Metalness of surfaces without a material, from 0, a dielectric, to 1, a metal", group, false,
       number(0, 1, [&](double x) { a.default_material.metallic = static_cast<float>(x); })},
      {"--roughness", "R", "Roughness of surfaces without a material, from 0, a mirror, to 1", group, false,
       number(0, 1, [&](double x) { a.default_material.roughness = static_cast<float>(x); })},
      choice_option("--shading-model", "MODEL", "Shading model of all materials: blinn-phong, phong, pbr or unlit",
                    group, false, {"blinn-phong", "phong", "pbr", "unlit"},
                    [&](std::size_t i) {
                      constexpr ShadingModel models[] = {ShadingModel::BlinnPhong, ShadingModel::Phong,
                                                         ShadingModel::MetallicRoughness, ShadingModel::Unlit};
                      a.shading_model = models[i];
                    }),
      {"--displacement", "TOLERANCE",
       "Turn height textures into geometry instead of bumps: refine meshes until they are this near to the heights,\n"
       "relative to their longest side, for example 0.001",
       group, false, number(1e-6, 1, [&](double x) { a.displacement = static_cast<float>(x); })},
      {"--section",
       "X,Y,Z,D",
       "Cut away what lies beyond the plane X x + Y y + Z z = D of the file's coordinates, and close solids by caps; "
       "several planes leave what lies beyond none",
       group,
       false,
       [&](auto& text) { a.section.planes.push_back(parse_section(text)); },
       {},
       true},
      {"--section-color", "COLOR", "Colour of the caps of --section; default: that of the surface that is cut", group,
       false,
       [&](auto& text) {
         const float3 light = linear_color(text);
         a.section.color = float4{light.x, light.y, light.z, 1};
       }},
      {"--solid-texture", "PATTERN",
       "Procedural texture of all materials, for example marble:scale=6: " + solid_texture_names(), group, false,
       [&](auto& text) { a.solid_texture = check_solid_texture(text); }},
      choice_option("--lights", "SOURCE",
                    "Lights: file, those of the model alone, or the default light where it has none; default, the "
                    "default light, or --environment or --hdri-file alone; or both, the model's and the default light; "
                    "by default those of the model and, so that nothing is black, the default environment at 0.15",
                    group, false, {"file", "default", "both"},
                    [&](std::size_t i) {
                      constexpr LightSource sources[] = {LightSource::Alone, LightSource::Default, LightSource::Both};
                      a.lighting.source = sources[i];
                    }),
      {"--light-intensity", "FACTOR", "Factor of all lights; default 1", group, false,
       number(0, 1e6,
              [&](double x) {
                a.lighting.intensity = static_cast<float>(x);
                a.has_own_brightness = true;
              })},
      {"--environment", "COLOR",
       "Constant environment light of this colour, instead of the default lights; or studio: the boxes of the default "
       "light, also for files with lights of their own; linear:R,G,B is a radiance",
       group, false,
       [&](auto& text) {
         a.is_in_studio = text == "studio";
         a.environment_color = a.is_in_studio ? std::nullopt : std::optional(parse_radiance(text));
       }},
      {"--hdri-file", "FILE",
       "Image-based light, instead of the default lights: .hdr, .exr, .pfm, .png, .jpg or .webp; {face} in the name "
       "stands "
       "for px, nx, py, ny, pz and nz, the six squares of a cube map",
       group, false, [&](auto& text) { a.hdri_file = text; }},
      choice_option("--hdri-layout", "NAME",
                    "equirectangular, cross or strip of a cube map, mirror-ball, or angular (light probe); default by "
                    "the aspect",
                    group, false, {"equirectangular", "cross", "strip", "mirror-ball", "angular"},
                    [&](std::size_t i) {
                      constexpr EnvironmentLayout layouts[] = {
                          EnvironmentLayout::Equirectangular, EnvironmentLayout::Cross, EnvironmentLayout::Strip,
                          EnvironmentLayout::MirrorBall, EnvironmentLayout::AngularMap};
                      a.hdri_layout = layouts[i];
                    }),
      {"--hdri-rotation", "DEG", "Turn of the image about the up axis, counter-clockwise from above; default 0", group,
       false, angle(-360, 360, [&](float x) { a.hdri_rotation = x; })},
      {"--hdri-intensity", "FACTOR", "Factor of the image's light; default 1", group, false,
       number(0, 1e6, [&](double x) { a.hdri_intensity = static_cast<float>(x); })},
      {"--shadows", "METHOD",
       "Shadows of the lights: none; hard, one ray from each fragment to each light; soft:samples=N,angle=DEG, N rays "
       "to a light of this angular radius, default 32 and 3; or map:filter=F,size=N, depth images from the lights with "
       "the filter nearest, pcf, pcss or evsm, default pcf and 2048; default none",
       group, false, [&](auto& text) { a.options.shadows = parse_shadows(text); },
       Choices{"none", "hard", "soft", "map"}},
      {"--ambient-occlusion", "METHOD",
       "What hides the environment's light: none, or rays:samples=N,distance=D, surfaces within D world units, default "
       "a quarter of the scene's diagonal; default none",
       group, false, [&](auto& text) { a.options.occlusion = parse_occlusion(text); }, Choices{"none", "rays"}},
      choice_option(
          "--ground", "KIND",
          "What lies under the scene: none, or shadow: a plane that shows the shadows on it alone, over the "
          "background or, with --no-background, as alpha; requires --shadows or --ambient-occlusion; default none",
          group, false, {"none", "shadow"},
          [&](std::size_t i) { a.options.ground = i == 1 ? GroundKind::Shadow : GroundKind::None; }),
      {"--no-cull", "", "Draw back faces of single-sided materials", group, false,
       [&](auto&) { a.options.cull_back_faces = false; }},
      {"--point-size", "PX",
       "Size of points, which are drawn as squares; default: the size with which all points would cover a sixteenth of "
       "the image, from 1 to a hundredth of its height",
       group, false, number(0.01, 1024, [&](double x) { a.point_size = static_cast<float>(x); })},
      {"--anisotropy", "N",
       "Maximum anisotropy of texture filtering, 1 to 16; default 4, or the own value of a built-in scene", group,
       false, whole(1, 16, [&](int n) { a.anisotropy = n; })},
      {"--texture-filter", "FILTER",
       "Filter of all textures, in place of the scene's own: " + texture_filter_names() +
           "; for example ewa:anisotropy=16 (zoneplate list texture-filters)",
       group, false, [&](auto& text) { a.options.texture_filter = parse_texture_filter(text); }, texture_filter_list()},
      {"--mip-filter", "FILTER",
       "Filter that makes mip levels: box, kaiser or lanczos; :alpha=coverage keeps the fraction of an alpha-tested "
       "texture that is opaque, :color=straight shows the colours that transparent texels hide, as GPUs do; default "
       "box",
       group, false, [&](auto& text) { set_mip_filter(text, a.mips); }, Choices{"box", "kaiser", "lanczos"}},
      choice_option(
          "--specular-aa", "KIND",
          "Widen highlights by the normals' variance in a pixel: none, geometric (curvature), toksvig or lean (normal "
          "maps), or full (geometric and lean); default none",
          group, false, {"none", "geometric", "toksvig", "lean", "full"},
          [&](std::size_t i) { a.options.specular_aa = static_cast<SpecularAntialiasing>(i); }),
      {"--edges", "KIND",
       "Draw edges of triangles as lines: none; features, boundaries, silhouettes and creases, for example "
       "features:angle=30,width=1.5; mesh, all edges; or wireframe, all edges without surfaces. hidden=shown does not "
       "remove lines behind surfaces, surfaces=none leaves out the surfaces; default none",
       group, false, [&](auto& text) { set_edges(text, a.options.edges); },
       Choices{"none", "features", "mesh", "wireframe"}},
      {"--edge-color", "COLOR", "Colour of --edges; default black, or white where a dark background alone is below",
       group, false, [&](auto& text) { a.options.edges.color = parse_color(text); }},
      {"--line-width", "PX", "Width of lines of the model; default 1", group, false,
       number(0.01, 1024, [&](double x) { a.options.line_width = static_cast<float>(x); })},
  };
}

std::vector<Option> teaching_options(Job& a) {
  const std::string group = "Teaching";
  return {
      choice_option("--edge-rule", "RULE",
                    "Fill rule: top-left, or inside: every triangle includes its edges; default top-left", group, false,
                    {"top-left", "inside"},
                    [&](std::size_t i) { a.options.edge_rule = i == 0 ? EdgeRule::TopLeft : EdgeRule::Inside; }),
      choice_option("--visibility", "RULE",
                    "Hidden-surface removal: z-buffer, or painter: triangles sorted back to front, no depth test; "
                    "default z-buffer",
                    group, false, {"z-buffer", "painter"},
                    [&](std::size_t i) { a.options.visibility = i == 0 ? Visibility::ZBuffer : Visibility::Painter; }),
      choice_option("--shading-frequency", "RULE",
                    "Where lights are evaluated: flat: once for each triangle; gouraud: at vertices, and "
                    "interpolated; phong: at every "
                    "fragment; default phong",
                    group, false, {"flat", "gouraud", "phong"},
                    [&](std::size_t i) {
                      constexpr ShadingFrequency rules[] = {ShadingFrequency::Triangle, ShadingFrequency::Vertex,
                                                            ShadingFrequency::Fragment};
                      a.options.shading_frequency = rules[i];
                    }),
  };
}

std::vector<Option> run_options(Job& a) {
  const std::string group = "Running";
  LoadLimits& limits = a.load.limits;
  return {{"--threads,-t", "N", "Maximum number of threads; default 0: all that affinity and CPU quota allow", group,
           false, whole(0, 1024, [&](int n) { a.threads = n; })},
          {"--isa", "SET",
           "Instruction set: scalar, sse4, avx2 or avx512, all with the same bits; default: the best available", group,
           false, [&](auto& text) { a.isa = parse_isa(text); }, Choices{"scalar", "sse4", "avx2", "avx512"}},
          {"--strict", "",
           "A texture that is missing, or an invalid part of the model, is an error; otherwise it is left out with a "
           "warning",
           group, false, [&](auto&) { limits.is_strict = true; }},
          allow_path_option(limits, group)};
}

}  // namespace

std::vector<Option> reading_options(LoadLimits& limits, const std::string& group, const std::string& subject) {
  return {{"--max-memory", "BYTES",
           "Memory limit of " + subject + ", from reading to the encoded output, for example 512M; default 4G", group,
           false, [&](auto& text) { limits.memory = parse_bytes(text); }},
          {"--max-pixels", "N", "Reject images and textures with more pixels, for example 16M; default 256M", group,
           false, [&](auto& text) { limits.pixels = parse_bytes(text); }},
          {"--max-import-seconds", "S", "Time limit of reading a model or an image; default 60", group, false,
           number(0.001, 1e6, [&](double x) { limits.seconds = x; })}};
}

Option allow_path_option(LoadLimits& limits, const std::string& group) {
  return {"--allow-path", "PATH", "Allow models to read this file or folder outside their own; may be repeated",
          group,          false,  [&](auto& text) { limits.allowed_paths.push_back(text); }};
}

std::vector<Option> job_options(Job& job) {
  std::vector<Option> out;
  for (const auto table :
       {picture_options, input_options, sequence_options, camera_options, scene_options, teaching_options, run_options})
    for (Option& option : table(job)) out.push_back(std::move(option));
  return out;
}

}  // namespace zoneplate
