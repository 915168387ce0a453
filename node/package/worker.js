// SPDX-License-Identifier: Apache-2.0
// A worker of Node. The module's code was made for workers of browsers, which have these names.
import { parentPort, workerData } from 'node:worker_threads';
import { buffersOf, makeEngine } from './engine.js';
import { host } from './host-files.js';

globalThis.self ??= globalThis;
globalThis.location ??= { href: import.meta.url };
const { default: makeModule } = await import('./zoneplate.js');
const answer = await makeEngine(makeModule, workerData.code, workerData.studio, host);
parentPort.on('message', (request) => {
  const reply = answer(request);
  parentPort.postMessage(reply, buffersOf(reply));
});
