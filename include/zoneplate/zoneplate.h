// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// The interface for C, and for other languages that call C functions: scenes, rendering, metrics and filters.
///
/// Objects are opaque handles, each freed by its own function. A function that can fail returns a status; after a
/// failure `zoneplate_error_text` is one line that describes it, and results are not written. No exception
/// leaves a function. Structs begin with their size, so that a later version of the library can append members;
/// a member that is 0 or null has its default:
///
///     zoneplate_render_options options = {.size = sizeof options, .width = 640, .height = 480, .method = "smaa"};
///
/// Several threads may use one scene or image at the same time, except for the functions that change or free it.

#include <stddef.h>
#include <stdint.h>

/// A scene. It is built by the functions `zoneplate_scene_...`; the first rendering completes it, after which the
/// functions that change it fail.
typedef struct zoneplate_scene zoneplate_scene;
/// The results of a function: arrays with names.
typedef struct zoneplate_image zoneplate_image;
/// The description of a rendering by the options of the command `render`.
typedef struct zoneplate_job zoneplate_job;
/// The frames of a sequence, which are rendered one after the other.
typedef struct zoneplate_frames zoneplate_frames;

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/// The version of this interface. It changes when a function or the meaning of a member changes, not when something is
/// added.
#define ZONEPLATE_ABI_VERSION 1

/// ZONEPLATE_ABI_VERSION of the library, which may differ from that of the header.
uint32_t zoneplate_abi_version(void);
/// The version of the library, such as "0.2.0".
const char* zoneplate_version(void);

/// The result of a function. The first five are the exit codes of the command.
typedef enum zoneplate_status {
  ZONEPLATE_OK = 0,             ///< success
  ZONEPLATE_FAILED = 1,         ///< rendering or another run-time failure
  ZONEPLATE_USAGE = 2,          ///< a wrong argument or combination of arguments
  ZONEPLATE_INPUT = 3,          ///< an input that is missing, corrupt or unsupported
  ZONEPLATE_OUTPUT = 4,         ///< an output that cannot be written
  ZONEPLATE_OUT_OF_MEMORY = 5,  ///< not enough memory
} zoneplate_status;

/// One line about the last failure on the calling thread; valid until the next failure on that thread.
const char* zoneplate_error_text(void);

/// The type of the values of an array.
typedef enum zoneplate_type {
  ZONEPLATE_UINT8 = 0,    ///< uint8_t
  ZONEPLATE_UINT16 = 1,   ///< uint16_t
  ZONEPLATE_UINT32 = 2,   ///< uint32_t
  ZONEPLATE_INT32 = 3,    ///< int32_t
  ZONEPLATE_INT64 = 4,    ///< int64_t
  ZONEPLATE_FLOAT32 = 5,  ///< float
  ZONEPLATE_FLOAT64 = 6,  ///< double
} zoneplate_type;

/// A view of an array of one to three dimensions. Images have the dimensions height, width and, for several channels,
/// channels; rows begin at the top.
typedef struct zoneplate_array {
  void* data;           ///< the first element; an input is only read; null: no array
  zoneplate_type type;  ///< of the elements
  int32_t dimensions;   ///< 1 to 3
  int64_t shape[3];     ///< elements along each dimension
  int64_t strides[3];   ///< bytes from an element to the next one of each dimension
} zoneplate_array;

/// Options of loading a scene.
typedef struct zoneplate_load_options {
  size_t size;                 ///< sizeof(zoneplate_load_options)
  const char* format;          ///< an extension without its dot, "stl"; null: that of the name
  const char* variant;         ///< a material variant of a glTF file
  const int32_t* scene;        ///< index of a scene of a glTF file; null: the file's default scene
  const int32_t* animation;    ///< index of an animation of a glTF file, -1: all; null: not animated
  double time;                 ///< of the animation, in seconds
  int32_t is_sandboxed;        ///< 1: the file is read in a child process with limits
  uint64_t max_memory;         ///< bytes of decoded data; 0: 4 GiB
  double max_seconds;          ///< of reading; 0: 60
  const char* animation_name;  ///< name of an animation, in place of `animation`; null: none
} zoneplate_load_options;

/// Loads a file by its extension, or makes the built-in scene of that name: "chair.glb", "teapot". `options` may be
/// null.
zoneplate_status zoneplate_scene_load(const char* name, const zoneplate_load_options* options, zoneplate_scene** scene);
/// Makes an empty scene.
zoneplate_status zoneplate_scene_new(zoneplate_scene** scene);
/// Frees a scene; null is allowed.
void zoneplate_scene_free(zoneplate_scene* scene);

