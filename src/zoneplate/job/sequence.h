// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "zoneplate/job/job_sink.h"
#include "zoneplate/job/picture.h"

namespace zoneplate {

/// A rendered image of a job, before it is encoded.
struct JobImage {
  int frame = -1;  ///< its number in the sequence; -1: a still image
  RenderedImage image;
  Camera camera;
};

/// The frames of a job that is a sequence, rendered one after the other.
///
/// Frame i is the animation at i / rate seconds. On a turntable of n frames the camera has rotated by i / n of a turn
/// about the centre of the scene. The camera of a whole-scene view contains the whole animation, independently of the
/// rendered frames, and does not move. Exposure, tone curve and point size that the scene decides are those of frame 0.
class JobFrames {
 public:
  /// `given`: a scene at rest in memory whose materials are those of the job; null: the job's input is read.
  ///
  /// Requires  a job that check_job has completed; `given` outlives this object.
  /// Errors    ErrorKind::Usage: no frames, or options that the method excludes; ErrorKind::Input for an animation with
  ///           too many frames; those of reading.
  JobFrames(Job job, std::unique_ptr<Resolver> method, JobSink& sink, const PreparedScene* given = nullptr);
  ~JobFrames();

  const Job& job() const;  ///< resolved
  const std::vector<int>& frames() const;
  std::size_t done() const;               ///< of them, rendered or skipped
  const Scene& scene() const;             ///< of the frame that was rendered last
  const PreparedScene& prepared() const;  ///< the same
  std::vector<std::string>& warnings();

  /// Renders the next frame. Requires: there is one.
  JobImage next(std::function<void(double)> progress = {});
  /// Leaves out the next frame; the one after it begins a sequence.
  void skip();
  /// Lets this frame be the next, as if it was the first of the job: `warm_up` frames before it are rendered for the
  /// history of the method.
  ///
  /// Errors    ErrorKind::Usage for a frame that is not one of `frames`.
  void seek(int frame, int warm_up);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Renders the frames of a job and sends them: numbered files, a film, or the frames of a film that the receiver
/// encodes (film.h).
///
/// Errors    those of JobFrames; ErrorKind::Usage for a name without a placeholder for the number.
void render_sequence(Job job, std::unique_ptr<Resolver> method, JobSink& out, Summary& summary,
                     const PreparedScene* given = nullptr);

/// The time at which the animations end that a choice plays, in seconds; 0 if it plays none.
double end_of_animation(const SceneChoice& choice, const Scene& scene);

/// A warning for a time (--animation-time) after that end; empty for one before it.
std::string lateness(const Job& job, double end);

/// True for the name of a film: .apng and .webp, or is_encoded_by_ffmpeg.
bool is_film(const std::string& output);

}  // namespace zoneplate
