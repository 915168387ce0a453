// What the page displays, as the fragment of its address: #scene=teapot&a=none&b=msaa:n=4

export const panels = ['120', '180', '240', '360', '480', '720'], defaultPanel = '240';
export const sizes = ['320x180', '480x270', '640x360', '800x600', '960x540', '1280x720'];

/// `a`, `b`: methods; `looka`, `lookb`: options of rendering, visibility=painter; `view`: zoom, x and y, when the page is opened;
/// `demo`: a lesson of the program in place of a scene and methods, sampling:rate=1.6, and `panel` the size of its images.
export const defaults = { scene: 'teapot', a: 'none', b: 'msaa:n=4', size: '640x360', azimuth: '', elevation: '', angle: '', frame: '', layout: 'slider', pixel: '',
  looka: '', lookb: '', view: '', lesson: '', step: '', demo: '', panel: '' };

/// The state of an address; what it does not state has its default.
export function readState(hash) {
  const given = new URLSearchParams(hash.replace(/^#/, '').replaceAll('+', '%2B'));
  return Object.fromEntries(Object.entries(defaults).map(([name, value]) => [name, given.get(name) ?? value]));
}

/// The fragment of a state, without what has its default.
export function hashOf(state) {
  const parts = Object.keys(defaults).filter((name) => state[name] !== defaults[name])
    .map((name) => `${name}=${encodeURIComponent(state[name]).replaceAll('%3A', ':').replaceAll('%3D', '=').replaceAll('%2C', ',')}`);
  return parts.length ? `#${parts.join('&')}` : '#';
}

/// The command of the native program that draws the same lesson.
export const demoCommandOf = ({ demo, panel }) => `./zoneplate demo ${demo} --panel ${panel || defaultPanel} -o ${demo.split(':')[0]}.png`;

/// The command of the native program that makes the same image, by a method with or without history, in the light of a file.
export function commandOf(state, about, { method, look, hasHistory, output, environment = '' }) {
  const [width, height] = state.size.split('x'), isFrame = state.frame !== '', isTurned = isFrame && !about.moves;
  const options = [['camera-azimuth-angle', state.azimuth], ['camera-elevation-angle', state.elevation], ['camera-view-angle', state.angle], ['hdri-file', environment],
    ['turntable', isTurned ? about.frames : ''], ['camera-index', isTurned && about.has_own_camera ? 0 : ''], ['frame-start', state.frame], ['frame-end', state.frame],
    ...look.split(',').filter(Boolean).map((item) => item.split('=')),
    ['warm-up', isFrame && hasHistory && state.frame !== '0' ? Math.min(32, state.frame) : '']];
  return `./zoneplate render ${state.scene} -o ${output} --size ${width},${height} --anti-aliasing ${method}`
    + options.filter(([, value]) => value !== '').map(([name, value]) => ` --${name} ${value}`).join('');
}
