// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "zoneplate/edges/edge_options.h"
#include "zoneplate/image/plane.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/ray/bvh.h"
#include "zoneplate/scene/camera.h"
#include "zoneplate/scene/geometry/mesh_edges.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

class TextureSet;

/// What an image shows of a scene, and the part of it that is wanted.
struct EdgeView {
  Camera camera;
  float aspect = 1;                     ///< width / height of the camera's view
  int width = 0, height = 0;            ///< pixels of the whole image
  int x = 0, y = 0;                     ///< the top-left pixel of the part
  int part_width = 0, part_height = 0;  ///< pixels
  bool culls_back_faces = true;         ///< of single-sided materials
};

/// The edges of a scene's meshes as antialiased lines: object-space edges, drawn on the screen, with hidden-line
/// removal by rays.
///
/// A boundary belongs to one triangle, a silhouette parts a triangle that faces the camera from one that does not, and
/// a crease has triangles whose normals differ by more than the angle. Seams of texture coordinates or normals are no
/// edges. An edge of more than two triangles is a crease where two of their planes differ by more than the angle.
///
/// Each line is divided into pieces of at most half a pixel, and a ray from the eye to the middle of a piece decides
/// whether it is seen. The two triangles of the edge, which contain it, never hide it; alpha-tested and blended
/// surfaces hide it where their opacity exceeds a half, transmissive ones as far as they do not transmit.
///
/// The coverage of a pixel by a line is that of the pixel's width along the line's normal, an interval of length 1, by
/// the line's width around its centre, at the point of the line nearest to the pixel's centre; lines thinner than a
/// pixel are fainter instead. Of several lines the greatest coverage counts, so that joints are round and even.
///
/// Exact     the same bits for any number of threads and any instruction set; a part has the bits of the whole.
/// Source    distance to the line as coverage: Gupta and Sproull, Filtering Edges for Gray-Scale Displays, SIGGRAPH 1981;
///           visibility at the nearest point of the line: Cole and Finkelstein, Two Fast Methods for High-Quality Line
///           Visibility, TVCG 16(5), 2010, here by rays in place of a depth buffer; the kinds of edges: Appel, The
///           Notion of Quantitative Invisibility, ACM National Conference 1967.
class SceneEdges {
 public:
  /// The part of each pixel's area that lines cover, in [0, 1]. Edges and the tree of rays are made anew only for
  /// another scene.
  Plane<float> coverage(const std::shared_ptr<const Scene>& scene, const TextureSet& textures, const EdgeView& view,
                        const EdgeOptions& options);

 private:
  void set_scene(const std::shared_ptr<const Scene>& scene);

  std::shared_ptr<const Scene> scene_;
  std::vector<std::vector<MeshEdge>> edges_;  ///< by mesh
  std::optional<Bvh> bvh_;                    ///< made where lines are hidden
};

///@{
/// Draws lines of one colour over an image, in linear light. `display` states how a scene-linear image is displayed
/// later: its lines end up in the colour of the options. Pixels without coverage keep their bits.
void draw_edges(const Plane<float>& coverage, const EdgeOptions& options, const DisplayOptions& display,
                DisplayImage& image);
void draw_edges(const Plane<float>& coverage, const EdgeOptions& options, const DisplayOptions& display,
                LinearImage& image);
///@}

}  // namespace zoneplate
