/** Print what the Khronos validator finds in GLB files, as JSON: node validate.mjs FILE …, {FILE: [{severity, code, pointer, message}]}. */

import { readFileSync } from "node:fs";
import { validateBytes } from "gltf-validator";

const SEVERITIES = ["error", "warning", "information", "hint"];

const found = {};
for (const file of process.argv.slice(2)) {
  const { issues } = await validateBytes(new Uint8Array(readFileSync(file)), { maxIssues: 0 });
  found[file] = issues.messages.map(({ severity, ...rest }) => ({ severity: SEVERITIES[severity], ...rest }));
}
console.log(JSON.stringify(found));
