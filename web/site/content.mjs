// What the gallery compares, and the order of the documents.

/// The scenes of the gallery with the methods of their reports; `frames` of those that move; `look` are options of rendering, as the
/// playground takes them.
const still = 'none,fxaa,smaa,msaa:n=8,ssaa:n=4,taa', moving = 'none,msaa:n=8,taa,taa:new=smaa,taau:scale=2,fsr3:scale=2';
export const failures = [
  ...['near-axis', 'wires', 'stars', 'sun-roof', 'foliage', 'tiles', 'metal', 'text-ui', 'thin-diagonal'].map((scene) => ({ scene, methods: still, size: '320x180' })),
  { scene: 'pergola', methods: still, size: '320x180', look: 'shadows=hard' }, { scene: 'rivets', methods: still, size: '320x180', look: 'specular-aa=full' },
  ...['panning-wires', 'passing-fence', 'teleport', 'disocclusion', 'light-switch'].map((scene) => ({ scene, methods: moving, frames: 8, size: '240x135' })),
];

/// The documents in the order of reading, in groups; those that are in none come last.
export const documentGroups = [
  ['Start', ['README.md', 'docs/images.md', 'docs/ci.md', 'docs/farms.md', 'docs/formats.md', 'docs/playground.md', 'docs/python.md', 'docs/node.md', 'docs/api.md']],
  ['Antialiasing', ['docs/compare.md', 'docs/reference.md', 'docs/post-process.md', 'docs/temporal.md', 'docs/upscaling.md', 'docs/sdf.md']],
  ['Textures and light', ['docs/textures.md', 'docs/environment.md', 'docs/shadows.md']],
  ['Design', ['docs/architecture.md', 'docs/performance.md', 'docs/optimization.md']],
  ['Project', ['CONTRIBUTING.md', 'CONVENTIONS.md', 'CHANGELOG.md', 'SECURITY.md', 'THIRD_PARTY.md']],
];
