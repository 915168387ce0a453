// SPDX-License-Identifier: Apache-2.0
#include <GL/glcorearb.h>
#include <dlfcn.h>

#include <vector>

#include "peer.h"
#include "uploads.h"
#include "zoneplate/base/error.h"

namespace zoneplate::peers {
namespace {

[[noreturn]] void fail(const std::string& what) { throw Error(ErrorKind::Failed, "Mesa: " + what); }

/// The library and its functions by name.
class Library {
 public:
  Library() : handle_(::dlopen("libOSMesa.so.8", RTLD_NOW | RTLD_GLOBAL)) {
    if (!handle_) fail("libOSMesa.so.8 is not there; apt-get install libosmesa6");
    address_ = own<void* (*)(const char*)>("OSMesaGetProcAddress");
  }
  template <class F>
  F own(const char* name) const {
    void* found = ::dlsym(handle_, name);
    if (!found) fail(std::string(name) + " is missing");
    return reinterpret_cast<F>(found);
  }
  template <class F>
  void find(F& function, const char* name) const {
    function = reinterpret_cast<F>(address_(name));
    if (!function) fail(std::string(name) + " is missing");
  }

 private:
  void* handle_;
  void* (*address_)(const char*) = nullptr;
};

/// The functions of OpenGL that a frame needs.
struct OpenGl {
  PFNGLGETSTRINGPROC GetString;
  PFNGLGETERRORPROC GetError;
  PFNGLGENFRAMEBUFFERSPROC GenFramebuffers;
  PFNGLBINDFRAMEBUFFERPROC BindFramebuffer;
  PFNGLGENRENDERBUFFERSPROC GenRenderbuffers;
  PFNGLBINDRENDERBUFFERPROC BindRenderbuffer;
  PFNGLRENDERBUFFERSTORAGEMULTISAMPLEPROC RenderbufferStorageMultisample;
  PFNGLFRAMEBUFFERRENDERBUFFERPROC FramebufferRenderbuffer;
  PFNGLCHECKFRAMEBUFFERSTATUSPROC CheckFramebufferStatus;
  PFNGLBLITFRAMEBUFFERPROC BlitFramebuffer;
  PFNGLVIEWPORTPROC Viewport;
  PFNGLCLEARCOLORPROC ClearColor;
  PFNGLCLEARPROC Clear;
  PFNGLENABLEPROC Enable;
  PFNGLBLENDFUNCPROC BlendFunc;
  PFNGLGENVERTEXARRAYSPROC GenVertexArrays;
  PFNGLBINDVERTEXARRAYPROC BindVertexArray;
  PFNGLGENBUFFERSPROC GenBuffers;
  PFNGLBINDBUFFERPROC BindBuffer;
  PFNGLBUFFERDATAPROC BufferData;
  PFNGLENABLEVERTEXATTRIBARRAYPROC EnableVertexAttribArray;
  PFNGLVERTEXATTRIBPOINTERPROC VertexAttribPointer;
  PFNGLGENTEXTURESPROC GenTextures;
  PFNGLBINDTEXTUREPROC BindTexture;
  PFNGLTEXIMAGE2DPROC TexImage2D;
  PFNGLTEXPARAMETERIPROC TexParameteri;
  PFNGLTEXPARAMETERFPROC TexParameterf;
  PFNGLCREATESHADERPROC CreateShader;
  PFNGLSHADERSOURCEPROC ShaderSource;
  PFNGLCOMPILESHADERPROC CompileShader;
  PFNGLGETSHADERIVPROC GetShaderiv;
  PFNGLCREATEPROGRAMPROC CreateProgram;
  PFNGLATTACHSHADERPROC AttachShader;
  PFNGLLINKPROGRAMPROC LinkProgram;
  PFNGLUSEPROGRAMPROC UseProgram;
  PFNGLGETUNIFORMLOCATIONPROC GetUniformLocation;
  PFNGLUNIFORMMATRIX4FVPROC UniformMatrix4fv;
  PFNGLUNIFORM4FPROC Uniform4f;
  PFNGLDRAWELEMENTSPROC DrawElements;
  PFNGLREADPIXELSPROC ReadPixels;

