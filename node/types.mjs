// SPDX-License-Identifier: Apache-2.0
// The types of the options that are rows of the table of options (src/zoneplate/job/options.cpp).
import { optionName } from './package/requests.js';

/// Rows for which index.d.ts has a shorter name or another type.
const own = ['resolution', 'anti-aliasing', 'aov', 'background-color', 'no-background', 'no-cull', 'crop', 'environment', 'ambient-occlusion', 'max-memory'];
const ofFiles = ['jpeg-quality', 'webp-quality', 'png-compression', 'exr-compression'];
const isReading = ({ name, group }) => group === 'Input' || /^(max-|strict$|allow-path$)/.test(name);
const isOfFiles = ({ name, group }) => group === 'Sequences' || ofFiles.includes(name);

function typeOf({ kind, value, choices, name }) {
  if (kind === 'switch') return 'boolean';
  if (kind === 'number' || kind === 'whole') return 'number';
  if (kind === 'choice') return choices.split(',').map((choice) => (/^\d+$/.test(choice) ? choice : `'${choice}'`)).join(' | ');
  if (name === 'section') return 'string | number[] | (string | number[])[]';
  if (name === 'allow-path') return 'string | string[]';
  return `string | ${value.includes(',') ? 'number[]' : 'number'}`;
}

const memberOf = (row) => `  /** ${row.summary.replaceAll('\n', ' ').replaceAll('*/', '* /')}. */\n  ${optionName(row.name)}?: ${typeOf(row)};\n`;

/// The text of options.d.ts for the rows of the module's list.
export function typesOf(rows) {
  const members = (isOf) => rows.filter((row) => !own.includes(row.name) && isOf(row)).map(memberOf).join('');
  return `// SPDX-License-Identifier: Apache-2.0
// Made by pack.mjs from the table of options.

/** Options of reading a model. */
export interface ReadingOptions {
${members(isReading)}}

/** Options of an image. */
export interface ImageOptions {
${members((row) => !isReading(row) && !isOfFiles(row))}}

/** Options of sequences and of files. */
export interface FileOptions {
${members(isOfFiles)}}
`;
}
