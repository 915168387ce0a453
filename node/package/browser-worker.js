// SPDX-License-Identifier: Apache-2.0
// A worker of a browser. The first message is { code, studio }.
import { buffersOf, makeEngine } from './engine.js';
import makeModule from './zoneplate.js';

let answer;
onmessage = async ({ data }) => {
  if (data.code) {
    answer = makeEngine(makeModule, data.code, data.studio);
    return;
  }
  const reply = (await answer)(data);
  postMessage(reply, buffersOf(reply));
};
