#include "zoneplate/cli/render/args.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "zoneplate/base/error.h"
#include "zoneplate/cli/render/frame_name.h"
#include "zoneplate/cli/values.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/elementary.h"

namespace zoneplate::cli {
namespace {

constexpr const char* examples =
    "  zoneplate teapot -o teapot.png\n  zoneplate render chair.glb -o chair.png --size 1024x768 --aa ssaa:n=4\n  "
    "zoneplate render chair.glb -o chair.png --camera-azimuth-angle 120 --no-background\n  zoneplate render chair.obj "
    "-o - --quiet | display\n  zoneplate render chair.glb -o chair.png --aov depth,normal --json\n";

constexpr const char* notes =
    "IN is a .gltf, .glb, .obj, .ply or .stl file or another (zoneplate list formats), - for stdin, or a built-in "
    "scene (zoneplate list scenes). OUT "
    "ends\nin "
    ".png, .jpg or .webp; - is stdout.\nData passes are written beside OUT: chair.png, chair.depth.png.\n\nCamera: "
    "without any camera "
    "option the "
    "whole scene is shown three-quarter from above (azimuth 30, elevation\n20 degrees, view angle 30); built-in scenes "
    "that have a camera use it. Cameras of a file are used with\n--camera-index only. Azimuth and elevation choose the "
    "direction of the whole-scene view, 0 and 0 being the\nfront; with a position or an index they turn that camera "
    "about its focal point.\n\nLight: a scene without lights gets a key, a fill and a back light that follow the "
    "camera, and a dim constant\nenvironment that metals mirror; any light in the file or an --environment switches "
    "them off.\n\nSequences: frame F shows the animation at F / rate seconds. OUT has a place for the number, "
    "as\nchair.####.png, "
    "chair%04d.png or chair_{frame:04}.png, or is a film. GIF, MP4 and WebM are made by the program ffmpeg.\n\nMany at "
    "once: "
    "several IN want {model} in OUT; each item gives a line of JSON on stdout.\n\nColours are sRGB: red, #f80, "
    "#ff8800, #ff880080 or 1,0.5,0.\n\nExit codes: 0 done, 1 failed while "
    "rendering, 2 wrong usage, 3 input missing, corrupt or unsupported,\n4 output cannot be written, 5 some of many "
    "items failed, 128+n ended by "
    "signal n. No partial file is ever left.\n";

float radians(const std::string& text, double low, double high) {
  return static_cast<float>(parse_number(text, low, high) * 3.14159265358979323846 / 180);
}

float3 linear_color(const std::string& text) {
  const float4 code = parse_color(text);
  return {decode_srgb(code.x), decode_srgb(code.y), decode_srgb(code.z)};
}

float3 parse_up(const std::string& text) {
  constexpr float3 axes[] = {{0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}};
  const std::string signed_text = text.size() == 1 ? '+' + text : text;
  return axes[parse_choice(signed_text, {"+Y", "-Y", "+Z", "-Z", "+X", "-X"})];
}

Crop parse_crop(const std::string& text) {
  std::vector<int> numbers;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    numbers.push_back(parse_whole(text.substr(at, comma - at), 0, max_side));
    at = comma + 1;
  }
  if (numbers.size() != 4 || numbers[2] == 0 || numbers[3] == 0)
    throw Error(ErrorKind::Usage, fmt::format("'{}' is not a rectangle x,y,width,height", text));
  return {numbers[0], numbers[1], numbers[2], numbers[3]};
}

std::vector<const Aov*> parse_aovs(const std::string& text) {
  std::vector<std::string_view> names;
  for (const Aov& aov : aovs()) names.push_back(aov.name);
  std::vector<const Aov*> found;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    found.push_back(&aovs()[parse_choice(text.substr(at, comma - at), names)]);
    at = comma + 1;
  }
  return found;
}

