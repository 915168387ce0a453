// The lessons of the page. A step is a text, a state of the page (state.js), and its knobs: [part of the state, parameter, changes of its range].
// Lessons whose names are those of `zoneplate demo` continue them.

export const lessons = [
  {
    name: 'jaggies', title: 'Jaggies',
    steps: [
      { text: 'With one sample per pixel, a pixel is covered completely or not at all: edges become stairs. On the right side of the slider, coverage is tested at several samples. Change their number.',
        state: { b: 'msaa:n=4', view: '6,249,30' }, knobs: [['b', 'n']] },
      { text: 'Multisampling (B) tests coverage and depth at every sample, and shades each surface once per pixel. Step through the samples of the chosen pixel: on the outline, some have the colour of the teapot and some that of the background. Their mean is the pixel.',
        state: { b: 'msaa:n=8', layout: 'grid', size: '320x180', view: '12,238,66', pixel: '238,66' }, knobs: [['b', 'n'], ['b', 'centroid']] },
      { text: 'Supersampling (B) shades every sample. Highlights inside the outline become smooth as well, and the time grows with the number of samples.',
        state: { scene: 'metal', a: 'msaa:n=16', b: 'ssaa:n=4' }, knobs: [['a', 'n'], ['b', 'n'], ['b', 'pattern']] },
    ],
  },
  {
    name: 'antialiasing', title: 'Filters after rendering',
    steps: [
      { text: 'FXAA reads a finished image with one sample per pixel. It finds edges by their contrast and moves the sampling position across them. Edges close to an axis have long stairs: how far the search goes is chosen by the preset.',
        state: { scene: 'near-axis', b: 'fxaa', view: '3,330,180' }, knobs: [['b', 'preset'], ['b', 'threshold'], ['b', 'subpixel']] },
      { text: 'SMAA follows each edge to its ends and blends by the area under the line through them.',
        state: { scene: 'near-axis', a: 'fxaa', b: 'smaa', view: '3,330,180' }, knobs: [['b', 'preset'], ['b', 'edges'], ['b', 'mode']] },
      { text: 'What is thinner than a pixel is lost before a filter can see it: the wires stay broken. More samples are the only remedy.',
        state: { scene: 'wires', a: 'smaa', b: 'msaa:n=8', view: '3,250,90' }, knobs: [['a', 'preset'], ['b', 'n']] },
    ],
  },
  {
    name: 'moire', title: 'Moiré',
    steps: [
      { text: 'Towards the horizon the squares become smaller than pixels. Waves shorter than two pixels do not vanish: they appear as others, their aliases. Supersampling moves the limit, it does not remove it.',
        state: { scene: 'checkerboard', b: 'ssaa:n=4', looka: 'texture-filter=nearest', lookb: 'texture-filter=nearest' }, knobs: [['b', 'n'], ['b', 'filter']] },
      { text: 'Filtering must come before sampling: mip levels are copies of the texture that are averaged in advance. Compare the filters on the distant squares.',
        state: { scene: 'checkerboard', b: 'none', looka: 'texture-filter=nearest', lookb: 'texture-filter=trilinear' }, knobs: [['lookb', 'texture-filter']] },
    ],
  },
  {
    name: 'exact-coverage', title: 'Exact coverage',
    steps: [
      { text: 'B is the exact area of each surface in each pixel. A grid of n × n samples has n steps along an edge close to an axis. Press D for the difference, and raise n.',
        state: { scene: 'crossing', a: 'ssaa:n=2', b: 'analytic', layout: 'grid', size: '480x270' }, knobs: [['a', 'n'], ['a', 'pattern']] },
      { text: 'The same areas under wider filters than the pixel: smoother edges, less sharpness, and ringing where a filter has negative lobes.',
        state: { scene: 'near-axis', a: 'analytic', b: 'analytic:filter=mitchell', view: '6,330,180' }, knobs: [['b', 'filter']] },
    ],
  },
  {
    name: 'gamma', title: 'Gamma',
    steps: [
      { text: 'Coverage is light, and light adds up linearly. If sRGB values are blended instead (A), half-covered pixels are too dark and thin bright lines look like ropes.',
        state: { scene: 'thin-diagonal', a: 'msaa:n=8,mix=codes', b: 'msaa:n=8', view: '4,225,180' }, knobs: [['a', 'mix'], ['b', 'mix'], ['b', 'n']] },
    ],
  },
  {
    name: 'hdr-edges', title: 'Edges of bright light',
    steps: [
      { text: 'The sun is 120 times as bright as white. In the mean of linear light, one bright sample of eight makes the pixel white: the edge remains a stair. Smaller weights for brighter samples, or the mean after tone mapping, make it smooth, and lose light.',
        state: { scene: 'sun-roof', a: 'msaa:n=8', b: 'msaa:n=8,resolve=karis', view: '4,395,160' }, knobs: [['b', 'resolve'], ['b', 'n']] },
      { text: 'Tone-mapping curves bring unbounded light into the range of the display.',
        state: { scene: 'sun-roof', a: 'msaa:n=8', b: 'msaa:n=8', lookb: 'tone-mapping=agx' }, knobs: [['lookb', 'tone-mapping'], ['lookb', 'exposure']] },
    ],
  },
  {
    name: 'zbuffer', title: 'The z-buffer',
    steps: [
      { text: 'The painter’s algorithm (A) draws triangles from the farthest to the nearest. Each of these three is before the next: no order is correct. The z-buffer (B) keeps the nearest surface at each sample.',
        state: { scene: 'cyclic', a: 'msaa:n=4', looka: 'visibility=painter', layout: 'grid', size: '480x270' }, knobs: [['looka', 'visibility'], ['lookb', 'visibility']] },
      { text: 'Squares that pass through each other: each is partly before and partly behind the others.',
        state: { scene: 'crossing', a: 'msaa:n=4', looka: 'visibility=painter', layout: 'grid', size: '480x270' }, knobs: [['looka', 'visibility'], ['lookb', 'visibility']] },
    ],
  },
  {
    name: 'shading-frequency', title: 'Flat, Gouraud and Phong shading',
    steps: [
      { text: 'Lights may be evaluated once for each triangle, at its vertices, or at every fragment. Few triangles make the difference visible: change their number, and turn the teapot.',
        state: { scene: 'teapot:divisions=4', a: 'msaa:n=4', looka: 'shading-frequency=flat' }, knobs: [['looka', 'shading-frequency'], ['lookb', 'shading-frequency'], ['scene', 'divisions']] },
    ],
  },
  {
    name: 'texture-filters', title: 'Texture filters',
    steps: [
      { text: 'A pixel of the distant floor covers many texels in a long and narrow ellipse. The nearest texel flickers; trilinear filtering blurs, since its footprint is a square; probes and EWA follow the ellipse.',
        state: { scene: 'tiles', a: 'none', b: 'none', looka: 'texture-filter=nearest', lookb: 'texture-filter=ewa' }, knobs: [['looka', 'texture-filter'], ['lookb', 'texture-filter']] },
    ],
  },
  {
    name: 'normal-map-aliasing', title: 'Highlights',
    steps: [
      { text: 'Multisampling shades once per pixel. Where normals change within a pixel, highlights sparkle. Wider highlights, by the variance of the normals, are calm at the same cost. Press Play.',
        state: { scene: 'metal', a: 'msaa:n=4', b: 'msaa:n=4', lookb: 'specular-aa=full', layout: 'grid', frame: '0', size: '480x270' }, knobs: [['lookb', 'specular-aa'], ['b', 'n']] },
    ],
  },
  {
    name: 'shadows', title: 'Shadows',
    steps: [
      { text: 'A shadow map is an image of depths from the light, with aliasing of its own. One ray to the light is the exact shadow of a point; many rays to an extended light give a penumbra.',
        state: { a: 'msaa:n=4', looka: 'shadows=hard;ground=shadow', lookb: 'shadows=soft;ground=shadow' }, knobs: [['looka', 'shadows'], ['lookb', 'shadows'], ['lookb', 'ambient-occlusion']] },
    ],
  },
  {
    name: 'upscaling', title: 'Upscaling',
    steps: [
      { text: 'Both images are rendered with a quarter of the pixels. A is enlarged by a filter. B accumulates jittered frames at the size of the image. Enlarge an edge, and change the scale.',
        state: { a: 'bilinear:scale=2', b: 'fsr2:scale=2', view: '6,249,30' }, knobs: [['a', 'scale'], ['b', 'scale']] },
      { text: 'Wires that move, from a quarter of the pixels in each frame. TAAU (A) and FSR 3 (B) move the accumulated image along, and must decide which part of it is still valid: FSR 3 clamps it to the colours of the new pixels, TAAU to those of the last frames too. Press Play.',
        state: { scene: 'panning-wires', a: 'taau:scale=2', b: 'fsr3:scale=2', frame: '12', layout: 'grid', size: '480x270' }, knobs: [['b', 'scale'], ['b', 'locks'], ['b', 'rectify']] },
    ],
  },
  {
    name: 'temporal', title: 'Accumulation over frames',
    steps: [
      { text: 'One sample per pixel and frame, each at another point of the pixel, averaged with the last result, which is moved along. Press Play: without it (A) the wires crawl.',
        state: { scene: 'panning-wires', b: 'taa', frame: '12', layout: 'grid', size: '480x270' }, knobs: [['b', 'preset'], ['b', 'length'], ['b', 'alpha']] },
    ],
  },
  {
    name: 'ghosting', title: 'Ghosting',
    steps: [
      { text: 'The disc has jumped. Without tests (A) its history remains as a ghost. With them (B) history is dropped where the last frame had another object, or clipped to the colours of the neighbours.',
        state: { scene: 'teleport', a: 'taa:rectify=none,reject=none,blend=fixed', b: 'taa', frame: '17', layout: 'grid', size: '480x270' }, knobs: [['b', 'rectify'], ['b', 'reject'], ['b', 'gamma']] },
      { text: 'In the frame of the jump, the pixels that the disc has left have no history, and a single sample: the edges of the spoke there are stairs (A). With new=smaa, SMAA smooths these pixels, and no others (B).',
        state: { scene: 'teleport', a: 'taa', b: 'taa:new=smaa', frame: '16', layout: 'grid', size: '480x270', view: '6,255,180' }, knobs: [['b', 'new']] },
      { text: 'The oracle decides by rays to the triangles of the last frame whether a surface was visible: what remains is the limit of accumulation itself.',
        state: { scene: 'teleport', a: 'taa', b: 'oracle-taa', frame: '17', layout: 'grid', size: '480x270' }, knobs: [['a', 'rectify'], ['a', 'reject'], ['b', 'most']] },
    ],
  },
  {
    name: 'wagon-wheel', title: 'The wagon wheel',
    steps: [
      { text: 'A film samples time. A wheel that turns by a whole spoke from frame to frame looks the same in every frame: it appears to stand still. If it turns by 0.9 spokes a frame, it appears to roll backwards by 0.1. Slide from 0 to 0.9: both directions of motion have the same two images.',
        state: { scene: 'wheel', a: 'none', b: 'ssaa:n=4', size: '480x270' }, knobs: [['scene', 'turn', { low: 0, high: 2, decimals: 2 }], ['scene', 'spokes', { low: 1, high: 60 }]] },
    ],
  },
  {
    name: 'foliage', title: 'Cut-out leaves',
    steps: [
      { text: 'Leaves are triangles with holes in their texture. One test of alpha per pixel makes every leaf a stair, whatever the number of coverage samples. Test at every sample, or turn alpha into coverage.',
        state: { scene: 'foliage', a: 'msaa:n=8', b: 'msaa:n=8,alpha=coverage', view: '4,320,200' }, knobs: [['b', 'alpha'], ['b', 'n']] },
    ],
  },
];

/// The text of a step's state; a lesson begins with its first.
export const lessonOf = (name) => lessons.find((lesson) => lesson.name === name);
