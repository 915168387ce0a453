// What the gallery compares, and where the playground continues a lesson.

/// The scenes of the gallery with the methods of their reports; `frames` of those that move.
const still = 'none,fxaa,smaa,msaa:n=8,ssaa:n=4,taa', moving = 'none,smaa,msaa:n=8,taa';
export const failures = [
  ...['near-axis', 'wires', 'stars', 'sun-roof', 'foliage', 'tiles', 'metal', 'text-ui', 'thin-diagonal'].map((scene) => ({ scene, methods: still })),
  ...['panning-wires', 'passing-fence', 'teleport', 'disocclusion', 'light-switch'].map((scene) => ({ scene, methods: moving, frames: 12 })),
];

/// The state of the playground that renders the subject of a lesson.
export const lessons = {
  jaggies: 'scene=teapot&a=none&b=msaa:n=16&pixel=300,90',
  antialiasing: 'scene=near-axis&a=none&b=smaa&layout=grid',
  upscaling: 'scene=teapot&a=bilinear:scale=2&b=fsr2:scale=2',
  moire: 'scene=checkerboard&a=none&b=ssaa:n=4',
  'exact-coverage': 'scene=thin-diagonal&a=msaa:n=4&b=analytic&layout=grid',
  'wagon-wheel': 'scene=wheel&a=none&b=ssaa:n=4',
  'texture-filters': 'scene=tiles&a=none&b=ssaa:n=4',
  'normal-map-aliasing': 'scene=metal&a=msaa:n=8&b=ssaa:n=4&layout=grid',
  'black-edge': 'scene=sun-roof&a=msaa:n=4&b=msaa:n=4,resolve=display',
  zbuffer: 'scene=cyclic&a=none&b=msaa:n=4',
  rasterization: 'scene=triangles&a=none&b=msaa:n=4&size=320x180&pixel=160,90',
  temporal: 'scene=panning-wires&a=none&b=taa&frame=12',
  ghosting: 'scene=teleport&a=taa:rectify=none,reject=none&b=taa&layout=grid&frame=16',
};
