// SPDX-License-Identifier: Apache-2.0
'use strict';
const fs = require('node:fs');
const path = require('node:path');
const { randomUUID } = require('node:crypto');

/// Writes a file whole or not at all: under a hidden name of its folder, which is then renamed. What is no file, such as
/// /dev/stdout, is written as it is.
exports.saveFile = (place, data) => {
  if (fs.existsSync(place) && !fs.statSync(place).isFile()) return fs.writeFileSync(place, data);
  const target = fs.existsSync(place) ? fs.realpathSync(place) : place;
  const hidden = path.join(path.dirname(target), `.${randomUUID()}.tmp`);
  try {
    fs.writeFileSync(hidden, data, { flag: 'wx' });
    fs.renameSync(hidden, target);
  } catch (error) {
    fs.rmSync(hidden, { force: true });
    throw error;
  }
};
