// SPDX-License-Identifier: Apache-2.0
import type { Image, Model, RenderOptions } from './index.js';

export interface MatchOptions {
  /** The greatest difference in just noticeable differences (10 - the JOD of ColorVideoVDP). */
  jnd?: number;
  /** The greatest number of pixels that may differ; default 0. */
  pixels?: number;
  /** 8-bit codes by which a channel may differ, of `pixels`; default 0. */
  tolerance?: number;
  /** Pixels that differ only by the coverage of an edge do not count, of `pixels`; default false. */
  antialiasing?: boolean;
  /** Rectangles x, y, width, height that are not compared. */
  ignore?: [number, number, number, number][];
  /** How a model is rendered. */
  render?: RenderOptions;
}

/**
 * A matcher for `expect.extend`: `await expect(model).toMatchRender('golden/chair.png', { jnd: 0.2 })`. A model is
 * rendered first; images are compared as they are. With ZONEPLATE_UPDATE=1, or --update, the golden image is written.
 */
export function toMatchRender(
  this: unknown,
  received: Model | Image,
  expected: Image,
  options?: MatchOptions,
): Promise<{ pass: boolean; message: () => string }>;
