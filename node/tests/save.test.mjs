// Files are written whole or not at all.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { test } from 'node:test';
import { saveFile } from '../package/save.cjs';

test('a file is replaced as a whole, and nothing is left of one that fails', () => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'zoneplate-save-')), at = (name) => path.join(folder, name);
  saveFile(at('a.png'), Buffer.from('first'));
  saveFile(at('a.png'), Buffer.from('second'));
  fs.symlinkSync('a.png', at('link.png'));
  saveFile(at('link.png'), Buffer.from('third'));
  assert.equal(fs.readFileSync(at('a.png'), 'utf8'), 'third');
  assert.ok(fs.lstatSync(at('link.png')).isSymbolicLink());
  fs.mkdirSync(at('folder.png'));
  assert.throws(() => saveFile(at('folder.png'), Buffer.from('none')), { code: 'EISDIR' });
  assert.throws(() => saveFile(at('missing/b.png'), Buffer.from('none')), { code: 'ENOENT' });
  assert.throws(() => saveFile(at('a.png'), { not: 'bytes' }), { code: 'ERR_INVALID_ARG_TYPE' });
  assert.equal(fs.readFileSync(at('a.png'), 'utf8'), 'third');
  assert.deepEqual(fs.readdirSync(folder).sort(), ['a.png', 'folder.png', 'link.png']);
  fs.rmSync(folder, { recursive: true });
});
