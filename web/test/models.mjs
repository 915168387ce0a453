// Models whose files the tests write: a square of two triangles with a texture, in every format that the page reads.
import fs from 'node:fs';
import path from 'node:path';
import { writePng } from './pictures.mjs';

const corners = [[-1, -1, 0.2], [1, -1, 0], [1, 1, -0.3], [-1, 1, 0.1]], faces = [[0, 1, 2], [0, 2, 3]];
const flat = (rows) => rows.map((row) => row.join(' ')).join('\n');

export function gltfOf(image, mimeType = 'image/png') {
  const bin = Buffer.alloc(92 + image.length);
  faces.flat().forEach((index, i) => bin.writeUInt16LE(index, 2 * i));
  corners.flat().forEach((value, i) => bin.writeFloatLE(value, 12 + 4 * i));
  [[0, 1], [1, 1], [1, 0], [0, 0]].flat().forEach((value, i) => bin.writeFloatLE(value, 60 + 4 * i));
  image.copy(bin, 92);
  const json = {
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 1, TEXCOORD_0: 2 }, indices: 0, material: 0 }] }],
    materials: [{ doubleSided: true, pbrMetallicRoughness: { baseColorTexture: { index: 0 }, metallicFactor: 0.2 } }],
    textures: [{ source: 0 }], images: [{ bufferView: 3, mimeType }],
    accessors: [{ bufferView: 0, componentType: 5123, count: 6, type: 'SCALAR' },
      { bufferView: 1, componentType: 5126, count: 4, type: 'VEC3', min: [-1, -1, -0.3], max: [1, 1, 0.2] }, { bufferView: 2, componentType: 5126, count: 4, type: 'VEC2' }],
    bufferViews: [[0, 12], [12, 48], [60, 32], [92, image.length]].map(([byteOffset, byteLength]) => ({ buffer: 0, byteOffset, byteLength })),
    buffers: [{ byteLength: bin.length }],
  };
  return { json, bin };
}

export function glbOf({ json, bin }) {
  const pad = (bytes, fill) => Buffer.concat([bytes, Buffer.alloc(-bytes.length & 3, fill)]);
  const chunk = (type, bytes) => { const head = Buffer.alloc(8); head.writeUInt32LE(bytes.length), head.write(type, 4, 'latin1'); return Buffer.concat([head, bytes]); };
  const body = Buffer.concat([chunk('JSON', pad(Buffer.from(JSON.stringify(json)), ' ')), chunk('BIN\0', pad(bin, 0))]), head = Buffer.alloc(12);
  head.write('glTF', 0, 'latin1'), head.writeUInt32LE(2, 4), head.writeUInt32LE(12 + body.length, 8);
  return Buffer.concat([head, body]);
}

/// A wave of side² squares, two triangles each, as binary glTF.
export function waveGlb(side) {
  const count = (side + 1) ** 2, bin = Buffer.alloc(24 * count + 12 * side * side), size = 24 * count;
  for (let i = 0; i < count; ++i) {
    const x = (i % (side + 1)) / side * 2 - 1, z = Math.floor(i / (side + 1)) / side * 2 - 1, slope = 0.75 * Math.cos(5 * x);
    [x, 0.15 * Math.sin(5 * x), z].forEach((value, k) => bin.writeFloatLE(value, 12 * i + 4 * k));
    [-slope, 1, 0].forEach((value, k) => bin.writeFloatLE(value / Math.hypot(slope, 1), 12 * (count + i) + 4 * k));
  }
  for (let i = 0; i < side * side; ++i) {
    const at = Math.floor(i / side) * (side + 1) + (i % side);
    [at, at + side + 1, at + 1, at + 1, at + side + 1, at + side + 2].forEach((index, k) => bin.writeUInt16LE(index, size + 12 * i + 2 * k));
  }
  return glbOf({ bin, json: {
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1 }, indices: 2, material: 0 }] }],
    materials: [{ doubleSided: true, pbrMetallicRoughness: { baseColorFactor: [0.8, 0.4, 0.2, 1], metallicFactor: 0.4, roughnessFactor: 0.3 } }],
    accessors: [{ bufferView: 0, componentType: 5126, count, type: 'VEC3', min: [-1, -0.15, -1], max: [1, 0.15, 1] },
      { bufferView: 1, componentType: 5126, count, type: 'VEC3' }, { bufferView: 2, componentType: 5123, count: 6 * side * side, type: 'SCALAR' }],
    bufferViews: [[0, 12 * count], [12 * count, 12 * count], [size, 12 * side * side]].map(([byteOffset, byteLength]) => ({ buffer: 0, byteOffset, byteLength })),
    buffers: [{ byteLength: bin.length }],
  } });
}

/// Writes the models into a folder; returns the names of the files of each, the model first.
export function writeModels(folder) {
  const at = (name) => path.join(folder, name), write = (name, bytes) => fs.writeFileSync(at(name), bytes);
  writePng(at('face.png'), 16, 16, (x, y) => [16 * x, 16 * y, (x ^ y) & 1 ? 255 : 40]);
  const gltf = gltfOf(fs.readFileSync(at('face.png')));
  write('square.glb', glbOf(gltf));
  write('square.vrm', glbOf(gltf));
  write('square.bin', gltf.bin);
  write('square.gltf', JSON.stringify({ ...gltf.json, buffers: [{ byteLength: gltf.bin.length, uri: 'square.bin' }], images: [{ uri: 'face.png' }] }));
  write('square.obj', `mtllib square.mtl\nusemtl face\n${corners.map((corner) => `v ${corner.join(' ')}`).join('\n')}\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n`);
  write('square.mtl', 'newmtl face\nKd 1 1 1\nmap_Kd face.png\n');
  write('square.ply', `ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n${flat(corners)}\n${flat(faces.map((face) => [3, ...face]))}\n`);
  write('square.stl', `solid square\n${faces.map((face) => `facet normal 0 0 0\nouter loop\n${face.map((i) => `vertex ${corners[i].join(' ')}`).join('\n')}\nendloop\nendfacet`).join('\n')}\nendsolid\n`);
  return [['square.glb'], ['square.vrm'], ['square.gltf', 'square.bin', 'face.png'], ['square.obj', 'square.mtl', 'face.png'], ['square.ply'], ['square.stl']];
}

/// A KTX 2 file of the tests of its decoder, by the name of its array.
export function ktx2File(name) {
  const text = fs.readFileSync(new URL('../../src/zoneplate/codec/ktx2/files_for_test.h', import.meta.url), 'utf8');
  const [, list] = new RegExp(`${name}\\[\\] = \\{(.*?)\\}`, 's').exec(text);
  return Buffer.from([...list.matchAll(/0x(..)/g)].map(([, digits]) => parseInt(digits, 16)));
}
