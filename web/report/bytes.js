// The decoder of text_of_bytes (src/zoneplate/report/html_page.h): a character holds 7 bits, one of two bytes 14.

/// The bytes that a text contains.
export function bytesOfText(text) {
  const out = new Uint8Array(Math.ceil(text.length * 1.75));
  let bits = 0, count = 0, end = 0;
  const add = (seven) => {
    bits = (bits << 7 | seven) & 0x3fff;
    count += 7;
    if (count >= 8) out[end++] = bits >> (count -= 8);
  };
  for (let i = 0; i < text.length; ++i) {
    const code = text.charCodeAt(i);
    add(code < 128 ? code : [0, 10, 13, 60][code >> 7 & 3]);
    if (code >= 512 && code < 1024) add(code & 127);
  }
  return out.slice(0, end);
}
