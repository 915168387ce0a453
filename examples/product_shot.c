// SPDX-License-Identifier: Apache-2.0
// Renders a product shot by the interface for C: product_shot MODEL SKY.hdr OUT.webp
#include <stdio.h>

#include "zoneplate/zoneplate.h"

int main(int argc, char** argv) {
  if (argc != 4) return fprintf(stderr, "usage: product_shot MODEL SKY.hdr OUT.webp\n"), 2;
  const char* options[][2] = {{"size", "400"},      {"hdri-file", argv[2]},         {"lights", "both"},
                              {"ground", "shadow"}, {"shadows", "soft:samples=16"}, {"turntable", "12"}};
  zoneplate_job* job = NULL;
  zoneplate_scene* scene = NULL;
  zoneplate_status status = zoneplate_job_new(&job);
  for (int i = 0; i < 6 && status == ZONEPLATE_OK; ++i) status = zoneplate_job_set(job, options[i][0], options[i][1]);
  if (status == ZONEPLATE_OK) status = zoneplate_job_load(job, argv[1], &scene);
  if (status == ZONEPLATE_OK) status = zoneplate_job_save(job, scene, argv[3]);
  if (status != ZONEPLATE_OK) fprintf(stderr, "product_shot: %s\n", zoneplate_error_text());
  return zoneplate_scene_free(scene), zoneplate_job_free(job), (int)status;
}
