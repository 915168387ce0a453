// Conversions between stored values, linear light and the codes of the screen.

export const decodeSrgb = (v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
export const encodeSrgb = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
const clamp01 = (v) => (v > 0 ? Math.min(1, v) : 0);

/// The value of half-float bits.
export function valueOfHalf(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = bits >> 10 & 31, rest = bits & 1023;
  if (exponent === 31) return rest ? NaN : sign * Infinity;
  return sign * (exponent ? (1 + rest / 1024) * 2 ** (exponent - 15) : rest * 2 ** -24);
}

export const oneAsHalf = 0x3c00;

/// The 8-bit code of light at an exposure of `stops`.
export const screenCode = (light, stops) => Math.floor(255 * encodeSrgb(clamp01(light * 2 ** stops)) + 0.5);

/// For every stored value of a picture, the 8-bit code that is displayed at an exposure of `stops`.
const tables = new Map();
export function screenCodes(picture, stops) {
  const key = `${picture.values} ${picture.depth} ${stops}`;
  if (tables.has(key)) return tables.get(key);
  if (tables.size > 40) tables.clear();
  const count = 1 << picture.depth, table = new Uint8Array(count);
  for (let i = 0; i < count; ++i) {
    const code = i / (count - 1);
    table[i] = picture.values === 'halves' ? screenCode(valueOfHalf(i), stops)
      : stops === 0 ? Math.floor(255 * code + 0.5) : screenCode(decodeSrgb(code), stops);
  }
  tables.set(key, table);
  return table;
}

/// The stored value of a pixel as codes in [0, 1] (sRGB, straight alpha) and as linear light.
export function pixelOf(picture, x, y) {
  const at = 4 * (y * picture.width + x), stored = [...picture.data.subarray(at, at + 4)];
  if (picture.values === 'halves') {
    const linear = stored.map(valueOfHalf), alpha = linear[3];
    const codes = linear.slice(0, 3).map((v) => encodeSrgb(clamp01(alpha > 0 ? v / alpha : v)));
    return { stored, linear: linear.slice(0, 3), codes, alpha };
  }
  const codes = stored.map((v) => v / (2 ** picture.depth - 1));
  return { stored, linear: codes.slice(0, 3).map(decodeSrgb), codes: codes.slice(0, 3), alpha: codes[3] };
}
