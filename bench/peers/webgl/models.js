// Frames of glTF models by three.js at its defaults: physically based materials in the light of its own room, four
// samples a pixel where the renderer has them.
//
// Each piece of work has a `model`, the path of its file, and either `frames`, a number of frames to time, or `picture`;
// the first of a model is answered with the camera.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';

const answer = (path, body) => fetch(path, { method: 'POST', body });
const { width, height } = await (await fetch('/job')).json();
const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.setPixelRatio(1);
renderer.setSize(width, height);
renderer.toneMapping = THREE.NeutralToneMapping;
renderer.setClearColor(0xffffff);
const gl = renderer.getContext();
const light = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment(), 0.04).texture;

/// A scene with a camera that sees the sphere around the model from 30 degrees to the right and 20 above.
async function load(path) {
  const scene = new THREE.Scene();
  scene.environment = light;
  const model = (await new GLTFLoader().loadAsync(path)).scene;
  scene.add(model);
  scene.updateMatrixWorld(true);
  const sphere = new THREE.Box3().setFromObject(model, true).getBoundingSphere(new THREE.Sphere());
  const distance = sphere.radius / Math.sin(Math.PI / 12);
  const camera = new THREE.PerspectiveCamera(30, width / height, distance - sphere.radius, distance + sphere.radius);
  camera.position.setFromSphericalCoords(distance, Math.PI / 2 - Math.PI / 9, Math.PI / 6).add(sphere.center);
  camera.lookAt(sphere.center);
  return { scene, camera, centre: sphere.center };
}

/// Reading a pixel waits until the frame is there.
const onePixel = new Uint8Array(4);
function draw({ scene, camera }) {
  const start = performance.now();
  renderer.render(scene, camera);
  gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, onePixel);
  return performance.now() - start;
}

async function run() {
  const loaded = {};
  for (;;) {
    const { model, frames } = await (await fetch('/work')).json();
    if (!model) return;
    if (!loaded[model]) {
      loaded[model] = await load(model);
      for (let i = 0; i < 3; ++i) draw(loaded[model]);  // compiles the shaders and uploads the textures
      const { camera, centre } = loaded[model];
      await answer('/done', JSON.stringify({ position: camera.position.toArray(), centre: centre.toArray(),
        samples: gl.getParameter(gl.SAMPLES) }));
    } else if (frames) {
      await answer('/done', JSON.stringify(Array.from({ length: frames }, () => draw(loaded[model]))));
    } else {
      draw(loaded[model]);
      await answer('/done', await new Promise((done) => renderer.domElement.toBlob(done)));
    }
  }
}

const debug = gl.getExtension('WEBGL_debug_renderer_info');
await answer('/renderer', debug ? gl.getParameter(debug.UNMASKED_RENDERER_WEBGL) : 'unknown');
run().catch((error) => answer('/trouble', String(error.stack ?? error)));
