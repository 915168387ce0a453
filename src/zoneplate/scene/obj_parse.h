#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/base/clock.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// What a model's text says, before it becomes meshes. Indices are zero-based and checked; -1 is none.
struct ObjCorner {
  std::int32_t position = -1, uv = -1, normal = -1;
  bool operator==(const ObjCorner&) const = default;
};

enum class ObjKind : std::uint32_t { Face, Line, Point };

/// A face, a polyline or a set of points: `count` corners of its chunk from `first` on.
struct ObjElement {
  std::uint32_t first;
  std::uint32_t count : 30;
  ObjKind kind : 2;
};

/// What is said between the elements and holds for those that follow.
enum class ObjStateKind { Object, Group, Material, Smoothing, Library };
struct ObjState {
  ObjStateKind kind;
  std::uint32_t before;  ///< the element of its chunk before which it stands
  std::string text;
};

/// Things passed over; counted, with the first place of each.
enum class ObjNote { FewCorners, FreeForm, Unknown, UvNotFinite };
struct ObjTally {
  std::uint64_t count = 0, line = 0;
  std::string word;
};

/// A part of the file. The parts are cut at fixed places, so that they are the same for any number of threads.
struct ObjChunk {
  std::vector<ObjCorner> corners;
  std::vector<ObjElement> elements;
  std::vector<ObjState> states;
  std::array<ObjTally, 4> notes;  ///< by ObjNote
};

struct ObjFile {
  std::vector<float3> positions;  ///< not finite where the file says so
  std::vector<float4> colors;     ///< as long as positions, or empty; codes as in the file, white where it has none
  std::vector<float2> uvs;        ///< finite; origin at the bottom left
  std::vector<float3> normals;    ///< of unit length, or zero where the file's is zero or not finite
  std::vector<ObjChunk> chunks;
};

/// What an import may still consume, and the name of its file for messages.
class ObjBudget {
 public:
  ObjBudget(const std::string& file, const LoadLimits& limits) : file_(file), limits_(limits) {}
  const std::string& file() const { return file_; }
  const LoadLimits& limits() const { return limits_; }

  /// Errors    Trouble::Input when more than the limit has been taken.
  void take(std::uint64_t bytes);
  bool has_time() const { return clock_.ms() <= limits_.seconds * 1000; }
  /// Errors    Trouble::Input when the time is up.
  void check_time() const;

 private:
  std::string file_;
  LoadLimits limits_;
  std::uint64_t taken_ = 0;
  Stopwatch clock_;
};

/// Reads the statements of an OBJ file, in parallel.
///
/// Errors    Trouble::Input naming file, line and cause: a number that is none, too few numbers, an index out of range.
ObjFile parse_obj(std::string_view text, ObjBudget& budget);

}  // namespace zoneplate