  explicit OpenGl(const Library& from) {
    from.find(GetString, "glGetString");
    from.find(GetError, "glGetError");
    from.find(GenFramebuffers, "glGenFramebuffers");
    from.find(BindFramebuffer, "glBindFramebuffer");
    from.find(GenRenderbuffers, "glGenRenderbuffers");
    from.find(BindRenderbuffer, "glBindRenderbuffer");
    from.find(RenderbufferStorageMultisample, "glRenderbufferStorageMultisample");
    from.find(FramebufferRenderbuffer, "glFramebufferRenderbuffer");
    from.find(CheckFramebufferStatus, "glCheckFramebufferStatus");
    from.find(BlitFramebuffer, "glBlitFramebuffer");
    from.find(Viewport, "glViewport");
    from.find(ClearColor, "glClearColor");
    from.find(Clear, "glClear");
    from.find(Enable, "glEnable");
    from.find(BlendFunc, "glBlendFunc");
    from.find(GenVertexArrays, "glGenVertexArrays");
    from.find(BindVertexArray, "glBindVertexArray");
    from.find(GenBuffers, "glGenBuffers");
    from.find(BindBuffer, "glBindBuffer");
    from.find(BufferData, "glBufferData");
    from.find(EnableVertexAttribArray, "glEnableVertexAttribArray");
    from.find(VertexAttribPointer, "glVertexAttribPointer");
    from.find(GenTextures, "glGenTextures");
    from.find(BindTexture, "glBindTexture");
    from.find(TexImage2D, "glTexImage2D");
    from.find(TexParameteri, "glTexParameteri");
    from.find(TexParameterf, "glTexParameterf");
    from.find(CreateShader, "glCreateShader");
    from.find(ShaderSource, "glShaderSource");
    from.find(CompileShader, "glCompileShader");
    from.find(GetShaderiv, "glGetShaderiv");
    from.find(CreateProgram, "glCreateProgram");
    from.find(AttachShader, "glAttachShader");
    from.find(LinkProgram, "glLinkProgram");
    from.find(UseProgram, "glUseProgram");
    from.find(GetUniformLocation, "glGetUniformLocation");
    from.find(UniformMatrix4fv, "glUniformMatrix4fv");
    from.find(Uniform4f, "glUniform4f");
    from.find(DrawElements, "glDrawElements");
    from.find(ReadPixels, "glReadPixels");
  }
};

constexpr const char* vertex_text = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
uniform mat4 clip_from_world;
#ifdef LIT
out vec3 at, across;
#endif
#ifdef TEXTURED
out vec2 place;
#endif
void main() {
#ifdef LIT
  at = position;
  across = normal;
#endif
#ifdef TEXTURED
  place = uv;
#endif
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)";

// look: ambient, specular, exponent.
constexpr const char* fragment_text = R"(
#ifdef LIT
in vec3 at, across;
#endif
#ifdef TEXTURED
in vec2 place;
uniform sampler2D image;
#endif
uniform vec4 base, eye, light, look;
layout(location = 0) out vec4 color;
void main() {
  vec4 surface = base;
#ifdef TEXTURED
  surface = texture(image, place);
#endif
#ifdef LIT
  vec3 n = normalize(across), v = normalize(eye.xyz - at), h = normalize(light.xyz + v);
  float diffuse = max(dot(n, light.xyz), 0.0), gloss = pow(max(dot(n, h), 0.0), look.z);
  color = vec4(surface.rgb * (look.x + diffuse) + vec3(look.y * gloss), 1.0);
#else
  color = surface;
#endif
}
)";

class Llvmpipe : public Peer {
 public:
  Llvmpipe(const Scene& scene, const Work& requested) : work(requested) {
    version_ = std::string("OpenGL ") + reinterpret_cast<const char*>(gl.GetString(GL_VERSION));
    pixels.resize(static_cast<std::size_t>(work.width) * static_cast<std::size_t>(work.height) * 4);
    make_framebuffers();
    upload(scene.meshes.at(0));
    make_program(scene);
    const Material& material = scene.materials.at(0);
    if (is_textured(scene)) upload(scene.images.at(0).pixels.as<Rgba8>());
    gl.Enable(GL_DEPTH_TEST);
    if (!material.double_sided) gl.Enable(GL_CULL_FACE);
    if (material.alpha_mode == AlphaMode::Blend) {
      gl.Enable(GL_BLEND);
      gl.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
    gl.Viewport(0, 0, work.width, work.height);
    gl.ClearColor(work.background.x, work.background.y, work.background.z, 1);
    if (const GLenum error = gl.GetError()) fail("error " + std::to_string(error));
  }
  ~Llvmpipe() override { destroy(context); }
  Llvmpipe(const Llvmpipe&) = delete;
  Llvmpipe& operator=(const Llvmpipe&) = delete;

  void frame() override {
    gl.BindFramebuffer(GL_FRAMEBUFFER, drawn);
    gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl.DrawElements(GL_TRIANGLES, indices, GL_UNSIGNED_INT, nullptr);
    if (work.samples > 1) {
      gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved);
      gl.BlitFramebuffer(0, 0, work.width, work.height, 0, 0, work.width, work.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
      gl.BindFramebuffer(GL_FRAMEBUFFER, resolved);
    }
    gl.ReadPixels(0, 0, work.width, work.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  }
  Rgba8Image picture() const override {
    Rgba8Image out(work.width, work.height);
    const auto stride = static_cast<std::size_t>(out.width()) * 4;
    for (int y = 0; y < out.height(); ++y) {
      const std::uint8_t* row = pixels.data() + static_cast<std::size_t>(out.height() - 1 - y) * stride;
      for (std::size_t x = 0; x < static_cast<std::size_t>(out.width()); ++x)
        out(static_cast<int>(x), y) = {row[4 * x], row[4 * x + 1], row[4 * x + 2], row[4 * x + 3]};
    }
    return out;
  }
  const std::string& version() const override { return version_; }

 private:
  Work work;
  std::vector<std::uint8_t> target = std::vector<std::uint8_t>(16 * 16 * 4);  // of the context; nothing is drawn there
  Library library;
  void (*destroy)(void*) = nullptr;
  void* context = make_context();
  OpenGl gl{library};
  std::string version_;
  GLuint drawn = 0, resolved = 0;
  GLsizei indices = 0;
  std::vector<std::uint8_t> pixels;

  void* make_context() {
    // From the interface of OSMesa: format, depth bits, profile, version.
    constexpr int attributes[] = {0x22, 0x1908, 0x30, 0, 0x33, 0x34, 0x36, 3, 0x37, 3, 0, 0};
    const auto create = library.own<void* (*)(const int*, void*)>("OSMesaCreateContextAttribs");
    const auto use = library.own<GLboolean (*)(void*, void*, GLenum, GLsizei, GLsizei)>("OSMesaMakeCurrent");
    destroy = library.own<void (*)(void*)>("OSMesaDestroyContext");
    void* made = create(attributes, nullptr);
    if (!made || !use(made, target.data(), GL_UNSIGNED_BYTE, 16, 16)) fail("no context");
    return made;
  }

  void attach(GLenum format, GLenum place, int samples) {
    GLuint buffer = 0;
    gl.GenRenderbuffers(1, &buffer);
    gl.BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? samples : 0, format, work.width, work.height);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
  }

  void make_framebuffers() {
    gl.GenFramebuffers(1, &drawn);
    gl.BindFramebuffer(GL_FRAMEBUFFER, drawn);
    attach(GL_RGBA8, GL_COLOR_ATTACHMENT0, work.samples);
    attach(GL_DEPTH_COMPONENT32F, GL_DEPTH_ATTACHMENT, work.samples);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) fail("these samples cannot be had");
    if (work.samples == 1) return;
    gl.GenFramebuffers(1, &resolved);
    gl.BindFramebuffer(GL_FRAMEBUFFER, resolved);
    attach(GL_RGBA8, GL_COLOR_ATTACHMENT0, 1);
  }