/// Adds an image for textures: uint8 or uint16 codes, or float32 linear light, of 1 (grey), 3 or 4 channels. `index`
/// gets its index; null is allowed.
zoneplate_status zoneplate_scene_add_image(zoneplate_scene* scene, const zoneplate_array* pixels, int32_t* index);

/// The reflection model of a material.
typedef enum zoneplate_model {
  ZONEPLATE_METALLIC_ROUGHNESS = 0,  ///< that of glTF 2.0
  ZONEPLATE_BLINN_PHONG = 1,         ///< a specular lobe about the half vector
  ZONEPLATE_PHONG = 2,               ///< a specular lobe about the mirrored direction
  ZONEPLATE_UNLIT = 3,               ///< the base colour, without lights
} zoneplate_model;

/// The meaning of the alpha of a base colour.
typedef enum zoneplate_alpha_mode {
  ZONEPLATE_OPAQUE = 0,  ///< none
  ZONEPLATE_MASK = 1,    ///< the surface is present where alpha is at least the cutoff
  ZONEPLATE_BLEND = 2,   ///< the surface is composited over what is behind it
} zoneplate_alpha_mode;

/// The parameters of a surface. Factors are linear. Textures are indices of images: null: none.
typedef struct zoneplate_material {
  size_t size;                                ///< sizeof(zoneplate_material)
  const char* name;                           ///< need not be unique
  zoneplate_model model;                      ///< ZONEPLATE_METALLIC_ROUGHNESS by default
  zoneplate_alpha_mode alpha_mode;            ///< ZONEPLATE_OPAQUE by default
  const float* alpha_cutoff;                  ///< null: 0.5
  int32_t is_double_sided;                    ///< 1: back faces are drawn too
  const float* base_color;                    ///< red, green, blue, straight alpha; null: white
  const float* emissive;                      ///< red, green, blue; null: black
  const float* metallic;                      ///< null: 0, unless there is a texture of it
  const float* roughness;                     ///< null: 0.5, with a texture of it 1
  const float* specular;                      ///< red, green, blue of (Blinn-)Phong's specular term; null: black
  const float* exponent;                      ///< of (Blinn-)Phong's specular term; null: 32
  const int32_t* base_color_texture;          ///< sRGB-encoded
  const int32_t* metallic_roughness_texture;  ///< green: roughness, blue: metallic
  const int32_t* normal_texture;              ///< in tangent space
  const int32_t* occlusion_texture;           ///< red
  const int32_t* emissive_texture;            ///< sRGB-encoded; multiplies `emissive`
} zoneplate_material;

/// Adds a material.
zoneplate_status zoneplate_scene_add_material(zoneplate_scene* scene, const zoneplate_material* material,
                                              int32_t* index);

/// What the indices of a mesh form.
typedef enum zoneplate_topology {
  ZONEPLATE_TRIANGLES = 0,  ///< three indices each; front faces are counter-clockwise
  ZONEPLATE_LINES = 1,      ///< two indices each
  ZONEPLATE_POINTS = 2,     ///< one index each
} zoneplate_topology;

/// The arrays of a mesh, which the scene copies. Values of other types than the scene's are converted.
typedef struct zoneplate_mesh {
  size_t size;                  ///< sizeof(zoneplate_mesh)
  const char* name;             ///< need not be unique
  zoneplate_topology topology;  ///< ZONEPLATE_TRIANGLES by default
  zoneplate_array positions;    ///< n × 3, object space, +y up
  zoneplate_array normals;  ///< n × 3, normalized by the function; none: smooth across edges that bend by less than 50°
  zoneplate_array uvs;      ///< n × 2; (0, 0) is the top-left of the image
  zoneplate_array colors;    ///< n × 3 or n × 4: floats are linear, uint8 are sRGB codes
  zoneplate_array indices;   ///< m × 3 (lines: m × 2, points: m), or one dimension; none: 0, 1, 2, ...
  int32_t material;          ///< an index; a scene without materials gets the grey one of STL files
  int32_t has_flat_normals;  ///< 1: without `normals`, each triangle gets its own
} zoneplate_mesh;

/// Adds a mesh. It is drawn where instances place it.
zoneplate_status zoneplate_scene_add_mesh(zoneplate_scene* scene, const zoneplate_mesh* mesh, int32_t* index);

