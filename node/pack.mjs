// SPDX-License-Identifier: Apache-2.0
// Makes the package for Node and browsers: node node/pack.mjs PROGRAM BUILD_FOLDER, with the native program, and the
// folder of the preset web, in which zoneplate_node was built. Writes BUILD_FOLDER/node/package, which `npm pack` takes
// as it is, and its archive, BUILD_FOLDER/node/zoneplate-VERSION.tgz. Equal inputs give equal bytes.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import zlib from 'node:zlib';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { typesOf } from './types.mjs';

const root = path.dirname(path.dirname(fileURLToPath(import.meta.url)));
const [program, build] = process.argv.slice(2).map((name) => path.resolve(name));
const folder = path.join(build, 'node/package');
const at = (name) => path.join(folder, name);
const read = (name) => fs.readFileSync(path.join(root, name), 'utf8');
const [, version] = /project\(Zoneplate VERSION ([\d.]+)/.exec(read('CMakeLists.txt'));

fs.rmSync(path.dirname(folder), { recursive: true, force: true });
fs.mkdirSync(folder, { recursive: true });
for (const name of fs.readdirSync(path.join(root, 'node/package'))) fs.copyFileSync(path.join(root, 'node/package', name), at(name));
for (const name of ['zoneplate.js', 'zoneplate.wasm']) fs.copyFileSync(path.join(build, name), at(name));
for (const name of ['LICENSE', 'THIRD_PARTY.md']) fs.copyFileSync(path.join(root, name), at(name));
// The document without its image and without links to other documents, which a package does not have.
fs.writeFileSync(at('README.md'), read('docs/node.md').replace(/^!\[.*\n\n/gm, '').replace(/\[([^\]]*)\]\((?!\w+:)[^)]*\)/g, '$1'));

// The licences of the libraries whose code it contains.
fs.mkdirSync(at('licenses'));
for (const name of fs.readdirSync(path.join(build, 'libraries'))) fs.copyFileSync(path.join(build, 'libraries', name, 'debian/copyright'), at(`licenses/${name}.txt`));

// CommonJS, which test runners require, of the modules without imports.
for (const name of ['pool', 'requests']) {
  const text = read(`node/package/${name}.js`), names = [...text.matchAll(/^export (?:class|function) (\w+)/gm)].map(([, found]) => found);
  fs.writeFileSync(at(`${name}.cjs`), `'use strict';\n${text.replace(/^export /gm, '')}\nmodule.exports = { ${names.join(', ')} };\n`);
}

for (const name of ['index', 'matcher']) fs.writeFileSync(at(`${name}.d.cts`), read(`node/package/${name}.d.ts`).replaceAll(/'\.\/(index|options)\.js'/g, "'./$1.cjs'"));

// The prepared studio, from the cache of the program: the package would need seconds for it.
const cache = fs.mkdtempSync(path.join(os.tmpdir(), 'zoneplate-cache-'));
execFileSync(program, ['render', 'teapot', '--size', '16', '-o', path.join(cache, 'image.png'), '--quiet'], { env: { ...process.env, XDG_CACHE_HOME: cache } });
const [made] = fs.readdirSync(path.join(cache, 'zoneplate')).filter((name) => name.endsWith('.env'));
fs.copyFileSync(path.join(cache, 'zoneplate', made), at('studio.env'));
fs.rmSync(cache, { recursive: true });

const entry = (name) => ({ require: { types: `./${name}.d.cts`, default: `./${name}.cjs` }, default: { types: `./${name}.d.ts`, default: `./${name}.js` } });
fs.writeFileSync(at('package.json'), `${JSON.stringify({
  name: 'zoneplate',
  version,
  description: 'Software renderer and antialiasing laboratory: 3D models to images without a GPU or a browser',
  keywords: ['renderer', 'gltf', 'antialiasing', 'thumbnail', 'visual-regression', 'wasm'],
  license: 'Apache-2.0',
  type: 'module',
  engines: { node: '>=18' },
  bin: { zoneplate: './cli.js' },
  types: './index.d.ts',
  exports: {
    '.': { browser: { types: './index.d.ts', default: './browser.js' }, ...entry('index') },
    './matcher': entry('matcher'),
    './package.json': './package.json',
  },
}, null, 2)}\n`);

// The table of options, which the command and the types take from the module.
const { list, close } = await import(pathToFileURL(at('index.js')).href), { options } = await list();
close();
fs.writeFileSync(at('options.js'), `// SPDX-License-Identifier: Apache-2.0\n// Made by pack.mjs from the table of options.\nexport default ${JSON.stringify(options, null, 1)};\n`);
for (const ending of ['d.ts', 'd.cts']) fs.writeFileSync(at(`options.${ending}`), typesOf(options));

// npm's archive: a tar of the folder `package`, without owners and with the time that npm states for all files.
execFileSync('chmod', ['-R', 'u=rwX,go=rX', folder]);
fs.chmodSync(at('cli.js'), 0o755);
const tar = execFileSync('tar', ['--create', '--sort=name', '--format=ustar', '--owner=0', '--group=0', '--numeric-owner', '--mtime=1985-10-26 08:15:00 UTC',
  '--directory', path.dirname(folder), 'package'], { maxBuffer: 1 << 30 });
const archive = path.join(build, `node/zoneplate-${version}.tgz`);
fs.writeFileSync(archive, zlib.gzipSync(tar, { level: 9 }));
console.log(archive);
