// SPDX-License-Identifier: Apache-2.0
// The files of the machine as a folder /zoneplate.host of the module's file system, to be read alone.
import fs from 'node:fs';
import path from 'node:path';

const codes = { EACCES: 2, EINVAL: 28, EISDIR: 31, ELOOP: 32, ENOENT: 44, ENOTDIR: 54, EPERM: 63 }; // of WASI, else EIO
const EIO = 29;

/// A path of the machine within the module: /models/a.glb, or C:/models/a.glb in Windows, below /zoneplate.host.
export const withinHost = (place) => `/zoneplate.host/${path.resolve(place).replaceAll(path.sep, '/').replace(/^\//, '')}`;

function makeType(FS) {
  const attempt = (action) => {
    try {
      return action();
    } catch (error) {
      if (error.code === undefined) throw error;
      throw new FS.ErrnoError(codes[error.code] ?? EIO);
    }
  };
  const placeOf = (node) => {
    const parts = [];
    for (; node.parent !== node; node = node.parent) parts.unshift(node.name);
    return path.sep === '/' || parts.length === 0 ? `/${parts.join('/')}` : `${parts.join('/')}/`;
  };
  const create = (parent, name, mode) => {
    const node = FS.createNode(parent, name, mode, 0);
    node.node_ops = {
      getattr: (of) => {
        const { ino, mode: current, nlink, uid, gid, size, atime, mtime, ctime, blksize, blocks } = attempt(() => fs.lstatSync(placeOf(of)));
        return { dev: 1, ino, mode: current, nlink, uid, gid, rdev: 0, size, atime, mtime, ctime, blksize: blksize ?? 4096, blocks: blocks ?? Math.ceil(size / 512) };
      },
      lookup: (folder, child) => {
        const { mode: found } = attempt(() => fs.lstatSync(path.posix.join(placeOf(folder), child)));
        return create(folder, child, found);
      },
      readdir: (folder) => ['.', '..', ...attempt(() => fs.readdirSync(placeOf(folder)))],
      readlink: (link) => {
        const target = attempt(() => fs.readlinkSync(placeOf(link)));
        return path.isAbsolute(target) ? withinHost(target) : target;
      },
    };
    node.stream_ops = {
      open: (stream) => {
        if (FS.isFile(stream.node.mode)) stream.file = attempt(() => fs.openSync(placeOf(stream.node)));
      },
      close: (stream) => {
        if (stream.file !== undefined) fs.closeSync(stream.file);
      },
      read: (stream, buffer, offset, length, position) => (length === 0 ? 0 : attempt(() => fs.readSync(stream.file, buffer, offset, length, position))),
      llseek: (stream, offset, whence) => {
        const from = [0, stream.position, FS.isFile(stream.node.mode) ? attempt(() => fs.fstatSync(stream.file)).size : 0][whence];
        if (from + offset < 0) throw new FS.ErrnoError(28); // EINVAL
        return from + offset;
      },
    };
    return node;
  };
  return { mount: () => create(null, '/', 0o40755) };
}

/// Mounted for each request, so that nothing is kept of files that change.
export const host = {
  folder: withinHost,
  mount(FS) {
    if (!FS.analyzePath('/zoneplate.host').exists) FS.mkdir('/zoneplate.host');
    FS.mount(makeType(FS), {}, '/zoneplate.host');
  },
  unmount: (FS) => FS.unmount('/zoneplate.host'),
};