/// Adds an instance of a mesh as an object of its own. `world_from_object`: 16 numbers row by row, affine, acting on
/// column vectors; null: the identity. `name` may be null. `index` gets the object's index, which is its value in the
/// array "object-id".
///
/// If the first instance lies farther from the origin than 64 times its size, as in the coordinates of surveys, the
/// scene is rendered around it: positions and transforms of doubles, and cameras, lose nothing to floats.
zoneplate_status zoneplate_scene_add_instance(zoneplate_scene* scene, int32_t mesh, const double* world_from_object,
                                              const char* name, int32_t* index);

/// The kind of a light.
typedef enum zoneplate_light_kind {
  ZONEPLATE_DIRECTIONAL = 0,  ///< parallel light along a direction
  ZONEPLATE_POINT = 1,        ///< from a position, equal in all directions
  ZONEPLATE_SPOT = 2,         ///< from a position within a cone
} zoneplate_light_kind;

/// A light.
typedef struct zoneplate_light {
  size_t size;                 ///< sizeof(zoneplate_light)
  zoneplate_light_kind kind;   ///< ZONEPLATE_DIRECTIONAL by default
  const float* color;          ///< linear red, green, blue; null: white
  const float* intensity;      ///< lux (directional) or candela; null: 1
  const double* position;      ///< of point and spot lights
  const float* direction;      ///< from the light; null: (0, 0, -1)
  const float* range;          ///< where the light ends; null: nowhere
  float inner_cone;            ///< of spot lights, radians: full intensity up to this angle
  const float* outer_cone;     ///< of spot lights, radians: no light beyond this angle; null: π / 4
  float radius;                ///< for soft shadows: of the sphere or, in radians, of the disc in the sky
  int32_t is_in_camera_space;  ///< 1: position and direction are in the space of the rendering camera
} zoneplate_light;

/// Adds a light. A scene without lights and environment gets the default light.
zoneplate_status zoneplate_scene_add_light(zoneplate_scene* scene, const zoneplate_light* light);
/// Sets the light from all directions: `color` (linear red, green, blue) times the image of that index,
/// equirectangular; -1: no image. `rotation` in radians, counter-clockwise as seen from above.
zoneplate_status zoneplate_scene_set_environment(zoneplate_scene* scene, const float* color, int32_t image,
                                                 float rotation);
/// Sets the upward axis of the scene, +y by default.
zoneplate_status zoneplate_scene_set_up(zoneplate_scene* scene, const float* up);

/// The parts of a scene that are counted and have names.
typedef enum zoneplate_part {
  ZONEPLATE_OBJECTS = 0,     ///< the values of the array "object-id"
  ZONEPLATE_MATERIALS = 1,   ///< the values of the array "material-id"
  ZONEPLATE_MESHES = 2,      ///< as of zoneplate_scene_add_mesh
  ZONEPLATE_INSTANCES = 3,   ///< their names are those of their objects
  ZONEPLATE_LIGHTS = 4,      ///< without default lights
  ZONEPLATE_CAMERAS = 5,     ///< of the file
  ZONEPLATE_ANIMATIONS = 6,  ///< of the file
  ZONEPLATE_VARIANTS = 7,    ///< of the file
  ZONEPLATE_WARNINGS = 8,    ///< what the loader ignored; the names are the warnings
} zoneplate_part;

/// The number of parts of a kind.
zoneplate_status zoneplate_scene_count(const zoneplate_scene* scene, zoneplate_part part, int64_t* count);
/// The name of a part, valid until the scene is changed or freed.
zoneplate_status zoneplate_scene_name(const zoneplate_scene* scene, zoneplate_part part, int64_t index,
                                      const char** name);
/// The bounds of all instances in world space. Fails for a scene in which nothing is drawn.
zoneplate_status zoneplate_scene_bounds(const zoneplate_scene* scene, double minimum[3], double maximum[3]);

/// A camera. It looks along its own -z with +y up.
typedef struct zoneplate_camera {
  size_t size;                   ///< sizeof(zoneplate_camera)
  double world_from_camera[16];  ///< row by row, rigid, acting on column vectors
  int32_t is_orthographic;       ///< 1: `half_height` sets the scale, otherwise `vertical_fov`
  double vertical_fov;           ///< radians
  double half_height;            ///< half the image's height, world units
  double near, far;              ///< distances along the view axis
  /// Instead of `vertical_fov` OpenCV's camera matrix, in pixels of the image that is rendered: fx, fy, cx and cy,
  /// where (0, 0) is the centre of the top-left pixel. fx = 0: none.
  double intrinsics[4];
  double distortion[8];  ///< with `intrinsics`, OpenCV's order: k1, k2, p1, p2, k3, k4, k5, k6
} zoneplate_camera;

