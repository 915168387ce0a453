// What the gallery compares, and where the playground continues a lesson.

/// The scenes of the gallery with the methods of their reports; `frames` of those that move; `look` are options of rendering, as the
/// playground takes them.
const still = 'none,fxaa,smaa,msaa:n=8,ssaa:n=4,taa', moving = 'none,smaa,msaa:n=8,taa';
export const failures = [
  ...['near-axis', 'wires', 'stars', 'sun-roof', 'foliage', 'tiles', 'metal', 'text-ui', 'thin-diagonal'].map((scene) => ({ scene, methods: still, size: '320x180' })),
  { scene: 'pergola', methods: still, size: '320x180', look: 'shadows=hard' }, { scene: 'rivets', methods: still, size: '320x180', look: 'specular-aa=full' },
  ...['panning-wires', 'passing-fence', 'teleport', 'disocclusion', 'light-switch'].map((scene) => ({ scene, methods: moving, frames: 8, size: '240x135' })),
];

