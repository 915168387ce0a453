// A metric against cost: points on logarithmic axes, or on a linear one for values of which more is better, with the Pareto front. Every point is a button with a name.
import { drawing, element } from './dom.js';

/// Ticks of a logarithmic axis: powers of ten, and multiples of them if there are few.
function ticksOf(low, high) {
  const make = (factors) => {
    const ticks = [];
    for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); ++power)
      for (const factor of factors) ticks.push(factor * 10 ** power);
    return ticks.filter((tick) => tick >= low * 0.999 && tick <= high * 1.001);
  };
  return [[1], [1, 2, 5]].map(make).find((ticks) => ticks.length > 3) ?? make([1, 1.5, 2, 3, 4, 5, 7]);
}

/// Ticks of a linear axis: three to eight multiples of 1, 2 or 5 times a power of ten.
function linearTicksOf(low, high) {
  const power = 10 ** Math.floor(Math.log10((high - low) / 3));
  const step = power * [5, 2, 1].find((factor) => (high - low) / (factor * power) >= 3);
  const ticks = [];
  for (let i = Math.ceil(low / step); i * step <= high; ++i) ticks.push(+(i * step).toPrecision(12));
  return ticks;
}

/// The points that have a place: of a logarithmic axis, those above 0.
export const usablePoints = ({ points, is_linear: isLinear }) =>
  points.filter(({ x, y }) => x > 0 && (isLinear ? y !== null : y > 0));

export function makePlot({ title, x: xLabel, y: yLabel, points, is_linear: isLinear }, go) {
  const room = element('div', { class: 'plot' });
  const usable = usablePoints({ points, is_linear: isLinear });
  const range = (name) => {
    const values = usable.map((point) => point[name]);
    return [Math.min(...values) / 1.25, Math.max(...values) * 1.25];
  };
  const linearRange = (values) => {
    const low = Math.min(...values), high = Math.max(...values), margin = (high - low) / 8 || 1;
    return [low - margin, high + margin];
  };
  const [x0, x1] = range('x'), [y0, y1] = isLinear ? linearRange(usable.map(({ y }) => y)) : range('y');

  function draw() {
    const width = Math.max(300, room.clientWidth), height = Math.round(Math.min(360, Math.max(280, width * 0.62)));
    const box = { left: 52, right: width - 14, top: 14, bottom: height - 44 };
    const atX = (v) => box.left + Math.log(v / x0) / Math.log(x1 / x0) * (box.right - box.left);
    const share = isLinear ? (v) => (v - y0) / (y1 - y0) : (v) => Math.log(v / y0) / Math.log(y1 / y0);
    const atY = (v) => box.bottom - share(v) * (box.bottom - box.top);
    const number = (v) => String(+v.toPrecision(3));
    const svg = drawing('svg', { width, height, viewBox: `0 0 ${width} ${height}`, role: 'group', 'aria-label': `${title}: ${usable.length} points` });
    for (const tick of ticksOf(x0, x1))
      svg.append(drawing('line', { class: 'grid', x1: atX(tick), x2: atX(tick), y1: box.top, y2: box.bottom }),
        drawing('text', { class: 'tick', x: atX(tick), y: box.bottom + 17, 'text-anchor': 'middle' }, number(tick)));
    for (const tick of isLinear ? linearTicksOf(y0, y1) : ticksOf(y0, y1))
      svg.append(drawing('line', { class: 'grid', x1: box.left, x2: box.right, y1: atY(tick), y2: atY(tick) }),
        drawing('text', { class: 'tick', x: box.left - 7, y: atY(tick) + 4, 'text-anchor': 'end' }, number(tick)));
    svg.append(drawing('text', { class: 'axis', x: (box.left + box.right) / 2, y: height - 6, 'text-anchor': 'middle' }, xLabel),
      drawing('text', { class: 'axis', x: 13, y: (box.top + box.bottom) / 2, 'text-anchor': 'middle', transform: `rotate(-90 13 ${(box.top + box.bottom) / 2})` }, yLabel));

    const front = usable.filter((point) => point.is_on_front).sort((a, b) => a.x - b.x);
    svg.append(drawing('polyline', { class: 'front', points: front.map((point) => `${atX(point.x)},${atY(point.y)}`).join(' ') }));
    // Names are placed greedily, those of the front first; a name that would cover another one or a point is left out.
    const taken = usable.map((point) => ({ left: atX(point.x) - 5, right: atX(point.x) + 5, top: atY(point.y) - 5, bottom: atY(point.y) + 5 }));
    const order = [...usable].sort((a, b) => b.is_on_front - a.is_on_front || (isLinear ? b.y - a.y : a.y - b.y));
    for (const point of order) {
      const x = atX(point.x), y = atY(point.y), text = drawing('text', {}, point.name), long = 6.4 * point.name.length;
      const mark = drawing('g', { role: 'button', tabindex: 0, class: `point${point.is_on_front ? ' on-front' : ''}`,
        'aria-label': `${point.name}: ${number(point.x)}, ${number(point.y)}${point.is_on_front ? ', on the Pareto front' : ''}`,
        'data-target': JSON.stringify([point.target.scene ?? null, point.target.image ?? null, null]),
        onclick: () => go(point.target), onkeydown: (event) => (event.key === 'Enter' || event.key === ' ') && (event.preventDefault(), go(point.target)) },
      drawing('title', {}, `${point.name}\n${xLabel}: ${number(point.x)}\n${yLabel}: ${number(point.y)}`),
      drawing('circle', { class: 'area', cx: x, cy: y, r: 12 }), drawing('circle', { class: 'dot', cx: x, cy: y, r: 4.5 }));
      for (const [dx, dy, anchor] of [[9, 4, 'start'], [-9, 4, 'end'], [7, -8, 'start'], [7, 16, 'start'], [-7, -8, 'end'], [-7, 16, 'end']]) {
        const left = anchor === 'start' ? x + dx : x + dx - long, name = { left, right: left + long, top: y + dy - 11, bottom: y + dy + 3 };
        if (name.left < box.left || name.right > box.right || name.top < 2 || name.bottom > box.bottom) continue;
        const own = usable.indexOf(point);
        if (taken.some((other, i) => i !== own && other.left < name.right && name.left < other.right && other.top < name.bottom && name.top < other.bottom)) continue;
        taken.push(name);
        for (const [k, v] of Object.entries({ x: x + dx, y: y + dy, 'text-anchor': anchor })) text.setAttribute(k, v);
        mark.append(text);
        break;
      }
      svg.append(mark);
    }
    room.replaceChildren(svg);
    room.dispatchEvent(new Event('drawn'));
  }
  new ResizeObserver(draw).observe(room);
  return element('figure', { class: 'cost' }, element('figcaption', {}, title), room);
}
