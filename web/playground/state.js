// What the page displays, as the fragment of its address: #scene=teapot&a=none&b=msaa:n=4

export const panels = ['120', '180', '240', '360', '480', '720'], defaultPanel = '240';
export const sizes = ['320x180', '480x270', '640x360', '800x600', '960x540', '1280x720'];

/// `a`, `b`: methods; `looka`, `lookb`: options of rendering, visibility=painter;no-cull; `view`: zoom, x and y, when the page is
/// opened; `demo`: a lesson of the program in place of a scene and methods, sampling:rate=1.6, and `panel` the size of its images.
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
    .map((name) => `${name}=${encodeURIComponent(state[name]).replaceAll('%3A', ':').replaceAll('%3D', '=').replaceAll('%2C', ',').replaceAll('%3B', ';')}`);
  return parts.length ? `#${parts.join('&')}` : '#';
}

/// The command of the native program that draws the same lesson.
export const demoCommandOf = ({ demo, panel }) => `./zoneplate demo ${demo} --panel ${panel || defaultPanel} -o ${demo.split(':')[0]}.png`;

/// The options of a text such as shadows=soft:samples=8;no-cull: [NAME, VALUE], or [NAME, ''] of a switch. In values a semicolon
/// is %3B.
export const pairsOf = (text) => text.split(';').filter(Boolean).map((item) => {
  const [, name, value = ''] = /^([^=]*)=?(.*)$/.exec(item);
  return [name, decodeURIComponent(value)];
});
export const textOf = (pairs) => pairs.map(([name, value]) => (value === '' ? name : `${name}=${value.replace(/[%;]/g, encodeURIComponent)}`)).join(';');
/// The same as arguments of the program.
export const argumentsOf = (pairs) => pairs.flatMap(([name, value]) => (value === '' ? [`--${name}`] : [`--${name}`, value]));

/// The options, as those of the command, by which an image of a state is made: by a method, with options of rendering, in the
/// light of a file. `quality` is first: it sets several options, which others change.
export function optionsOf(state, about, { method, look, environment = '' }) {
  const own = pairsOf(look), isTurned = state.frame !== '' && !about.moves && !own.some(([name]) => ['turntable', 'views', 'camera-path'].includes(name));
  const given = [['anti-aliasing', method], ['camera-azimuth-angle', state.azimuth], ['camera-elevation-angle', state.elevation], ['camera-view-angle', state.angle],
    ['hdri-file', environment], ['turntable', isTurned ? String(about.frames) : ''], ['camera-index', isTurned && about.has_own_camera ? '0' : '']];
  return [...own.filter(([name]) => name === 'quality'), ['resolution', state.size.replace('x', ',')], ...given.filter(([, value]) => value !== ''), ...own.filter(([name]) => name !== 'quality')];
}

/// The command of the native program that makes the same image, by a method with or without history.
export function commandOf(state, about, { hasHistory, output, ...look }) {
  const frames = state.frame === '' ? [] : [['frame-start', state.frame], ['frame-end', state.frame]];
  if (frames.length && hasHistory && state.frame !== '0') frames.push(['warm-up', String(Math.min(32, state.frame))]);
  const quoted = (text) => (/^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);
  return ['./zoneplate render', quoted(state.scene), '-o', output, ...argumentsOf([...optionsOf(state, about, look), ...frames]).map(quoted)].join(' ');
}
