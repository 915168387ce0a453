// SPDX-License-Identifier: Apache-2.0
import type { FileOptions, ImageOptions, ReadingOptions } from './options.js';

/** A path (in browsers: a URL) of a model, the name of a built-in scene such as "teapot", or the bytes of a file. */
export type Model = string | URL | Uint8Array | ArrayBuffer;

export interface LoadOptions extends ReadingOptions {
  /** Files of the model by their relative paths, such as { "chair.gltf": bytes, "chair.bin": bytes }, in place of the disk's. */
  files?: Record<string, Uint8Array | ArrayBuffer>;
  /** Bytes of a model and its image, such as "512M"; default 1 GiB, at most 2 GiB. */
  maxMemory?: number | string;
}

/** The choice of a camera by what it shows; angles in degrees. */
export interface View {
  /** A camera of the file; default: a view of the whole scene. */
  index?: number;
  position?: [number, number, number];
  focalPoint?: [number, number, number];
  viewUp?: [number, number, number];
  verticalFov?: number;
  /** From the front to the right; default 30. */
  azimuth?: number;
  /** Above the horizon; default 20. */
  elevation?: number;
  orthographic?: boolean;
}

/** A camera in the world, which looks along its own -z with +y up. */
export interface Camera {
  /** Its pose, world from camera: 4 rows of 4 numbers, or 16 numbers row by row. */
  matrix: number[][] | ArrayLike<number> & Iterable<number>;
  /** In degrees; default 30. */
  verticalFov?: number;
  /** A parallel projection that shows this height in world units. */
  height?: number;
  near?: number;
  far?: number;
}

/** "#rrggbb", "#rrggbbaa", or numbers. */
export type Color = string | [number, number, number] | [number, number, number, number];

/** The options of the command, in camelCase: hdriFile is --hdri-file. Those that are here are shorter, or of another type. */
export interface CommonOptions extends LoadOptions, ImageOptions {
  /** Width and height in pixels; default 800 × 600. */
  size?: [number, number];
  /** The antialiasing method, such as "ssaa:n=4" or "smaa"; default "msaa:n=8,alpha=samples". */
  aa?: string;
  /** Data passes, such as "depth", "normal" or "object-id". */
  aovs?: string[];
  view?: View;
  /** x, y, width, height: the rectangle of the image that is rendered. */
  crop?: [number, number, number, number];
  /** Numbers are sRGB codes in [0, 1]; default "#333333"; "environment": the light's image. */
  background?: Color;
  /** No background. */
  transparent?: boolean;
  /** A colour whose light from all directions replaces the default light, or "studio"; numbers are linear. */
  environment?: Color;
  /** Rays of ambient occlusion, or "rays:samples=64,distance=2"; default none. */
  ambientOcclusion?: number | string;
  /** A ground that is visible only where it is in shadow. */
  shadowGround?: boolean;
  cullBackFaces?: boolean;
}

export interface RenderOptions extends CommonOptions {
  /** The result: a file, or "pixels"; "exr" and "pfm" require dtype "float32". Default "png". */
  output?: 'png' | 'jpg' | 'webp' | 'exr' | 'pfm' | 'pixels';
  /** "uint8" and "uint16": sRGB codes with straight alpha; "float32": linear light, premultiplied. Default "uint8". */
  dtype?: 'uint8' | 'uint16' | 'float32';
  /** In place of a view. */
  camera?: Camera;
}

/** Options of `renderFiles`. */
export interface RenderFilesOptions extends CommonOptions, FileOptions {}

export type Pixels = Uint8Array | Uint16Array | Float32Array;

export interface RenderedImage<Data = Uint8Array> {
  width: number;
  height: number;
  output: NonNullable<RenderOptions['output']>;
  /** The bytes of the file; with output "pixels" rows of red, green, blue and alpha, from the top. */
  data: Data;
  /** The data passes; shape is height, width and, for several channels, channels. */
  arrays: Record<string, { shape: number[]; data: Float32Array | Uint32Array }>;
  /** What the reader of the model ignored. */
  warnings: string[];
}