std::vector<Option> input_options(RenderArgs& a) {
  const std::string group = "Input";
  return {
      {"--format", "NAME", "Read IN as this format, as stl or glb; needed where IN is -", group, false,
       [&](auto& text) { a.load.format = text; }},
      {"--scene", "N", "The scene number N of a glTF file, from 0; default the one that it names", group, false,
       [&](auto& text) { a.load.choice.scene = parse_whole(text, 0, 1 << 20); }},
      {"--variant", "NAME", "A glTF file's materials in this variant (KHR_materials_variants)", group, false,
       [&](auto& text) { a.load.choice.variant = text; }},
      {"--animation-index", "N", "The animation number N of a glTF file, from 0; or all, which is the default", group,
       false,
       [&](auto& text) {
         a.load.choice.animation = text == "all" ? SceneChoice::all_animations : parse_whole(text, 0, 1 << 20);
       }},
      {"--animation-time", "S", "The moment of the animation, in seconds; of a sequence, that of frame 0", group, false,
       [&](auto& text) {
         a.load.choice.time = parse_number(text, 0, 1e6);
         a.has_animation_time = true;
       }},
  };
}

std::vector<Option> sequence_options(RenderArgs& a) {
  const std::string group = "Sequences";
  return {
      {"--turntable", "N", "N frames, in which the camera goes once round the scene", group, false,
       [&](auto& text) { a.sequence.turntable = parse_whole(text, 1, 100'000); }},
      {"--frames", "N", "So many frames; default to the end of the animation, or of the turn", group, false,
       [&](auto& text) { a.sequence.count = parse_whole(text, 1, 100'000); }},
      {"--frame-start,-s", "F", "The first frame; default 0", group, false,
       [&](auto& text) { a.sequence.first = parse_whole(text, -1'000'000, 1'000'000); }},
      {"--frame-end,-e", "F", "The last frame", group, false,
       [&](auto& text) { a.sequence.last = parse_whole(text, -1'000'000, 1'000'000); }},
      {"--frame-jump,-j", "N", "From one frame to the next; default 1", group, false,
       [&](auto& text) { a.sequence.jump = parse_whole(text, 1, 1'000'000); }},
      {"--frame-rate", "FPS", "Frames a second; default 24", group, false,
       [&](auto& text) { a.sequence.rate = parse_number(text, 0.001, 65535); }},
      {"--shutter", "DEG", "Mean of what moves while the shutter is open: 360 is a frame's whole time", group, false,
       [&](auto& text) { a.sequence.shutter = parse_number(text, 0.001, 360); }},
      {"--shutter-samples", "N", "Moments that the mean is made of; default 16", group, false,
       [&](auto& text) { a.sequence.shutter_samples = parse_whole(text, 1, 1024); }},
  };
}

std::vector<Option> batch_options(RenderArgs& a) {
  const std::string group = "Many at once";
  return {
      {"--manifest", "FILE", "Jobs, a JSON object a line: input, output, and options by their names", group, false,
       [&](auto& text) { a.manifest = text; }},
      {"--shard", "I/N", "Only every Nth job from number I (0 to N-1) on; auto for Slurm's and Kubernetes' variables",
       group, false, [&](auto& text) { a.shard = parse_shard(text); }},
      {"--skip-existing", "", "Leave out what is there already", group, false, [&](auto&) { a.skip_existing = true; }},
  };
}

std::vector<Option> picture_options(RenderArgs& a) {
  const std::string group = "Picture";
  return {
      {"--output,-o", "OUT",
       "The picture to write: .png, .jpg, .webp, .exr, .pfm or .rgba, or - for stdout; a film: .apng, .webp, .gif, "
       ".mp4, .webm",
       group, true, [&](auto& text) { a.output = text; }},
      {"--output-format", "FORMAT", "Of a picture on stdout: png, jpg, webp, exr, pfm or rgba; default png", group,
       false,
       [&](auto& text) {
         const std::vector<std::string_view> formats = {"png", "jpg", "webp", "exr", "pfm", "rgba"};
         a.stdout_format = formats[parse_choice(text, formats)];
       }},
      {"--resolution,--size", "W,H", "Size in pixels, 800,600 or 800x600; default 800,600", group, true,
       [&](auto& text) {
         const int2 size = parse_size(text, max_side);
         a.options.width = size.x, a.options.height = size.y;
       }},
      {"--anti-aliasing,--aa", "METHOD",
       "Method with its parameters, as ssaa:n=4 (zoneplate list methods); default msaa:n=8", group, true,
       [&](auto& text) { a.method = text; }},
      {"--background-color,--background", "COLOR", "Shown behind the scene; default #333333", group, true,
       [&](auto& text) { a.background = parse_color(text); }},
      {"--no-background", "", "Leave the picture transparent where nothing is", group, true,
       [&](auto&) { a.display.is_transparent = true; }},
      {"--tone-mapping", "CURVE", "none, aces or neutral; default none", group, false,
       [&](auto& text) {
         constexpr ToneMapping curves[] = {ToneMapping::None, ToneMapping::Aces, ToneMapping::Neutral};
         a.display.mapping = curves[parse_choice(text, {"none", "aces", "neutral"})];
       }},
      {"--exposure", "STOPS", "Brighter by a factor 2 for each stop, darker where negative; default 0", group, false,
       [&](auto& text) { a.display.exposure = exp2(static_cast<float>(parse_number(text, -32, 32))); }},
      {"--bit-depth", "BITS", "8 or 16 bits a channel, of a PNG; default 8", group, false,
       [&](auto& text) {
         a.bit_depth = parse_choice(text, {"8", "16"}) == 1 ? 16 : 8;
       }},
      {"--dither", "", "Noise in place of the steps between 8-bit codes", group, false,
       [&](auto&) { a.dithers = true; }},
      {"--crop", "X,Y,W,H", "Write only this part, with the same bits as in the whole picture", group, false,
       [&](auto& text) { a.options.crop = parse_crop(text); }},
      {"--aov", "NAMES",
       "Data passes to write too: depth, normal, position, albedo, uv, motion, flow, object-id, material-id, "
       "primitive-id, crypto-object, crypto-material, coverage, error; in an .exr as its layers",
       group, false, [&](auto& text) { a.aovs = parse_aovs(text); }},
      {"--color-management", "MODE",
       "srgb, or raw: no sRGB decoding of textures, no encoding of the picture; default srgb", group, false,
       [&](auto& text) {
         a.display.raw = a.raw_colors = parse_choice(text, {"srgb", "raw"}) == 1;
       }},
  };
}

std::vector<Option> camera_options(RenderArgs& a) {
  const std::string group = "Camera";
  return {
      {"--camera-azimuth-angle", "DEG", "Direction about the up axis, from the front to the right; default 30", group,
       true, [&](auto& text) { a.view.azimuth = radians(text, -360, 360); }},
      {"--camera-elevation-angle", "DEG", "Direction above the horizon; default 20", group, true,
       [&](auto& text) { a.view.elevation = radians(text, -90, 90); }},
      {"--camera-position", "X,Y,Z", "The eye", group, false,
       [&](auto& text) { a.view.position = parse_triple(text); }},
      {"--camera-focal-point", "X,Y,Z", "What the eye looks at; default the centre of the scene", group, false,
       [&](auto& text) { a.view.focal_point = parse_triple(text); }},
      {"--camera-view-up", "X,Y,Z", "What is upwards in the picture; default the up axis", group, false,
       [&](auto& text) { a.view.view_up = parse_triple(text); }},
      {"--camera-view-angle", "DEG", "Vertical angle of view; default 30", group, false,
       [&](auto& text) { a.view.view_angle = radians(text, 0.01, 179); }},
      {"--camera-orthographic", "", "Parallel projection", group, false, [&](auto&) { a.view.is_orthographic = true; }},
      {"--camera-index", "N", "The camera number N of the scene, from 0", group, false,
       [&](auto& text) { a.view.index = parse_whole(text, 0, 1 << 20); }},
      {"--up", "AXIS", "The scene's upward axis: +Y, +Z, ...; default +Z for STL, +Y for all else", group, false,
       [&](auto& text) { a.up = parse_up(text); }},
  };
}

std::vector<Option> scene_options(RenderArgs& a) {
  const std::string group = "Surfaces and light";
  return {
      {"--shading-model", "MODEL", "For every material: blinn-phong, phong, pbr or unlit", group, false,
       [&](auto& text) {
         constexpr ShadingModel models[] = {ShadingModel::BlinnPhong, ShadingModel::Phong,
                                            ShadingModel::MetallicRoughness, ShadingModel::Unlit};
         a.shading_model = models[parse_choice(text, {"blinn-phong", "phong", "pbr", "unlit"})];
       }},
      {"--light-intensity", "FACTOR", "Multiplies every light; default 1", group, false,
       [&](auto& text) { a.lighting.intensity = static_cast<float>(parse_number(text, 0, 1e6)); }},
      {"--environment", "COLOR", "Light of one colour from all sides, in place of the default lights", group, false,
       [&](auto& text) { a.lighting.environment = linear_color(text); }},
      {"--no-cull", "", "Draw the back faces of single-sided materials too", group, false,
       [&](auto&) { a.options.cull_back_faces = false; }},
      {"--point-size", "PX", "Side of the squares that points are drawn as; default 1", group, false,
       [&](auto& text) { a.options.point_size = static_cast<float>(parse_number(text, 0.01, 1024)); }},
      {"--anisotropy", "N", "Texture probes along a footprint, 1 to 16; default 1, and what a scene asks for", group,
       false, [&](auto& text) { a.options.anisotropy = parse_whole(text, 1, 16); }},
      {"--line-width", "PX", "Width of lines; default 1", group, false,
       [&](auto& text) { a.options.line_width = static_cast<float>(parse_number(text, 0.01, 1024)); }},
  };
}

std::vector<Option> teaching_options(RenderArgs& a) {
  const std::string group = "For teaching";
  return {
      {"--edge-rule", "RULE", "top-left, or inside: a triangle owns all of its edges; default top-left", group, false,
       [&](auto& text) {
         a.options.edge_rule = parse_choice(text, {"top-left", "inside"}) == 0 ? EdgeRule::TopLeft : EdgeRule::Inside;
       }},
      {"--visibility", "RULE", "z-buffer, or painter: far triangles first, no depth test; default z-buffer", group,
       false,
       [&](auto& text) {
         a.options.visibility =
             parse_choice(text, {"z-buffer", "painter"}) == 0 ? Visibility::ZBuffer : Visibility::Painter;
       }},
  };
}

std::vector<Option> run_options(RenderArgs& a) {
  const std::string group = "Running";
  return {
      {"--threads,-t", "N", "Threads at most; 0, the default: as many as affinity and CPU quota allow", group, false,
       [&](auto& text) { a.threads = parse_whole(text, 0, 1024); }},
      {"--isa", "SET",
       "Instruction set: scalar, sse4, avx2 or avx512, all with the same bits; default the best there is", group, false,
       [&](auto& text) { a.isa = parse_isa(text); }},
      {"--json", "", "Print the result as one line of JSON (to stderr where OUT is -)", group, false,
       [&](auto&) { a.wants_json = true; }},
      {"--progress", "KIND", "On stderr: auto (a bar on a terminal), bar, json or none; default auto", group, false,
       [&](auto& text) { a.progress = parse_progress(text); }},
      {"--quiet,-q", "", "Say nothing but errors", group, false, [&](auto&) { a.verbosity = Verbosity::Quiet; }},
      {"--verbose,-v", "", "Say what was done, and how long it took", group, false,
       [&](auto&) { a.verbosity = Verbosity::Verbose; }},
      {"--max-memory", "BYTES", "Memory of an item, from reading to the encoded picture, as 512M; default 4G", group,
       false, [&](auto& text) { a.load.limits.memory = parse_bytes(text); }},
      {"--max-pixels", "N", "Refuse textures of more pixels, as 16M; default 256M", group, false,
       [&](auto& text) { a.load.limits.pixels = parse_bytes(text); }},
      {"--max-import-seconds", "S", "Give up reading the scene after this time; default 60", group, false,
       [&](auto& text) { a.load.limits.seconds = parse_number(text, 0.001, 1e6); }},
      {"--max-seconds", "S", "Give up an item after this time, reading included; default no limit", group, false,
       [&](auto& text) { a.max_seconds = parse_number(text, 0.001, 1e9); }},
      {"--sandbox", "", "Read and render in a process that may do nothing else: the default", group, false,
       [&](auto&) { a.is_sandboxed = true; }},
      {"--no-sandbox", "", "Read and render with all rights of the user: for models that you trust", group, false,
       [&](auto&) { a.is_sandboxed = false; }},
      {"--allow-path", "PATH", "Let a model use this file or folder, outside its own; may be given several times",
       group, false, [&](auto& text) { a.load.limits.allowed_paths.push_back(text); }},
  };
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

void check_output(RenderArgs& args) {
  if (args.output.empty()) throw Error(ErrorKind::Usage, "no output: give -o OUT.png, or -o - for stdout");
  const bool is_film = is_one_of(extension_of(args.output), {".apng", ".gif", ".mp4", ".webm"});
  args.sequence.is_film = is_film || has_frame_number(args.output);
  if (args.output == "-") {
    if (!args.aovs.empty() && args.stdout_format != "exr")
      throw Error(ErrorKind::Usage, "--aov writes files beside OUT, which cannot be -; an .exr holds them itself");
    if (args.sequence.is_wanted()) throw Error(ErrorKind::Usage, "several frames cannot be written to -");
    return;
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(args.output, ignored))
    throw Error(ErrorKind::Output, args.output + ": is a directory");
  if (!is_film) check_picture_ending(args.output);
}

}  // namespace

Syntax render_syntax(RenderArgs& args) {
  Syntax syntax{.verb = "render",
                .summary = "Render a model or a built-in scene to a picture",
                .operands = "IN -o OUT",
                .examples = examples,
                .notes = notes};
  for (const auto table : {picture_options, input_options, sequence_options, batch_options, camera_options,
                           scene_options, teaching_options, run_options})
    for (Option& option : table(args)) syntax.options.push_back(std::move(option));
  return syntax;
}

void check_picture_ending(const std::string& output) {
  if (output != "-" && !is_one_of(extension_of(output), {".png", ".jpg", ".jpeg", ".webp", ".pfm", ".exr", ".rgba"}))
    throw Error(
        ErrorKind::Usage,
        fmt::format("--output: {} is not a format that can be written (.png, .jpg, .webp, .exr, .pfm, .rgba)", output));
}

bool exists(const std::string& path) {
  std::error_code ignored;
  return path != "-" && std::filesystem::exists(path, ignored);
}

void check_args(RenderArgs& args) {
  check_output(args);
  const std::string ending = extension_of(args.named_output());
  if (args.output != "-" && args.stdout_format != "png")
    throw Error(ErrorKind::Usage, "--output-format is for -o -: elsewhere the name's ending tells the format");
  if (args.bit_depth == 16 && ending != ".png" && ending != ".rgba")
    throw Error(ErrorKind::Usage, "--bit-depth: only .png and .rgba have 16 bits");
  if (args.dithers && (args.bit_depth == 16 || ending == ".pfm" || ending == ".exr"))
    throw Error(ErrorKind::Usage, "--dither is for 8 bits a channel");
  if (args.sequence.shutter && !args.sequence.is_wanted())
    throw Error(ErrorKind::Usage, "--shutter requires a sequence: --frames, --frame-start, --frame-end or --turntable");
  if (args.sequence.shutter && (!args.aovs.empty() || args.options.crop))
    throw Error(ErrorKind::Usage, "--shutter goes with neither --aov nor --crop");
  for (const Aov* aov : args.aovs) {
    if ((aov->plane == &Planes::motion || aov->plane == &Planes::flow) && !args.sequence.is_wanted())
      throw Error(ErrorKind::Usage,
                  fmt::format("--aov {} requires a sequence, or a frame of one: -s 5 -e 5", aov->name));
    if (aov->plane == &Planes::sample_triangles && ending == ".pfm")
      throw Error(ErrorKind::Usage,
                  fmt::format("--aov {} requires an .exr, or a picture of it beside a .png", aov->name));
  }
  if (args.has_animation_time && !args.load.choice.animation && !args.sequence.is_wanted())
    args.load.choice.animation = SceneChoice::all_animations;
  if (const auto& crop = args.options.crop)
    if (crop->x + crop->width > args.options.width || crop->y + crop->height > args.options.height)
      throw Error(ErrorKind::Usage, fmt::format("--crop: the rectangle is not inside the picture of {}x{}",
                                                args.options.width, args.options.height));
}

std::optional<RenderArgs> parse_render_args(std::span<const std::string> arguments) {
  RenderArgs args;
  Syntax syntax = render_syntax(args);
  if (!parse(syntax, arguments)) return std::nullopt;
  args.inputs = syntax.found_operands;
  if (!args.manifest.empty()) {
    if (!args.inputs.empty())
      throw Error(ErrorKind::Usage, "--manifest names the inputs: " + args.inputs.front() + " is one more");
    return args;
  }
  if (args.inputs.empty()) throw Error(ErrorKind::Usage, "no input: give a model or a built-in scene");
  if (args.inputs.size() > 1 && args.output.find("{model}") == std::string::npos)
    throw Error(ErrorKind::Usage, "several inputs want {model} in the output's name, as pictures/{model}.png");
  args.input = args.inputs.front();
  check_args(args);
  return args;
}

}  // namespace zoneplate::cli
