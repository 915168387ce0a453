// SPDX-License-Identifier: Apache-2.0
// node check_onnx.mjs FOLDER: onnxruntime gives the corrections of the frames that export.py has written, within 1e-4.
import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";

const ort = createRequire(process.cwd() + "/")("onnxruntime-node");
const folder = process.argv[2];
// Its optimisations would multiply scales into the weights, whose sums are no longer exact.
const options = { graphOptimizationLevel: "disabled" };
const session = await ort.InferenceSession.create(`${folder}/network.onnx`, options);
const floats = (name) => new Float32Array(new Uint8Array(readFileSync(`${folder}/${name}`)).buffer);
let worst = 0;
for (const name of readdirSync(folder).filter((file) => file.endsWith(".features")).sort()) {
  const values = floats(name);
  const features = new ort.Tensor("float32", values, [1, values.length / (60 * 80), 60, 80]);
  const { corrections } = await session.run({ features });
  const expected = floats(name.replace("features", "corrections"));
  if (corrections.data.length !== expected.length) throw new Error(`${name}: ${corrections.data.length} corrections`);
  expected.forEach((value, i) => (worst = Math.max(worst, Math.abs(value - corrections.data[i]))));
}
console.log(`greatest difference ${worst}`);
if (!(worst <= 1e-4)) process.exit(1);
