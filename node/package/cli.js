#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// The main verbs of the command `zoneplate`, with the same names of options, exit codes and bytes.
import fs from 'node:fs';
import path from 'node:path';
import { compare, info, list, renderFiles, ZoneplateError } from './index.js';
import rows from './options.js';
import { optionName, repeated } from './requests.js';
import { saveFile } from './save.cjs';

const elsewhere = 'the native program zoneplate has it';
const fail = (message, code = 'usage') => { throw new ZoneplateError(message, code); };

const number = (text, flag) => (text !== '' && Number.isFinite(Number(text)) ? Number(text) : fail(`${flag}: '${text}' is not a number`));
const numbers = (count) => (text, flag) => {
  const found = text.split(',').map((part) => number(part, flag));
  return found.length === count ? found : fail(`${flag}: '${text}', expected ${count} numbers`);
};
const word = (text) => text;

// Rows of: names, the option that gets the value, how its text is read, and whether it may be repeated: the option is then a
// list. Without a reader it is a flag of that value. Those of the table of options are texts.
const table = rows.map(({ name, names, kind }) => [names.split(','), optionName(name), kind === 'switch' ? true : word, repeated.includes(name)]);
const files = [[['-o', '--output'], 'file', word], [['--output-format'], 'output', word], [['-q', '--quiet'], 'quiet', true]];
const json = [['--json'], 'json', true];

/// The operands and options of arguments.
function parse(verb, rows, args) {
  const operands = [], options = {};
  for (let i = 0; i < args.length; ++i) {
    const [flag, given] = /^--[^=]+=/.test(args[i]) ? [args[i].slice(0, args[i].indexOf('=')), args[i].slice(args[i].indexOf('=') + 1)] : [args[i]];
    if (!flag.startsWith('-') || flag === '-') {
      operands.push(args[i]);
      continue;
    }
    const row = rows.find(([names]) => names.includes(flag)) ?? fail(`${verb}: no option '${flag}' in this package; ${elsewhere}`);
    const [, member, read, isList] = row;
    let value = read;
    if (typeof read === 'function') value = read(given ?? args[++i] ?? fail(`${flag}: requires a value`), flag);
    else if (given !== undefined) fail(`${flag}: takes no value`);
    if (isList) (options[member] ??= []).push(value);
    else options[member] = value;
  }
  return { operands, options };
}

const print = (text) => fs.writeSync(1, text);
const format = (value) => (Number.isFinite(value) ? Number(value.toPrecision(6)).toString() : value === Infinity ? 'inf' : 'nan');

const verbs = {
  async render(args) {
    const { operands, options: { file, output = 'png', quiet, ...options } } = parse('render', [...files, ...table], args);
    if (operands.length !== 1 || !file) fail('render takes one input, a model or a built-in scene, and -o OUT');
    const { files: made, warnings } = await renderFiles(operands[0], file === '-' ? `stdout.${output}` : path.basename(file), options);
    for (const warning of quiet ? [] : warnings) console.error(`zoneplate: warning: ${warning}`);
    for (const [name, data] of Object.entries(made)) {
      const place = file === '-' ? 1 : path.join(path.dirname(file), name);
      try {
        if (place === 1) fs.writeFileSync(place, data);
        else saveFile(place, data);
      } catch (error) {
        fail(`${place}: ${error.message}`, 'output');
      }
    }
  },
  async info(args) {
    const { operands, options: { json: isJson, ...options } } = parse('info', [json, ...table], args);
    if (operands.length !== 1) fail('info takes one input: a model or a built-in scene');
    const found = await info(operands[0], options);
    print(isJson ? `${JSON.stringify({ input: operands[0], ...found })}\n` : `${operands[0]}\n${found.text}`);
  },
  async metrics(args) {
    const { operands, options } = parse('metrics', [[['--metric'], 'metrics', (text) => text.split(/,(?=[a-z_]+(?:[:,]|$))/)],
      [['--threshold'], 'threshold', number], [['--ignore'], 'ignore', numbers(4), true], json, [['-q', '--quiet'], 'quiet', true]], args);
    if (operands.length !== 2) fail('metrics takes a reference and a test image');
    const found = await compare(operands[0], operands[1], { metrics: options.metrics, ignore: options.ignore });
    const rows = Object.entries(found.metrics);
    if (options.threshold !== undefined && rows.length !== 1) fail('--threshold requires one metric');
    const passes = options.threshold === undefined ? found.identical
      : rows.every(([, { value, better }]) => (better === 'lower' ? value <= options.threshold : value >= options.threshold));
    if (!options.quiet && options.json) print(`${JSON.stringify({ reference: operands[0], test: operands[1], ...found, map: undefined, passed: passes })}\n`);
    else if (!options.quiet) {
      print(`1 image, ${found.width} × ${found.height}${found.identical ? ', identical' : ''}\n`);
      for (const [name, { value, unit }] of rows) print(`  ${name.padEnd(13)} ${format(value).padStart(12)} ${unit}`.trimEnd() + '\n');
    }
    if (!passes) process.exitCode = 1;
  },
  async list(args) {
    const { operands } = parse('list', [], args), { version, options, ...catalogues } = await list();
    const rows = catalogues[operands[0]] ?? fail(`list takes one of ${Object.keys(catalogues).join(', ')}; ${elsewhere}`);
    for (const [name, summary] of Object.entries(rows)) print(`${name.padEnd(20)} ${summary}\n`);
  },
};
const others = ['contact-sheet', 'plan', 'verify', 'filter', 'compare', 'dataset', 'fidelity', 'bench', 'demo', 'signal', 'texture', 'sdf', 'completions', 'man'];

const help = `Zoneplate renders 3D models to antialiased images, on the CPU. This package has the main verbs of the program.

  zoneplate render IN -o OUT [OPTIONS]   images of a model or a built-in scene (the verb is optional)
  zoneplate info IN [--json]             the contents of a model
  zoneplate metrics REFERENCE TEST [--metric NAME,...] [--threshold VALUE] [--ignore X,Y,W,H] [--json]
  zoneplate list methods|metrics|scenes|aovs|kernels

Options of render, which have the meaning of the program's:
  ${[...files, ...table].map(([names]) => names.find((name) => name.startsWith('--'))).join(' ').replace(/(.{1,96})(?: |$)/g, '$1\n  ').trimEnd()}
`;

async function main([verb = '--help', ...rest]) {
  if (verb === '--help' || verb === '-h' || verb === 'help') return print(help);
  if (verb === '--version') return print(`zoneplate ${(await list()).version} (WebAssembly)\n`);
  if (others.includes(verb)) fail(`${verb}: no verb of this package; ${elsewhere}`);
  if (verbs[verb]) return verbs[verb](rest);
  return verbs.render([verb, ...rest]);
}

try {
  await main(process.argv.slice(2));
} catch (error) {
  console.error(`zoneplate: ${error.message}`);
  process.exitCode = { usage: 2, input: 3, output: 4 }[error.code] ?? 1;
}