/// The choice of a camera; angles in radians. Members that are null have no effect.
typedef struct zoneplate_view {
  size_t size;                ///< sizeof(zoneplate_view)
  const int32_t* index;       ///< a camera of the file; null: a view of the whole scene
  const double* position;     ///< of the eye, three numbers in world space
  const double* focal_point;  ///< where the camera looks, three numbers
  const float* view_up;       ///< upwards in the image, three numbers
  const float* vertical_fov;  ///< field of view
  const float* azimuth;       ///< of the view of the whole scene from the front to the right, or a turn; null: 30°
  const float* elevation;     ///< the same above the horizon; null: 20°
  int32_t is_orthographic;    ///< 1: a parallel projection
} zoneplate_view;

/// The camera of a view for an image of the aspect width / height. `view` may be null: the default view.
zoneplate_status zoneplate_scene_camera(const zoneplate_scene* scene, const zoneplate_view* view, double aspect,
                                        zoneplate_camera* camera);

/// The values of the array "color".
typedef enum zoneplate_form {
  ZONEPLATE_SRGB8 = 0,   ///< uint8 codes, straight alpha
  ZONEPLATE_SRGB16 = 1,  ///< uint16 codes, straight alpha
  ZONEPLATE_LINEAR = 2,  ///< float32 linear light before tone mapping, premultiplied alpha
} zoneplate_form;

/// The shadows of lights.
typedef enum zoneplate_shadows {
  ZONEPLATE_NO_SHADOWS = 0,    ///< every light reaches every surface
  ZONEPLATE_SHADOW_MAPS = 1,   ///< depth images from the lights
  ZONEPLATE_HARD_SHADOWS = 2,  ///< one ray to each light
  ZONEPLATE_SOFT_SHADOWS = 3,  ///< 32 rays to each light
} zoneplate_shadows;

/// How an image is rendered.
typedef struct zoneplate_render_options {
  size_t size;          ///< sizeof(zoneplate_render_options)
  int32_t width;        ///< pixels; 0: 800
  int32_t height;       ///< pixels; 0: 600
  const char* method;   ///< antialiasing, as "ssaa:n=4" or "smaa"; null: "msaa:n=8,alpha=samples"
  const char* passes;   ///< data passes separated by commas, as "depth,normal"; null: none
  zoneplate_form form;  ///< ZONEPLATE_SRGB8 by default
  int32_t crop[4];      ///< x, y, width, height; width 0: the whole image
  int32_t threads;      ///< 0: as many as affinity and quota allow
  /// "none", "aces", "neutral", "agx" or "filmic"; null: "neutral" in the studio that a scene without lights gets, else
  /// "none".
  const char* tone_mapping;
  float exposure;           ///< stops
  const float* background;  ///< sRGB red, green, blue and straight alpha in [0, 1]; null: dark grey
  int32_t is_transparent;   ///< 1: no background, the image keeps its alpha
  /// Factor of every light; null: 1, and lights that would clip a quarter of the surfaces to white are dimmed, unless
  /// an environment or an exposure is given or the form is linear.
  const float* light_intensity;
  const float* environment;   ///< linear red, green, blue: replaces the scene's environment and the default light
  zoneplate_shadows shadows;  ///< ZONEPLATE_NO_SHADOWS by default
  int32_t occlusion_samples;  ///< rays of ambient occlusion; 0: none
  int32_t has_shadow_ground;  ///< 1: a ground that is visible only where light is missing
  int32_t anisotropy;         ///< most probes of texture filters; 0: 4, or the own value of a built-in scene
  int32_t keeps_back_faces;   ///< 1: back faces of single-sided materials are drawn
  /// Pixels along a side of the squares of points; 0: the size with which all points would cover a sixteenth of the
  /// image, from 1 to a hundredth of its height.
  float point_size;
} zoneplate_render_options;

