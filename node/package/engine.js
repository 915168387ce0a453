// SPDX-License-Identifier: Apache-2.0
// The module of the renderer within a worker, and its answers to requests (node/native/module.cpp).
const arrays = { uint8: Uint8Array, uint16: Uint16Array, uint32: Uint32Array, int32: Int32Array, float32: Float32Array, float64: Float64Array };

/// A worker whose memory has grown beyond this many bytes is replaced: memory of WebAssembly never shrinks.
const mostMemory = 1 << 29;

/// `makeModule` is that of zoneplate.js, `code` the compiled WebAssembly, `studio` the bytes of studio.env. `host`, in
/// Node, is { mount(FS), folder(path) } for the files of the machine.
export async function makeEngine(makeModule, code, studio, host) {
  const module = await makeModule({
    instantiateWasm(imports, done) {
      WebAssembly.instantiate(code, imports).then((instance) => done(instance));
      return {};
    },
    print() {},
    printErr() {},
  });
  const { FS } = module;
  FS.writeFile('/studio.env', studio);
  FS.mkdir('/zoneplate.files');
  FS.mkdir('/zoneplate.out'); // what a request writes

  const keep = (bytes) => {
    const at = module._malloc(bytes.length);
    if (at === 0) throw Object.assign(new Error('not enough memory'), { status: 5 });
    module.HEAPU8.set(bytes, at);
    return at;
  };

  /// Writes files of a request below /zoneplate.files, by their relative paths.
  const write = (files) => {
    for (const [name, bytes] of Object.entries(files)) {
      const place = `/zoneplate.files/${name}`;
      FS.mkdirTree(place.slice(0, place.lastIndexOf('/')));
      FS.writeFile(place, new Uint8Array(bytes.buffer ?? bytes, bytes.byteOffset ?? 0, bytes.byteLength));
    }
  };
  const remove = (place) => {
    for (const name of FS.readdir(place).filter((entry) => entry !== '.' && entry !== '..')) {
      const path = `${place}/${name}`;
      if (FS.isDir(FS.stat(path).mode)) {
        remove(path);
        FS.rmdir(path);
      } else FS.unlink(path);
    }
  };

  /// The reply to one request; `isSpent`: the module cannot be used again.
  return function answer({ files, folder, pixels = {}, ...request }) {
    const places = [];
    try {
      host?.mount(FS);
      write(files);
      FS.chdir(folder === undefined ? '/zoneplate.files' : host.folder(folder));
      for (const [name, { data, ...about }] of Object.entries(pixels)) {
        request[name] = { ...about, at: keep(new Uint8Array(data.buffer, data.byteOffset, data.byteLength)) };
        places.push(request[name].at);
      }
      const text = new TextEncoder().encode(`${JSON.stringify(request)}\0`), at = keep(text);
      places.push(at);
      const begin = module._zoneplate_answer(at), end = module.HEAPU8.indexOf(0, begin);
      const result = JSON.parse(new TextDecoder().decode(module.HEAPU8.slice(begin, end)).replaceAll('/zoneplate.host/', '/').replaceAll(/\/zoneplate\.(files|out)\//g, ''));
      const isSpent = module.HEAPU8.length > mostMemory || result.status === 5;
      for (const owner of [result, result.arrays ?? {}])
        for (const [name, value] of Object.entries(owner)) {
          if (typeof value?.at !== 'number') continue;
          const { at: place, type, shape } = value;
          const Type = arrays[type], count = shape.reduce((a, b) => a * b, 1);
          owner[name] = { shape, data: new Type(module.HEAPU8.slice(place, place + count * Type.BYTES_PER_ELEMENT).buffer) };
        }
      const written = FS.readdir('/zoneplate.out').filter((name) => name !== '.' && name !== '..');
      if (request.verb === 'save') result.files = Object.fromEntries(written.map((name) => [name, { data: FS.readFile(`/zoneplate.out/${name}`) }]));
      return { ...result, isSpent };
    } catch (error) { // a trap of WebAssembly, or an end of the module
      return { error: `${request.model ?? request.verb}: the renderer failed: ${error.message ?? error}`, status: error.status ?? 1, isSpent: true };
    } finally {
      try {
        for (const place of places) module._free(place);
        FS.chdir('/');
        remove('/zoneplate.files');
        remove('/zoneplate.out');
        host?.unmount(FS);
      } catch { /* the module is replaced */ }
    }
  };
}

/// The buffers of a reply, which are moved to the caller.
export function buffersOf(reply) {
  return [reply, reply.arrays ?? {}, reply.files ?? {}].flatMap((owner) => Object.values(owner)).map((value) => value?.data?.buffer).filter((buffer) => buffer instanceof ArrayBuffer);
}
