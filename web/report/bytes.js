// The decoder of text_of_bytes (src/zoneplate/report/html_page.h): two characters of 91 hold 13 bits.

/// The bytes that a text contains; perhaps followed by a zero.
export function bytesOfText(text) {
  const out = new Uint8Array(Math.floor(text.length / 2 * 13 / 8));
  const digit = (i) => {
    const code = text.charCodeAt(i);
    return code - 33 - (code > 34) - (code > 38) - (code > 60);
  };
  let bits = 0, count = 0, end = 0;
  for (let i = 0; i + 1 < text.length; i += 2) {
    bits |= (digit(i) + 91 * digit(i + 1)) << count;
    count += 13;
    for (; count >= 8; count -= 8, bits >>= 8) out[end++] = bits & 255;
  }
  return out;
}