  void upload(const Mesh& mesh) {
    const std::vector<float> vertices = interleaved_vertices(mesh);
    indices = static_cast<GLsizei>(mesh.index.size());
    GLuint array = 0, buffers[2] = {};
    gl.GenVertexArrays(1, &array);
    gl.BindVertexArray(array);
    gl.GenBuffers(2, buffers);
    gl.BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
    gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * 4), vertices.data(), GL_STATIC_DRAW);
    gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
    gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr{indices} * 4, mesh.index.data(), GL_STATIC_DRAW);
    constexpr GLint size[] = {3, 3, 2};
    constexpr std::size_t offset[] = {0, 12, 24};
    for (GLuint i = 0; i < 3; ++i) {
      gl.EnableVertexAttribArray(i);
      gl.VertexAttribPointer(i, size[i], GL_FLOAT, GL_FALSE, 32, reinterpret_cast<const void*>(offset[i]));
    }
  }

  void upload(const Rgba8Image& image) {
    GLuint texture = 0;
    gl.GenTextures(1, &texture);
    gl.BindTexture(GL_TEXTURE_2D, texture);
    GLint number = 0;
    for (const Rgba8Image& level : mip_levels(image))
      gl.TexImage2D(GL_TEXTURE_2D, number++, GL_RGBA8, level.width(), level.height(), 0, GL_RGBA, GL_UNSIGNED_BYTE,
                    level.values().data());
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    constexpr GLenum max_anisotropy = 0x84FE;
    if (work.anisotropy > 1) gl.TexParameterf(GL_TEXTURE_2D, max_anisotropy, static_cast<float>(work.anisotropy));
  }

  void compile(GLuint program, GLenum kind, const std::string& text) {
    const GLuint shader = gl.CreateShader(kind);
    const char* lines = text.c_str();
    gl.ShaderSource(shader, 1, &lines, nullptr);
    gl.CompileShader(shader);
    GLint is_well = 0;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &is_well);
    if (!is_well) fail("a shader does not compile");
    gl.AttachShader(program, shader);
  }

  void make_program(const Scene& scene) {
    std::string head = "#version 330 core\n";
    if (is_lit(scene)) head += "#define LIT\n";
    if (is_textured(scene)) head += "#define TEXTURED\n";
    const GLuint program = gl.CreateProgram();
    compile(program, GL_VERTEX_SHADER, head + vertex_text);
    compile(program, GL_FRAGMENT_SHADER, head + fragment_text);
    gl.LinkProgram(program);
    gl.UseProgram(program);

    Uniforms uniforms = uniforms_of(scene, work);
    // OpenGL's depth is -1 at the near plane.
    for (float4& column : uniforms.clip_from_world.column) column.z = 2 * column.z - column.w;
    gl.UniformMatrix4fv(gl.GetUniformLocation(program, "clip_from_world"), 1, GL_FALSE,
                        &uniforms.clip_from_world.column[0].x);
    const auto set = [&](const char* name, float4 v) {
      gl.Uniform4f(gl.GetUniformLocation(program, name), v.x, v.y, v.z, v.w);
    };
    set("base", uniforms.base);
    set("eye", uniforms.eye);
    set("light", uniforms.light);
    set("look", uniforms.look);
  }
};

}  // namespace

std::unique_ptr<Peer> make_llvmpipe(const Scene& scene, const Work& work) {
  return std::make_unique<Llvmpipe>(scene, work);
}

}  // namespace zoneplate::peers