/// Renders an image with the arrays "color" and those of the data passes. `camera` null: the default view, as of
/// the command. `options` may be null.
///
/// Arrays of data passes: "depth" (distance along the view axis, infinite in empty pixels), "normal", "position" (in
/// floats, which are multiples of 0.5 at 5,000,000), "albedo", "uv", "coverage", "mip-level", "anisotropy" and "error"
/// are float32; "object-id", "material-id" and "primitive-id" are uint32, 0xffffffff in empty pixels; "crypto-object"
/// and "crypto-material" are the arrays "CryptoObject00", "CryptoObject01", ... of their ranks.
zoneplate_status zoneplate_render(zoneplate_scene* scene, const zoneplate_camera* camera,
                                  const zoneplate_render_options* options, zoneplate_image** image);

/// Makes a job, in which every option has its default. One thread at a time uses a job.
zoneplate_status zoneplate_job_new(zoneplate_job** job);
/// Sets an option by the name that the command `render` gives it, without dashes, and a text as on the command line:
/// "shadows", "soft:samples=64". `value` is null for switches such as "no-background". Angles are in degrees. The last
/// value of an option counts; "quality" sets several options, which those that are set after it change.
///
/// In addition to those of the command, the switch "sandbox" reads models in a child process with limits. Options of
/// files, batches and reports are the command's alone.
zoneplate_status zoneplate_job_set(zoneplate_job* job, const char* option, const char* value);
/// Frees a job; null is allowed.
void zoneplate_job_free(zoneplate_job* job);

/// Loads a file, or makes the built-in scene of that name, by the job's options of reading, such as "format", "variant"
/// or "animation-time".
zoneplate_status zoneplate_job_load(const zoneplate_job* job, const char* name, zoneplate_scene** scene);
/// Renders a still image: the arrays "color", in this form, and those of the data passes of the option "aov". `camera`
/// takes the place of the job's view, if it is not null.
///
/// Options of materials, such as "color" or "mip-filter", and of reading change the model: if the scene was loaded by
/// others, its file is read anew. A scene that was made from arrays takes those of materials until it is rendered.
zoneplate_status zoneplate_job_render(zoneplate_job* job, zoneplate_scene* scene, const zoneplate_camera* camera,
                                      zoneplate_form form, zoneplate_image** image);
/// Renders the scene and writes the files that the command writes for this output, with the same bytes: an image with
/// its data passes, numbered frames as "chair.####.png", or a film such as "chair.webp" or "chair.mp4" (by ffmpeg).
zoneplate_status zoneplate_job_save(zoneplate_job* job, zoneplate_scene* scene, const char* output);

/// Begins the sequence of the job's options "turntable", "frames", "frame-start" and "frame-end". A model of a file is
/// read anew for each moment of its animation. The job may be changed or freed afterwards, the scene may be freed.
zoneplate_status zoneplate_job_frames(zoneplate_job* job, zoneplate_scene* scene, zoneplate_form form,
                                      zoneplate_frames** frames);
/// The number of frames of a sequence; 0 for null.
size_t zoneplate_frames_count(const zoneplate_frames* frames);
/// Renders the next frame, as zoneplate_job_render does. `number` is that of the command's file names; null is allowed.
/// After the last frame `image` is null.
zoneplate_status zoneplate_frames_next(zoneplate_frames* frames, int32_t* number, zoneplate_image** image);
/// Frees a sequence; null is allowed.
void zoneplate_frames_free(zoneplate_frames* frames);

/// What the value of an option is.
typedef enum zoneplate_option_kind {
  ZONEPLATE_SWITCH = 0,  ///< none
  ZONEPLATE_NUMBER = 1,  ///< a number in a range
  ZONEPLATE_WHOLE = 2,   ///< a whole number in a range
  ZONEPLATE_CHOICE = 3,  ///< one of several names
  ZONEPLATE_TEXT = 4,    ///< other text
} zoneplate_option_kind;

/// An option of jobs. Texts stay valid.
typedef struct zoneplate_option {
  size_t size;                 ///< sizeof(zoneplate_option), set by the caller
  const char* name;            ///< as of zoneplate_job_set
  const char* value;           ///< the form of the value, or its unit: "X,Y,Z", "DEG"; empty for a switch
  zoneplate_option_kind kind;  ///< what the value is
  double low, high;            ///< the range of numbers
  const char* choices;         ///< names that the value may be or begin with, separated by commas
  const char* group;           ///< "Camera"
  const char* summary;         ///< one sentence, with the default
  const char* names;           ///< all that the command takes, separated by commas: "--resolution,--size"
} zoneplate_option;

