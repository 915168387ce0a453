// SPDX-License-Identifier: Apache-2.0
// Renders a model by the interface for C, saves a PNG and finds the nearest surface: render_in_c MODEL OUT.png
#include <stdio.h>

#include "zoneplate/zoneplate.h"

int main(int argc, char** argv) {
  if (argc != 3) return fprintf(stderr, "usage: render_in_c MODEL OUT.png\n"), 2;
  zoneplate_scene* scene = NULL;
  zoneplate_image* image = NULL;
  zoneplate_render_options options = {
      .size = sizeof options, .width = 640, .height = 480, .method = "msaa:n=8", .passes = "depth"};
  zoneplate_array depth;

  zoneplate_status status = zoneplate_scene_load(argv[1], NULL, &scene);
  if (status == ZONEPLATE_OK) status = zoneplate_render(scene, NULL, &options, &image);
  if (status == ZONEPLATE_OK) status = zoneplate_image_save(image, argv[2]);
  if (status == ZONEPLATE_OK) status = zoneplate_image_array(image, "depth", &depth);
  if (status == ZONEPLATE_OK) {
    const float* values = depth.data;  // height x width, without padding
    float nearest = values[0];
    for (int64_t i = 0; i < depth.shape[0] * depth.shape[1]; ++i) nearest = values[i] < nearest ? values[i] : nearest;
    printf("%s: nearest surface at %.3f m\n", argv[2], (double)nearest);
  } else {
    fprintf(stderr, "render_in_c: %s\n", zoneplate_error_text());
  }
  zoneplate_image_free(image);
  zoneplate_scene_free(scene);
  return (int)status;
}