/** Renders a model in a worker. The same bytes as the command's, on every machine. */
export function render(model: Model, options: RenderOptions & { output: 'pixels' }): Promise<RenderedImage<Pixels>>;
export function render(model: Model, options?: RenderOptions): Promise<RenderedImage>;

/**
 * The files that the command `zoneplate render MODEL -o NAME` writes, by their names and with the same bytes: an image with
 * its data passes, frames as "chair.####.png", or a film such as "chair.webp".
 */
export function renderFiles(model: Model, name: string, options?: RenderFilesOptions): Promise<{ files: Record<string, Uint8Array>; warnings: string[] }>;

export interface Info {
  triangles: number;
  lines: number;
  points: number;
  vertices: number;
  instances: number;
  bounds: { min: [number, number, number]; max: [number, number, number] } | null;
  meshes: { name: string; kind: string; primitives: number; vertices: number; material: number }[];
  objects: string[];
  materials: { name: string; model: string; alpha: string; double_sided: boolean }[];
  textures: { name: string; width: number; height: number }[];
  lights: { name: string; kind: string; intensity: number }[];
  cameras: { name: string; kind: string; position: [number, number, number] }[];
  animations: { name: string; begin: number; end: number }[];
  variants: string[];
  warnings: string[];
  /** The same as lines of text. Not enumerable. */
  readonly text: string;
}

/** The contents of a model. */
export function info(model: Model, options?: LoadOptions): Promise<Info>;

/** A path (in browsers: a URL) of an image file, its bytes, a result of `render`, or pixels of 1, 3 or 4 channels. */
export type Image =
  | string
  | URL
  | Uint8Array
  | ArrayBuffer
  | { width: number; height: number; data: Pixels | Uint8ClampedArray; output?: RenderOptions['output'] };

export interface CompareOptions {
  /** Metrics with their parameters, such as "flip:ppd=30"; default: those of the command. */
  metrics?: string[];
  /** Rectangles x, y, width, height that are not compared. */
  ignore?: [number, number, number, number][];
}

export interface Measurement {
  /** Infinity, for example, for the PSNR of identical images. */
  value: number;
  unit: string;
  better: 'lower' | 'higher';
  /** Other values of the metric, by name. */
  figures: Record<string, number>;
}

export interface Comparison {
  identical: boolean;
  width: number;
  height: number;
  metrics: Record<string, Measurement>;
  /** The errors of the pixels by the first metric that has a map, rows from the top. */
  map?: Float32Array;
}

/** Measures the difference between an image and a reference. */
export function compare(reference: Image, test: Image, options?: CompareOptions): Promise<Comparison>;

/** A row of the table of options. */
export interface OptionRow {
  name: string;
  /** The form of the value, or its unit: "X,Y,Z", "DEG". */
  value: string;
  kind: 'switch' | 'number' | 'whole' | 'choice' | 'text';
  low: number;
  high: number;
  /** Names that the value may be or begin with, separated by commas. */
  choices: string;
  group: string;
  summary: string;
  /** All that the command takes, separated by commas. */
  names: string;
}

/** The names of methods, metrics and others, each with a line about it, the options, and the version. */
export function list(): Promise<{
  options: OptionRow[];
  version: string;
  methods: Record<string, string>;
  metrics: Record<string, string>;
  scenes: Record<string, string>;
  aovs: Record<string, string>;
  kernels: Record<string, string>;
}>;

/** Sets the greatest number of workers; default: the processors, at most 8. */
export function setWorkers(count: number): void;

/** Ends the workers. Not required: idle workers do not keep a process alive. A later call starts new ones. */
export function close(): void;

export class ZoneplateError extends Error {
  code: 'failed' | 'usage' | 'input' | 'output' | 'memory';
}
