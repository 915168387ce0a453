// The filters of three.js and postprocessing, each from one render target of 8-bit codes into another.
//
// Asks its server what to do until there is nothing left: `work` is {filter, frames} or {filter, picture}.
import * as THREE from 'three';
import { FullScreenQuad } from 'three/addons/postprocessing/Pass.js';
import { ShaderPass } from 'three/addons/postprocessing/ShaderPass.js';
import { FXAAPass } from 'three/addons/postprocessing/FXAAPass.js';
import { SMAAPass } from 'three/addons/postprocessing/SMAAPass.js';
import { FXAAShader as Fxaa311 } from 'three-r137/examples/jsm/shaders/FXAAShader.js';
import { EdgeDetectionMode, EffectPass, FXAAEffect, SMAAEffect, SMAAPreset } from 'postprocessing';

THREE.ColorManagement.enabled = false;
const renderer = new THREE.WebGLRenderer({ antialias: false, depth: false, stencil: false });
renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
renderer.autoClear = false;
const gl = renderer.getContext();

const answer = (path, body) => fetch(path, { method: 'POST', body });
const target = (width, height) => new THREE.WebGLRenderTarget(width, height, { depthBuffer: false });

/// Codes, rows from the top, copied into a render target.
function upload(codes, width, height) {
  const texture = new THREE.DataTexture(codes, width, height);
  texture.needsUpdate = true;
  const out = target(width, height);
  renderer.setRenderTarget(out);
  new FullScreenQuad(new THREE.MeshBasicMaterial({ map: texture })).render(renderer);
  return out;
}

function shaderPass(pass, width, height, from, to) {
  pass.setSize(width, height);
  if (pass.uniforms?.resolution) pass.uniforms.resolution.value.set(1 / width, 1 / height);
  return () => pass.render(renderer, to, from, 0, false);
}

/// An effect of postprocessing whose tables have been loaded.
async function effectPass(effect, hasTables, width, height, from, to) {
  if (hasTables) await new Promise((done) => effect.addEventListener('load', done));
  const pass = new EffectPass(new THREE.PerspectiveCamera(), effect);
  pass.initialize(renderer, false, THREE.UnsignedByteType);
  pass.setSize(width, height);
  return () => pass.render(renderer, from, to, 0, false);
}

function makeFilter(name, ...where) {
  switch (name) {
    case 'three r137 FXAA 3.11':
      return shaderPass(new ShaderPass(Fxaa311), ...where);
    case 'three FXAAPass':
      return shaderPass(new FXAAPass(), ...where);
    case 'three SMAAPass':
      return shaderPass(new SMAAPass(), ...where);
    case 'postprocessing FXAA':
      return effectPass(new FXAAEffect(), false, ...where);
    case 'postprocessing SMAA high':
      return effectPass(
        new SMAAEffect({ preset: SMAAPreset.HIGH, edgeDetectionMode: EdgeDetectionMode.LUMA }), true, ...where);
  }
}

/// Reading a pixel waits until the frame is there.
const onePixel = new Uint8Array(4);
function timeFrames(filter, to, frames) {
  const ms = [];
  for (let i = 0; i < frames; ++i) {
    const start = performance.now();
    filter();
    renderer.readRenderTargetPixels(to, 0, 0, 1, 1, onePixel);
    ms.push(performance.now() - start);
  }
  return ms;
}

async function run() {
  const { width, height } = await (await fetch('/job')).json();
  const to = target(width, height), sources = {}, filters = {};
  for (;;) {
    const work = await (await fetch('/work')).json();
    if (!work.filter) return;
    const key = work.scene + work.filter;
    if (!sources[work.scene])
      sources[work.scene] =
        upload(new Uint8Array(await (await fetch('/file/' + work.scene)).arrayBuffer()), width, height);
    if (!filters[key]) {
      filters[key] = await makeFilter(work.filter, width, height, sources[work.scene], to);
      timeFrames(filters[key], to, 1);  // compiles the shaders
    }
    if (work.frames) {
      const ms = timeFrames(filters[key], to, work.frames);
      await answer('/done', JSON.stringify(ms));
    } else {
      timeFrames(filters[key], to, 1);
      const codes = new Uint8Array(4 * width * height);
      renderer.readRenderTargetPixels(to, 0, 0, width, height, codes);
      await answer('/done', codes);
    }
  }
}

const debug = gl.getExtension('WEBGL_debug_renderer_info');
await answer('/renderer', debug ? gl.getParameter(debug.UNMASKED_RENDERER_WEBGL) : 'unknown');
run().catch((error) => answer('/trouble', String(error.stack ?? error)));
