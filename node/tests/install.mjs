// SPDX-License-Identifier: Apache-2.0
// The archive of the package, installed in an empty folder as `npm install` does it: there are no scripts to run.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';

export const program = path.resolve(process.env.ZONEPLATE ?? 'build/check/zoneplate');
const build = path.resolve(process.env.ZONEPLATE_NODE ?? 'build/web/node');
export const archive = path.join(build, fs.readdirSync(build).find((name) => name.endsWith('.tgz')));

/// A folder with the package in node_modules.
export function install() {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'zoneplate-node-')), place = path.join(folder, 'node_modules/zoneplate');
  fs.mkdirSync(place, { recursive: true });
  execFileSync('tar', ['--extract', '--file', archive, '--strip-components=1', '--directory', place]);
  fs.mkdirSync(path.join(folder, 'node_modules/.bin'));
  fs.symlinkSync('../zoneplate/cli.js', path.join(folder, 'node_modules/.bin/zoneplate'));
  return folder;
}
