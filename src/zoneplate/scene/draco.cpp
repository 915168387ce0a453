#include "zoneplate/scene/draco.h"

#include <draco/compression/decode.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

std::uint64_t size_of_type(int type) { return type < 5122 ? 1 : type < 5124 ? 2 : 4; }

/// A cause of refusal; thrown in the child only.
struct Refusal {
  std::string cause;
};

/// Writes to the parent; a parent that is gone ends the child.
void send(int pipe, const void* data, std::size_t size) {
  const auto* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = ::write(pipe, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) ::_exit(1);
    at += n, size -= static_cast<std::size_t>(n);
  }
}

template <class T>
void send_values(int pipe, const draco::Mesh& mesh, const draco::PointAttribute& attribute, const DracoWish& wish) {
  std::vector<T> values(mesh.num_points() * std::size_t{wish.components});
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    const draco::AttributeValueIndex at = attribute.mapped_index(draco::PointIndex(i));
    if (at.value() >= attribute.size() || !attribute.ConvertValue<T>(at, static_cast<std::int8_t>(wish.components),
                                                                     &values[i * std::size_t{wish.components}]))
      throw Refusal{"an attribute cannot be read"};
  }
  send(pipe, values.data(), values.size() * sizeof(T));
}

void send_attribute(int pipe, const draco::Mesh& mesh, const DracoWish& wish) {
  const draco::PointAttribute* const attribute = mesh.GetAttributeByUniqueId(wish.attribute);
  if (attribute == nullptr) throw Refusal{"has no attribute " + std::to_string(wish.attribute)};
  if (mesh.num_points() != wish.count)
    throw Refusal{"has " + std::to_string(mesh.num_points()) + " vertices, its accessors say " +
                  std::to_string(wish.count)};
  switch (wish.component_type) {
    case 5120:
      return send_values<std::int8_t>(pipe, mesh, *attribute, wish);
    case 5121:
      return send_values<std::uint8_t>(pipe, mesh, *attribute, wish);
    case 5122:
      return send_values<std::int16_t>(pipe, mesh, *attribute, wish);
    case 5123:
      return send_values<std::uint16_t>(pipe, mesh, *attribute, wish);
    case 5125:
      return send_values<std::uint32_t>(pipe, mesh, *attribute, wish);
    default:
      return send_values<float>(pipe, mesh, *attribute, wish);
  }
}

void decode_and_send(int pipe, std::span<const std::uint8_t> packed, std::uint64_t index_count,
                     std::span<const DracoWish> wishes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(packed.data()), packed.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) throw Refusal{std::string("cannot be decoded: ") + decoded.status().error_msg()};
  const draco::Mesh& mesh = *decoded.value();
  if (std::uint64_t{mesh.num_faces()} * 3 != index_count)
    throw Refusal{"has " + std::to_string(mesh.num_faces()) + " faces, its accessor says " +
                  std::to_string(index_count) + " indices"};
  std::vector<std::uint32_t> indices;
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
    for (int k = 0; k < 3; ++k) indices.push_back(mesh.face(draco::FaceIndex(f))[static_cast<std::size_t>(k)].value());
  const char good = 1;
  send(pipe, &good, 1);
  send(pipe, indices.data(), indices.size() * sizeof(std::uint32_t));
  for (const DracoWish& wish : wishes) send_attribute(pipe, mesh, wish);
}

/// So much more memory than the process has now, and so much time.
void set_limits(std::uint64_t bytes, double seconds) {
  unsigned long pages = 0;
  if (std::FILE* statm = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(statm, "%lu", &pages) != 1) pages = 0;
    std::fclose(statm);
  }
  const rlim_t memory = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + bytes + (rlim_t{64} << 20);
  const rlimit address_space{memory, memory};
  ::setrlimit(RLIMIT_AS, &address_space);
  const auto time = static_cast<rlim_t>(seconds) + 1;
  const rlimit processor{time, time};
  ::setrlimit(RLIMIT_CPU, &processor);
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  ::setrlimit(RLIMIT_FSIZE, &none);
}

[[noreturn]] void be_child(int pipe, std::span<const std::uint8_t> packed, std::uint64_t index_count,
                           std::span<const DracoWish> wishes, std::uint64_t memory, double seconds) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  std::signal(SIGPIPE, SIG_IGN);
  set_limits(memory, seconds);
  std::string cause;
  try {
    decode_and_send(pipe, packed, index_count, wishes);
    ::_exit(0);
  } catch (const Refusal& refusal) {
    cause = refusal.cause;
  } catch (const std::exception&) {
    cause = "needs more memory than the limit (--max-memory)";
  }
  const char bad = 0;
  send(pipe, &bad, 1);
  send(pipe, cause.data(), cause.size());
  ::_exit(0);
}

/// The child at work: killed and waited for at the end, if it has not ended.
class Decoder {
 public:
  Decoder(std::span<const std::uint8_t> packed, std::uint64_t index_count, std::span<const DracoWish> wishes,
          const std::string& place, ImportBudget& budget)
      : place_(place), budget_(budget) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) fail(std::strerror(errno));
    id_ = ::fork();
    if (id_ == 0) {
      ::close(ends[0]);
      be_child(ends[1], packed, index_count, wishes, budget.memory_left(), budget.limits().seconds);
    }
    ::close(ends[1]);
    pipe_ = ends[0];
    if (id_ < 0) ::close(pipe_), fail(std::strerror(errno));
  }
  ~Decoder() {
    ::close(pipe_);
    ::kill(id_, SIGKILL);
    ::waitpid(id_, nullptr, 0);
  }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(Trouble::Input, place_ + ": the Draco mesh " + cause);
  }

  /// Reads as many bytes, fewer only where the child ends.
  std::size_t read(std::uint8_t* out, std::size_t size) const {
    std::size_t done = 0;
    while (done < size) {
      budget_.check_time();
      pollfd waiting{pipe_, POLLIN, 0};
      if (::poll(&waiting, 1, 50) <= 0) continue;
      const ssize_t n = ::read(pipe_, out + done, size - done);
      if (n == 0) break;
      if (n > 0) done += static_cast<std::size_t>(n);
    }
    return done;
  }

  void read_all(std::vector<std::uint8_t>& out, std::uint64_t size) const {
    budget_.take(size);
    out.resize(static_cast<std::size_t>(size));
    if (read(out.data(), out.size()) < out.size()) fail("ended its decoder");
  }

 private:
  std::string place_;
  ImportBudget& budget_;
  pid_t id_ = -1;
  int pipe_ = -1;
};

}  // namespace

DracoMesh decode_draco(std::span<const std::uint8_t> packed, std::uint64_t index_count,
                       std::span<const DracoWish> wishes, const std::string& place, ImportBudget& budget) {
  const Decoder decoder(packed, index_count, wishes, place, budget);
  std::uint8_t is_good = 0;
  if (decoder.read(&is_good, 1) == 0) decoder.fail("ended its decoder");
  if (is_good == 0) {
    std::vector<std::uint8_t> text(200);
    text.resize(decoder.read(text.data(), text.size()));
    std::string cause(text.begin(), text.end());
    for (char& c : cause)
      if (static_cast<unsigned char>(c) < ' ') c = ' ';
    decoder.fail(cause);
  }
  DracoMesh mesh;
  decoder.read_all(mesh.indices, index_count * sizeof(std::uint32_t));
  mesh.attributes.resize(wishes.size());
  for (std::size_t i = 0; i < wishes.size(); ++i)
    decoder.read_all(mesh.attributes[i],
                     wishes[i].count * wishes[i].components * size_of_type(wishes[i].component_type));
  return mesh;
}

}  // namespace zoneplate