/// The option of this index, from 0; ZONEPLATE_USAGE past the last one.
zoneplate_status zoneplate_job_option(size_t index, zoneplate_option* option);

/// The number of arrays.
size_t zoneplate_image_count(const zoneplate_image* image);
/// The name of an array; null for an index that is out of range.
const char* zoneplate_image_name(const zoneplate_image* image, size_t index);
/// An array by its name: a view, valid until the image is freed.
zoneplate_status zoneplate_image_array(const zoneplate_image* image, const char* name, zoneplate_array* array);
/// Encodes "color" as a file: "png", and of 8 bits "jpg", "webp", "avif" or "jxl" (lossless; their libraries are
/// opened), for linear light "exr" or "pfm". `bytes` is the array "bytes" of a new image.
zoneplate_status zoneplate_image_encode(const zoneplate_image* image, const char* format, zoneplate_image** bytes);
/// Saves "color" by the path's extension; the file is written whole or not at all.
zoneplate_status zoneplate_image_save(const zoneplate_image* image, const char* path);
/// Frees an image; null is allowed.
void zoneplate_image_free(zoneplate_image* image);

/// Makes an image whose array "color" is a copy of the pixels: uint8 or uint16 sRGB codes, or float32 linear light, of
/// 1 (grey), 3 or 4 channels.
zoneplate_status zoneplate_image_new(const zoneplate_array* pixels, zoneplate_image** image);
/// Reads a PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, BMP, TGA, HDR, EXR or PFM file, of an animation the first frame;
/// the floats of the last three and of TIFF as they are stored, with NaN and infinities. Codes of another colour
/// profile are converted to sRGB, light of other primaries to Rec.709; a damaged profile is ignored. The image is
/// turned as its Exif orientation says.
zoneplate_status zoneplate_image_load(const char* path, zoneplate_image** image);

/// Measures the difference of two images by a metric, as "psnr" or "flip:ppd=30". Integers are sRGB codes, floats
/// linear light; NaN and infinities are an error. Images with alpha are measured over black and over white, and the
/// worse value counts. `map` gets the array "map" with the error of each pixel, if the metric has one; null is allowed.
/// `figures` gets the metric's other values as arrays of one number; null is allowed.
zoneplate_status zoneplate_measure(const zoneplate_array* reference, const zoneplate_array* test, const char* metric,
                                   double* value, zoneplate_image** map, zoneplate_image** figures);

/// Antialiases an image by a filter such as "smaa" or "fxaa:preset=39"; "color" of the result has the type of `pixels`
/// (uint8 or uint16) and four channels.
zoneplate_status zoneplate_filter(const zoneplate_array* pixels, const char* method, zoneplate_image** image);

/// Resamples an image to another size with a kernel such as "lanczos3". Integers are filtered in linear light and
/// encoded again as uint8; a float32 array of any number of channels keeps its type.
zoneplate_status zoneplate_resample(const zoneplate_array* pixels, int32_t width, int32_t height, const char* kernel,
                                    zoneplate_image** image);
/// Filters the frequencies of a float32 array. `pass`: "low", "high", "band" or "stop" with the cut-off frequencies
/// `low` and `high` in cycles per pixel; `shape`: "ideal", "gaussian" or "butterworth:order=2". The image is one
/// period.
zoneplate_status zoneplate_frequency_filter(const zoneplate_array* pixels, const char* pass, double low, double high,
                                            const char* shape, zoneplate_image** image);
/// The spectrum of a float32 plane: the arrays "magnitude" (log, in [0, 1] over 120 dB) and "phase" (radians), with
/// frequency 0 in the middle; "power" by radial frequency and "frequency", the middle of each of its rings, in cycles
/// per pixel (float64).
zoneplate_status zoneplate_spectrum(const zoneplate_array* plane, zoneplate_image** spectrum);

/// A catalogue of names.
typedef enum zoneplate_catalogue {
  ZONEPLATE_METHODS = 0,  ///< antialiasing methods
  ZONEPLATE_METRICS = 1,  ///< image metrics
  ZONEPLATE_SCENES = 2,   ///< built-in scenes
  ZONEPLATE_PASSES = 3,   ///< data passes
  ZONEPLATE_KERNELS = 4,  ///< resampling kernels
} zoneplate_catalogue;

/// The name and a one-line summary of entry `index`; ZONEPLATE_USAGE past the last one. Both stay valid.
zoneplate_status zoneplate_list(zoneplate_catalogue catalogue, size_t index, const char** name, const char** summary);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
