// SPDX-License-Identifier: Apache-2.0
/** A path (in browsers: a URL) of a model, the name of a built-in scene such as "teapot", or the bytes of a file. */
export type Model = string | URL | Uint8Array | ArrayBuffer;

export interface LoadOptions {
  /** Files of the model by their relative paths, such as { "chair.gltf": bytes, "chair.bin": bytes }, in place of the disk's. */
  files?: Record<string, Uint8Array | ArrayBuffer>;
  /** An extension without its dot, "stl"; default: that of the name, or what the first bytes say. */
  format?: string;
  /** A material variant of a glTF file. */
  variant?: string;
  /** Index of a scene of a glTF file; default: the file's default scene. */
  scene?: number;
  /** Index or name of an animation of a glTF file, -1: all; default: not animated. */
  animation?: number | string;
  /** Of the animation, in seconds. */
  time?: number;
  /** Bytes of decoded data, at most 2 GiB; default 1 GiB. */
  maxMemory?: number;
  /** Seconds of reading; default 60. */
  maxSeconds?: number;
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

export interface RenderOptions extends LoadOptions {
  /** Width and height in pixels; default 800 × 600. */
  size?: [number, number];
  /** The antialiasing method, such as "ssaa:n=4" or "smaa"; default "msaa:n=8,alpha=samples". */
  aa?: string;
  /** The result: a file, or "pixels"; "exr" and "pfm" require dtype "float32". Default "png". */
  output?: 'png' | 'jpg' | 'webp' | 'exr' | 'pfm' | 'pixels';
  /** Data passes, such as "depth", "normal" or "object-id". */
  aovs?: string[];
  /** "uint8" and "uint16": sRGB codes with straight alpha; "float32": linear light, premultiplied. Default "uint8". */
  dtype?: 'uint8' | 'uint16' | 'float32';
  view?: View;
  camera?: Camera;
  /** x, y, width, height: the rectangle of the image that is rendered. */
  crop?: [number, number, number, number];
  /** Default: "neutral" in the studio that a scene without lights gets, else "none". */
  toneMapping?: 'none' | 'aces' | 'neutral' | 'agx' | 'filmic';
  /** In stops. */
  exposure?: number;
  /** Numbers are sRGB codes in [0, 1]; default "#333333". */
  background?: Color;
  /** No background. */
  transparent?: boolean;
  /** Factor of every light; default: 1, and lights that would clip the surfaces to white are dimmed. */
  lightIntensity?: number;
  /** A colour whose light from all directions replaces the default light; numbers are linear. */
  environment?: Color;
  shadows?: 'none' | 'map' | 'hard' | 'soft';
  /** Rays of ambient occlusion; default 0. */
  ambientOcclusion?: number;
  /** A ground that is visible only where it is in shadow. */
  shadowGround?: boolean;
  /** Most probes of texture filters; 0, the default: 4, or the own value of a built-in scene. */
  anisotropy?: number;
  cullBackFaces?: boolean;
  /** Pixels along a side of the squares of points; 0, the default: by the number of points. */
  pointSize?: number;
}

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

/** The names of methods, metrics and others, each with a line about it, and the version. */
export function list(): Promise<{
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
