// The plot of a lesson: curves over two axes, from the points that the program computes.
import { drawing, element } from './report/dom.js';

const width = 520, height = 330, box = { left: 62, right: width - 16, top: 16, bottom: height - 50 };

/// Ticks of an axis: multiples of 1, 2 or 5 times a power of ten; of a logarithmic one, its powers of ten or more.
function ticksOf({ low, high, is_logarithmic: isLogarithmic }) {
  if (isLogarithmic) {
    const ticks = [];
    for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power)
      for (const factor of high / low < 1000 ? [1, 2, 5] : [1]) ticks.push(factor * 10 ** power);
    return ticks.filter((tick) => tick >= low * 0.999 && tick <= high * 1.001);
  }
  const rough = (high - low) / 5, power = 10 ** Math.floor(Math.log10(rough)), step = [1, 2, 5, 10].find((factor) => factor * power >= rough) * power;
  const first = Math.ceil(low / step - 1e-6);
  return Array.from({ length: Math.floor(high / step + 1e-6) - first + 1 }, (_, i) => (first + i) * step);
}

const textOf = (value) => String(+value.toPrecision(4)).replace('-', '−');
const isFinitePoint = ([x, y]) => Number.isFinite(x) && Number.isFinite(y) && x !== null && y !== null;

/// The range of an axis: its own, or that of the points.
function rangeOf(axis, values) {
  if (axis.low !== 0 || axis.high !== 0) return axis;
  const usable = values.filter((value) => Number.isFinite(value) && (!axis.is_logarithmic || value > 0)), low = Math.min(...usable), high = Math.max(...usable);
  return { ...axis, low, high: high > low ? high : low + 1 };
}

/// Parts of a line between points that are not finite.
function partsOf(points) {
  const parts = [[]];
  for (const point of points) {
    if (isFinitePoint(point)) parts.at(-1).push(point);
    else if (parts.at(-1).length) parts.push([]);
  }
  return parts.filter((part) => part.length);
}

function drawCurve({ mark, color, opacity, points, labels, labels_are_below: isBelow }, at) {
  const path = (list) => list.map(([x, y]) => `${at.x(x).toFixed(2)},${at.y(y).toFixed(2)}`).join(' '), out = [];
  const stepped = (part) => part.flatMap(([x, y], i) => (i + 1 < part.length ? [[x, y], [part[i + 1][0], y]] : [[x, y]]));
  const zero = Math.min(Math.max(0, at.low), at.high), style = `fill: none; stroke: ${color}; stroke-width: ${mark === 'dashed' ? 1.3 : 2}; stroke-linejoin: round; opacity: 1; stroke-dasharray: ${mark === 'dashed' ? '5 4' : 'none'}`;
  for (const part of partsOf(points)) {
    if (mark === 'area') out.push(drawing('polygon', { points: path([[part[0][0], zero], ...part, [part.at(-1)[0], zero]]), fill: color, 'fill-opacity': opacity }));
    if (mark === 'stems') out.push(...part.map(([x, y]) => drawing('line', { x1: at.x(x), x2: at.x(x), y1: at.y(zero), y2: at.y(y), stroke: color, 'stroke-width': 1.6 })));
    if (['line', 'dashed', 'line-and-points', 'area', 'steps'].includes(mark))
      out.push(drawing('polyline', { points: path(mark === 'steps' ? stepped(part) : part), style }));
    if (['points', 'line-and-points', 'stems'].includes(mark)) out.push(...part.map(([x, y]) => drawing('circle', { cx: at.x(x), cy: at.y(y), r: 3.4, fill: color })));
  }
  const texts = points.flatMap((point, i) => (labels[i] && isFinitePoint(point)
    ? [drawing('text', { class: 'name', x: at.x(point[0]) + (isBelow ? -6 : 6), y: at.y(point[1]) + (isBelow ? 13 : -6), 'text-anchor': isBelow ? 'end' : 'start' }, labels[i])] : []));
  return [...out, ...texts];
}

/// A figure of a plot with its name and text.
export function makeCurves({ name, text, plot }) {
  const { curves } = plot, points = curves.flatMap((curve) => curve.points).filter(isFinitePoint);
  const x = rangeOf(plot.x, points.map((point) => point[0])), y = rangeOf(plot.y, points.map((point) => point[1]));
  const share = ({ low, high, is_logarithmic: isLogarithmic }, value) => (isLogarithmic ? Math.log(Math.max(value, low * 1e-3) / low) / Math.log(high / low) : (value - low) / (high - low));
  const at = { x: (value) => box.left + share(x, value) * (box.right - box.left), y: (value) => box.bottom - share(y, value) * (box.bottom - box.top), low: y.low, high: y.high };
  const named = curves.filter((curve) => curve.name), words = [plot.title || name, `${y.label} over ${x.label}`, ...named.map((curve) => curve.name)].filter(Boolean).join('; ');
  const clip = `clip-${makeCurves.count = (makeCurves.count ?? 0) + 1}`;
  const svg = drawing('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': words },
    drawing('clipPath', { id: clip }, drawing('rect', { x: box.left - 4, y: box.top - 4, width: box.right - box.left + 8, height: box.bottom - box.top + 8 })),
    ...ticksOf(x).flatMap((tick) => [drawing('line', { class: 'grid', x1: at.x(tick), x2: at.x(tick), y1: box.top, y2: box.bottom }),
      drawing('text', { x: at.x(tick), y: box.bottom + 17, 'text-anchor': 'middle' }, textOf(tick))]),
    ...ticksOf(y).flatMap((tick) => [drawing('line', { class: 'grid', x1: box.left, x2: box.right, y1: at.y(tick), y2: at.y(tick) }),
      drawing('text', { x: box.left - 7, y: at.y(tick) + 4, 'text-anchor': 'end' }, textOf(tick))]),
    drawing('text', { x: (box.left + box.right) / 2, y: height - 12, 'text-anchor': 'middle' }, x.label),
    drawing('text', { x: 14, y: (box.top + box.bottom) / 2, 'text-anchor': 'middle', transform: `rotate(-90 14 ${(box.top + box.bottom) / 2})` }, y.label),
    drawing('g', { 'clip-path': `url(#${clip})` }, [...curves].sort((a, b) => (b.mark === 'dashed') - (a.mark === 'dashed')).flatMap((curve) => drawCurve(curve, at))));
  const key = element('ul', { class: 'key', 'aria-label': 'Curves' }, named.map((curve) => element('li', {}, element('span', { class: `swatch ${curve.mark}`, style: `--color: ${curve.color}` }), curve.name)));
  return element('figure', { class: 'curves' }, element('figcaption', {}, name), element('div', { class: 'paper' }, plot.title && plot.title !== name ? element('p', { class: 'title' }, plot.title) : null, svg, named.length ? key : null),
    text ? element('p', { class: 'words' }, text) : null);
}
